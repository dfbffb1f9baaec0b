#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "softgrain/core/communicator.hpp"
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
    {{"bonded grains (BPM) of 60 primaries",
      {"experiment.model=bpm", "bpm.primaries=60", "time.step=0.25 us", "loading.max_strain=0.3",
       "loading.max_stress=2 MPa"},
      0.14},
     {"elastic grains (MPM), implicit, 896 points",
      {"experiment.model=mpm", "mpm.cells=8", "time.step=5 us", "loading.max_packing_fraction=0.98"},
      0.14},
     {"elastic grains (MPM), explicit, 896 points",
      {"experiment.model=mpm", "mpm.cells=8", "mpm.integrator=explicit", "loading.max_packing_fraction=0.98"},
      0.23}}};

/// Of the round that took least.
struct Measured {
  double preparation = 0;  ///< CPU time of the sample [s]
  double steps_cpu = 0;    ///< CPU time of all steps of all ranks, waiting left out [s]
  double steps_wall = 0;   ///< of all steps, by the clock [s]
  std::int64_t steps = 0;
  double sweeps = 0;     ///< of NLGS in a step, mean
  double imbalance = 1;  ///< largest CPU time of a rank's share over their mean
};

constexpr int usual_grains = 12;

Case case_of(const BenchCase& bench, int grains) {
  std::vector<std::string> sets{"experiment.loading=compaction", fmt::format("sample.grains={}", grains),
                                "sample.packing_fraction=0.65", "loading.wall_velocity=5 m/s"};
  sets.insert(sets.end(), bench.sets.begin(), bench.sets.end());
  return parse_case("", "bench", sets);
}

/// All ranks take the same rounds.
Measured measured_once(const Case& the_case) {
  using Clock = std::chrono::steady_clock;
  Communicator& all = communicator();
  const double begin = cpu_seconds();
  const auto simulation = create_simulation(the_case);
  const double ready = cpu_seconds();
  const Clock::time_point clock = Clock::now();
  const SharingAccount before = all.account;
  std::int64_t steps = 0, sweeps = 0;
  for (; !simulation->finished(); ++steps) sweeps += simulation->step().sweeps;
  const double taken = cpu_seconds() - ready, waited = all.account.cpu_exchanges - before.cpu_exchanges;
  const std::chrono::duration<double> wall = Clock::now() - clock;
  const OverRanks shared = over_ranks(all.account.cpu_shared - before.cpu_shared);
  return {.preparation = ready - begin,
          .steps_cpu = all.sum(taken - waited),
          .steps_wall = wall.count(),
          .steps = steps,
          .sweeps = static_cast<double>(sweeps) / static_cast<double>(steps),
          .imbalance = shared.largest_over_mean()};
}

Measured measured(const Case& the_case, int rounds) {
  Measured least = measured_once(the_case);
  for (int round = 1; round < rounds; ++round)
    if (const Measured again = measured_once(the_case); again.steps_cpu < least.steps_cpu) least = again;
  return least;
}

struct BenchOptions {
  int rounds = 3;
  int grains = usual_grains;
  bool json = false;
};

std::string heading(int grains, int ranks) {
  return fmt::format("{} grains, {}", grains,
                     ranks > 1 ? fmt::format("{} ranks of one thread", ranks) : "one thread");
}

void bench(const BenchOptions& options) {
  set_threads(1);
  const int ranks = communicator().ranks();
  const bool has_reference = ranks == 1 && options.grains == usual_grains;
  auto table = nlohmann::ordered_json::array();
  if (!options.json)
    fmt::print("{:42} {:>8} {:>9} {:>7} {:>11} {:>12} {:>10}\n", heading(options.grains, ranks), "CPU [s]",
               "clock [s]", "steps", "step [ms]", "sweeps/step", ranks > 1 ? "imbalance" : "reference");
  for (const BenchCase& bench : bench_cases) {
    const Measured m = measured(case_of(bench, options.grains), options.rounds);
    const double ratio = m.steps_cpu / bench.reference_seconds;
    table.push_back({{"case", bench.name},
                     {"grains", options.grains},
                     {"ranks", ranks},
                     {"preparation_seconds", m.preparation},
                     {"cpu_seconds", m.steps_cpu},
                     {"wall_seconds", m.steps_wall},
                     {"steps", m.steps},
                     {"sweeps_per_step", m.sweeps},
                     {"imbalance", m.imbalance}});
    if (has_reference) table.back()["over_reference"] = ratio;
    if (!options.json)
      fmt::print("{:42} {:8.2f} {:9.2f} {:7} {:11.3f} {:12.1f} {:>10}\n", bench.name, m.steps_cpu,
                 m.steps_wall, m.steps, 1e3 * m.steps_cpu / static_cast<double>(m.steps), m.sweeps,
                 ranks > 1       ? fmt::format("{:.2f}", m.imbalance)
                 : has_reference ? fmt::format("{:.2f}x", ratio)
                                 : "");
  }
  if (options.json) return fmt::print("{}\n", table.dump(2));
  if (has_reference)
    fmt::print(
        "\nreference: this machine over the one of docs/performance.md, to scale its tables and the hours of "
        "`softgrain check`\n");
  if (ranks > 1)
    fmt::print(
        "\nCPU: of all ranks together, waiting left out; imbalance: largest share of a rank over the mean\n");
}

}  // namespace

void add_bench_verb(CLI::App& app) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand("bench", "Measure this machine by three small compactions");
  verb->add_option("--rounds", options->rounds, "the least of so many rounds counts")
      ->check(CLI::Range(1, 100));
  verb->add_option("--grains", options->grains, "in each of them; ranks share elastic ones by eight")
      ->check(CLI::Range(1, 100000));
  verb->add_flag("--json", options->json, "the table as JSON");
  verb->footer(
      "Examples:\n  softgrain bench\n  softgrain bench --rounds 5 --json\n  mpirun -np 4 softgrain-mpi bench "
      "--grains 64");
  verb->callback([options] { bench(*options); });
}

}  // namespace softgrain
