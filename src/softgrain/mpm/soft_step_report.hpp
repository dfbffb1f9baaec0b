#pragma once

namespace softgrain {

/// What one step of soft grains did, over all its sub-steps.
struct SoftStepReport {
  int iterations = 0;          ///< of Newton's method; 1 if explicit
  int sweeps = 0;              ///< of NLGS
  int factorisations = 0;      ///< of batches of eight grains
  int rejected = 0;            ///< sub-steps that were taken back
  int contacts = 0;            ///< that carry impulse at the end
  double residual = 0;         ///< last correction over the mean radius (implicit)
  double penetration_max = 0;  ///< deepest vertex, over the radius of the smallest grain
  bool converged = false;
};

}  // namespace softgrain
