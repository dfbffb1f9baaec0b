#include "softgrain/experiment/run.hpp"

#include <algorithm>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

/// One step; where it breaks down the error tells its number.
StepReport advance(Simulation& simulation) {
  const auto number = simulation.steps_done() + 1;
  try {
    return simulation.step();
  } catch (const NumericalError& error) {
    throw NumericalError(fmt::format("step {}: {}", number, error.what()));
  }
}

}  // namespace

void RunReport::add(const StepReport& step) {
  ++steps;
  steps_converged += step.converged ? 1 : 0;
  sweeps += step.sweeps;
  residual_max = std::max(residual_max, step.residual_max);
  overlap_max = std::max(overlap_max, step.overlap_max);
}

RunReport run(Simulation& simulation, Recorder& recorder, RunReport report) {
  bool go_on = true;
  while (go_on && !simulation.finished()) {
    const StepReport step = advance(simulation);
    report.add(step);
    go_on = recorder.after_step(simulation, step, report);
  }
  return report;
}

}  // namespace softgrain
