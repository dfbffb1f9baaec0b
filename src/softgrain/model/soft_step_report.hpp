#pragma once

namespace softgrain {

/// What one step of soft grains did, over all its sub-steps.
struct SoftStepReport {
  int iterations = 0;        ///< of Newton's method; explicit: sub-steps
  int sweeps = 0;            ///< of NLGS
  int factorisations = 0;    ///< of batches of eight grains
  int rejected = 0;          ///< sub-steps that were taken back
  int contacts = 0;          ///< that carry impulse at the end
  double residual = 0;       ///< last correction over the mean radius; explicit: worst contact of NLGS
  double residual_mean = 0;  ///< explicit: rms of the contacts of NLGS, over mean radius / dt
  double overlap_mean = 0;   ///< of the contacts that carry impulse at the end, over the smallest radius
  double overlap_max = 0;    ///< deepest vertex of any outline, over the smallest radius
  bool converged = false;
};

}  // namespace softgrain
