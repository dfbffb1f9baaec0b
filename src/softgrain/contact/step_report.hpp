#pragma once

namespace softgrain {

/// What one time step did.
struct StepReport {
  int contacts = 0;  ///< contacts that carry impulse
  int sweeps = 0;
  double residual_mean = 0;   ///< [-] see SolverReport
  double residual_max = 0;    ///< [-]
  double residual_limit = 0;  ///< that residual_max had to reach [-]; 0: that of the case's tolerance
  double overlap_mean =
      0;  ///< mean overlap of the contacts that carry impulse, over the mean primary radius [-]
  double overlap_max = 0;  ///< worst overlap, over the mean primary radius [-]
  bool converged = false;
};

}  // namespace softgrain
