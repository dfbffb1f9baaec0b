// How the cost of a grain grows with its primaries: preparation, and one step of the compression.
#include <fmt/core.h>

#include <cmath>

#include "bonded.hpp"
#include "harness.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr int smallest = 500, steps_before = 1000, steps_measured = 200;

struct Cost {
  double preparation = 0, step = 0;  // [s]
  double sweeps = 0;                 // per step
};

/// The paper's grain from other numbers of primaries: the time step shrinks with them, so that a primary
/// moves as far in units of its diameter.
Cost cost_of(int primaries) {
  Case paper;
  paper.time.step = 0.25e-6 * std::sqrt(static_cast<double>(paper.bpm.primaries) / primaries);
  paper.bpm.primaries = primaries;
  const double start = cpu_seconds();
  Simulation simulation = simulation_of(paper);
  Cost cost{.preparation = cpu_seconds() - start};
  for (int k = 0; k < steps_before; ++k) simulation.step();
  cost.step = fastest({[&] {
                Simulation copy = simulation;
                cost.sweeps = 0;
                for (int k = 0; k < steps_measured; ++k) cost.sweeps += copy.step().sweeps;
              }})[0] /
              steps_measured;
  cost.sweeps /= steps_measured;
  return cost;
}

}  // namespace

int main(int argc, char** argv) {
  Results results("bpm_scaling", argc, argv);
  results.heading("cost per primary; 1 is linear growth");
  Cost reference;
  for (int primaries = smallest; primaries <= 8 * smallest; primaries *= 2) {
    const Cost cost = cost_of(primaries);
    if (primaries == smallest) reference = cost;
    const auto add = [&](const char* what, double seconds, double reference_seconds) {
      results.add({.what = fmt::format("{} primaries: {}", primaries, what),
                   .value = 1e6 * seconds / primaries,
                   .unit = "us/primary",
                   .ratio = seconds / primaries / (reference_seconds / smallest),
                   .reference = fmt::format("{} primaries", smallest)});
    };
    add("preparation", cost.preparation, reference.preparation);
    add("step", cost.step, reference.step);
    add("step divided by its sweeps", cost.step / cost.sweeps, reference.step / reference.sweeps);
    results.add(
        {.what = fmt::format("{} primaries: sweeps per step", primaries), .value = cost.sweeps, .unit = ""});
  }
}
