#pragma once

namespace softgrain {

/// Work since the start [J/m]. What the walls and gravity gave is kinetic energy, work of the internal
/// forces, what contacts took (impacts and friction), and what the time stepping took:
///   walls + gravity = dK + internal + contacts + inertia + damping,
/// as far as the equations of motion and the contact laws were solved.
struct WorkBudget {
  double walls = 0;     ///< by the walls on the grains
  double gravity = 0;   ///< sum of m g . dx
  double internal = 0;  ///< sum of f_int . dx: the elastic energy, and what integration loses of it
  double contacts = 0;  ///< -sum of p . u: taken by contacts
  double friction = 0;  ///< of `contacts`: by sliding
  double inertia = 0;   ///< backward Euler's sum of m (dv)^2/2
  double damping = 0;   ///< -sum of f_damping . dx, see MassDamping
};

/// What one step of soft grains did, over all its sub-steps.
struct SoftStepReport {
  int iterations = 0;          ///< of Newton's method; explicit: sub-steps
  int sweeps = 0;              ///< of NLGS
  int factorisations = 0;      ///< of batches of eight grains
  int rejected = 0;            ///< sub-steps that were taken back
  int contacts = 0;            ///< that carry impulse at the end
  double residual = 0;         ///< last correction over the mean radius; explicit: worst contact of NLGS
  double residual_mean = 0;    ///< explicit: rms of the contacts of NLGS, over mean radius / dt
  double penetration_max = 0;  ///< deepest vertex of any outline, over the smallest radius
  bool converged = false;
};

}  // namespace softgrain
