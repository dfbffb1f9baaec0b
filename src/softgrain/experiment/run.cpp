#include "softgrain/experiment/run.hpp"

#include <algorithm>

namespace softgrain {

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
    const StepReport step = simulation.step();
    report.add(step);
    go_on = recorder.after_step(simulation, step, report);
  }
  return report;
}

}  // namespace softgrain
