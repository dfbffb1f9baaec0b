#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "softgrain/core/parallel.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/run/run_json.hpp"
#include "verbs.hpp"

namespace softgrain {
namespace {

/// A small compaction, whole, and what it took on the machine of docs/performance.md.
struct BenchCase {
  std::string name;
  std::vector<std::string> sets;
  double reference_seconds;  ///< CPU time on one thread [s]
};

const std::array<BenchCase, 3> bench_cases{
    {{"bonded grains (BPM), 12 of 60 primaries",
      {"experiment.model=bpm", "bpm.primaries=60", "time.step=0.25 us", "loading.max_strain=0.3",
       "loading.max_stress=2 MPa"},
      0.14},
     {"elastic grains (MPM), implicit, 12 of 896 points",
      {"experiment.model=mpm", "mpm.cells=8", "time.step=5 us", "loading.max_packing_fraction=0.98"},
      0.14},
     {"elastic grains (MPM), explicit, 12 of 896 points",
      {"experiment.model=mpm", "mpm.cells=8", "mpm.integrator=explicit", "loading.max_packing_fraction=0.98"},
      0.23}}};

struct Measured {
  double preparation = 0;  ///< CPU time of the sample [s]
  double fastest = 0;      ///< CPU time of all steps [s], the least of the rounds
  std::int64_t steps = 0;
  double sweeps = 0;  ///< of NLGS in a step, mean
};

Measured measured(const BenchCase& bench, int rounds) {
  std::vector<std::string> sets{"experiment.loading=compaction", "sample.grains=12",
                                "sample.packing_fraction=0.65", "loading.wall_velocity=5 m/s"};
  sets.insert(sets.end(), bench.sets.begin(), bench.sets.end());
  const Case the_case = parse_case("", "bench", sets);
  Measured result;
  for (int round = 0; round < rounds; ++round) {
    const double begin = cpu_seconds();
    const auto simulation = create_simulation(the_case);
    const double ready = cpu_seconds();
    std::int64_t steps = 0, sweeps = 0;
    for (; !simulation->finished(); ++steps) sweeps += simulation->step().sweeps;
    const double taken = cpu_seconds() - ready;
    if (round == 0 || taken < result.fastest)
      result = {ready - begin, taken, steps, static_cast<double>(sweeps) / static_cast<double>(steps)};
  }
  return result;
}

struct BenchOptions {
  int rounds = 3;
  bool json = false;
};

void bench(const BenchOptions& options) {
  set_threads(1);
  auto table = nlohmann::ordered_json::array();
  if (!options.json)
    fmt::print("{:50} {:>9} {:>9} {:>11} {:>12} {:>10}\n", "CPU time on one thread", "run [s]", "steps",
               "step [ms]", "sweeps/step", "reference");
  for (const BenchCase& bench : bench_cases) {
    const Measured m = measured(bench, options.rounds);
    const double step = m.fastest / static_cast<double>(m.steps), ratio = m.fastest / bench.reference_seconds;
    table.push_back({{"case", bench.name},
                     {"preparation_seconds", m.preparation},
                     {"cpu_seconds", m.fastest},
                     {"steps", m.steps},
                     {"sweeps_per_step", m.sweeps},
                     {"over_reference", ratio}});
    if (!options.json)
      fmt::print("{:50} {:9.2f} {:9} {:11.3f} {:12.1f} {:9.2f}x\n", bench.name, m.fastest, m.steps,
                 1e3 * step, m.sweeps, ratio);
  }
  if (options.json)
    fmt::print("{}\n", table.dump(2));
  else
    fmt::print(
        "\nreference: this machine over the one of docs/performance.md, to scale its tables and the hours of "
        "`softgrain check`\n");
}

}  // namespace

void add_bench_verb(CLI::App& app) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand("bench", "Measure this machine by three small compactions");
  verb->add_option("--rounds", options->rounds, "the least of so many rounds counts")
      ->check(CLI::Range(1, 100));
  verb->add_flag("--json", options->json, "the table as JSON");
  verb->footer("Examples:\n  softgrain bench\n  softgrain bench --rounds 5 --json");
  verb->callback([options] { bench(*options); });
}

}  // namespace softgrain
