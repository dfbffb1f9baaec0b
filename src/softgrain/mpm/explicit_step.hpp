#pragma once
#include <vector>

#include "softgrain/contact/solver_options.hpp"
#include "softgrain/mpm/lumped_contacts.hpp"
#include "softgrain/mpm/outline_contacts.hpp"
#include "softgrain/mpm/soft_grains.hpp"
#include "softgrain/mpm/soft_step_report.hpp"

namespace softgrain {

struct ExplicitOptions {
  double damping_time =
      0;  ///< tau [s]: internal forces are taken at x + tau v, which damps the mesh's own vibrations
  SolverOptions solver{
      .max_sweeps = 200, .tolerance = 4.5e-6, .relaxation = 1.4};  ///< NLGS; in units of mean radius / dt
  double friction = 0;
  double wall_friction = 0;
  Vec<2> gravity{};  ///< [m/s^2]
};

/// Soft grains between walls by symplectic Euler with contact dynamics, on the same data as ImplicitDynamics:
///   v_free = v + dt M^-1 (f_ext - f_int(x)),  v+ = v_free + M^-1 H p,  x+ = x + dt v+,
///   0 <= g(x+) _|_ p_n >= 0,  |p_t| <= mu p_n,
/// with g(x+) linear about x + dt v: at x itself, sliding along an edge would drive vertices into it.
class ExplicitDynamics {
 public:
  ExplicitDynamics(SoftGrains soft_grains, std::vector<Wall<2>> plates,
                   const ExplicitOptions& explicit_options);

  /// One step of dt, which must be stable (stable_time_step). Raises NumericalError, naming the grain, if a
  /// point is inverted.
  SoftStepReport step(double dt);

  const Vec<2>& wall_impulse(int wall) const { return wall_impulse_[wall]; }
  double mean_radius() const { return mean_radius_; }

  SoftGrains grains;
  std::vector<Wall<2>> walls;
  ExplicitOptions options;
  std::vector<OutlineContact> contacts;
  std::vector<Vec<2>> impulse;
  double impulse_time = 0;  ///< the step over which they acted [s]
  WorkBudget work;          ///< since the start; there is no `inertia`

 private:
  /// Of a batch: its outline's nodes at the start of the step, and the work over the step.
  struct BatchStep {
    WideVectors force, velocity;
    Wide internal = 0.0, gravity = 0.0;

    void add_work(const Vec<2, Wide>& internal_force, const Vec<2, Wide>& weight, const Vec<2, Wide>& moved) {
      internal += dot(internal_force, moved);
      gravity += dot(weight, moved);
    }
  };
  Vec<2, Wide> weight(const GrainBatch& batch, int node) const;
  void fly_outline(double dt);
  void kick(double dt);
  void kick_batch(double dt, const WideVectors& force, GrainBatch& batch, BatchStep& step) const;
  void drift_outline(double dt);
  void add_contact_work(double dt);
  double penetration_max() const;

  double mean_radius_ = 0, smallest_radius_ = 0;
  OutlineNeighbours neighbours_;
  OutlineState outline_;
  std::vector<Vec<2>> outline_velocity_, outline_velocity_start_;
  std::vector<double> inverse_mass_;  // (outline vertices)
  std::vector<Vec<2>> wall_impulse_;
  LumpedContacts::Scratch lumped_scratch_;
  std::vector<BatchStep> batch_step_;
};

/// A stable step [s]: `safety` times the smallest distance of two nodes of a cell over the wave speed of
/// unstrained material.
double stable_time_step(const SoftGrains& grains, double safety = 0.5);

}  // namespace softgrain
