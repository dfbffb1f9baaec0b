#include "softgrain/experiment/run.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

/// One step; where it breaks down the error tells its number.
StepReport advance(AnySimulation& simulation) {
  const auto number = simulation.steps_done() + 1;
  try {
    return simulation.step();
  } catch (const NumericalError& error) {
    throw NumericalError(fmt::format("step {}: {}", number, error.what()));
  }
}

/// What is no number stays.
double worse(double worst, double now) { return now <= worst || std::isnan(worst) ? worst : now; }

}  // namespace

void EnergyBalance::add(const Energies& energies) {
  error = worse(error, std::abs(energies.error));
  error = worse(error, -energies.dissipation);
  for (const double energy : {energies.wall_work, energies.kinetic, energies.stored})
    scale = std::max(scale, std::abs(energy));
}

void RunReport::add(const StepReport& step) {
  ++steps;
  steps_converged += step.converged ? 1 : 0;
  sweeps += step.sweeps;
  residual_max = worse(residual_max, step.residual_max);
  residual_limit = std::max(residual_limit, step.residual_limit);
  overlap_max = worse(overlap_max, step.overlap_max);
}

RunReport run(AnySimulation& simulation, Recorder& recorder, RunReport report) {
  bool go_on = true;
  while (go_on && !simulation.finished()) {
    const StepReport step = advance(simulation);
    report.add(step);
    go_on = recorder.after_step(simulation, step, report);
  }
  return report;
}

}  // namespace softgrain
