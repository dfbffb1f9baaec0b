// The paper's packing of bonded grains, 300 of 200 primaries (60 000 dense disks), 20 sweeps in each step:
// CPU time of its parts and of the whole step on one thread, and wall time of the step on two.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "bonded.hpp"
#include "harness.hpp"
#include "softgrain/core/parallel.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr int steps_before = 200, steps_timed = 40, calls = 20, sweeps = 20;

Case paper_packing() {
  Case c;
  c.experiment.loading = LoadingPath::compaction;
  c.bpm.cohesive_pressure = 0.5e6;
  c.bpm.primaries = 200;
  c.loading.wall_velocity = 5;
  c.loading.max_strain = 0.44;
  c.time.step = 1e-7;
  c.sample.grains = 300;
  c.solver.min_sweeps = c.solver.max_sweeps = sweeps;
  return c;
}

void run_steps(Simulation simulation) {
  for (int k = 0; k < steps_timed; ++k) simulation.step();
}

void measure_parts(const Simulation& simulation, const Case& c, Results& results) {
  RigidDynamics<2> state = bonded(simulation);
  AttractionForces attraction({.F0 = 100, .gamma = c.bpm.exponent});
  attraction.update(state.particles, state.reference);
  std::vector<Vec<2>> force(state.particles.position.size());
  std::vector<double> offset;
  signorini_offset<2>(state.contacts, state.particles.velocity, {}, c.time.step, offset);
  RigidContactSystem<2> system(state.particles, state.contacts, offset);
  NarrowSweeps narrow;
  narrow.start(
      state.particles, state.contacts, [](int, int) {}, offset, 1);
  const std::vector<double> seconds = fastest({
      repeated(calls, [&] { narrow.sweep(true); }),
      repeated(calls, [&] { system.sweep(state.contacts.impulse, state.contacts.friction, {}); }),
      repeated(calls, [&] { detect_contacts(state.particles, state.contacts); }),
      repeated(calls, [&] { attraction.add_forces(state.particles, force); }),
  });
  const char* names[] = {"one sweep", "one sweep in double precision", "detection", "attraction"};
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    results.add({.what = names[k], .value = 1e3 * seconds[k] / calls, .unit = "ms"});
    results.add({.what = fmt::format("{}, per candidate contact", names[k]),
                 .value = 1e9 * seconds[k] / calls / state.contacts.size(),
                 .unit = "ns"});
  }
}

/// Smallest wall time [s] of the steps on one thread and on two, in turn.
std::array<double, 2> wall_times(const Simulation& simulation) {
  std::array<double, 2> best;
  best.fill(std::numeric_limits<double>::infinity());
  for (int round = 0; round < 7; ++round)
    for (const int count : {1, 2}) {
      set_threads(count);
      const auto start = std::chrono::steady_clock::now();
      run_steps(simulation);
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      best[count - 1] = std::min(best[count - 1], taken.count());
    }
  set_threads(1);
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  Results results("bpm_packing", argc, argv);
  const Case c = paper_packing();
  Simulation simulation = simulation_of(c);
  for (int k = 0; k < steps_before; ++k) simulation.step();
  const RigidDynamics<2>& state = bonded(simulation);
  results.heading(fmt::format("{} primaries, {} candidate contacts, {} sweeps a step", state.particles.size(),
                              state.contacts.size(), sweeps));
  measure_parts(simulation, c, results);
  const std::vector<double> seconds = fastest({[&] { run_steps(simulation); }});
  results.add({.what = "whole step", .value = 1e3 * seconds[0] / steps_timed, .unit = "ms"});
  const auto [one, two] = wall_times(simulation);
  results.add({.what = "wall time of a step, one thread", .value = 1e3 * one / steps_timed, .unit = "ms"});
  results.add({.what = "wall time of a step, two threads",
               .value = 1e3 * two / steps_timed,
               .unit = "ms",
               .ratio = two / one,
               .reference = "one thread"});
}
