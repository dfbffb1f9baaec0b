#pragma once
#include <functional>
#include <span>
#include <vector>

#include "softgrain/contact/solver_options.hpp"
#include "softgrain/geometry/box.hpp"
#include "softgrain/geometry/wall_motion.hpp"
#include "softgrain/model/soft_step_report.hpp"
#include "softgrain/model/work_budget.hpp"
#include "softgrain/soft/contact_of.hpp"
#include "softgrain/soft/friction_by_kind.hpp"
#include "softgrain/soft/history.hpp"
#include "softgrain/soft/lumped_contacts.hpp"
#include "softgrain/soft/outline_adhesion.hpp"
#include "softgrain/soft/rigid_motion.hpp"
#include "softgrain/soft/soft_grains.hpp"
#include "softgrain/soft/stable_step.hpp"

namespace softgrain {

/// The contacts of a sub-step when they are to be solved.
template <int Dim>
struct ContactsOfStep {
  const OutlineStateOf<Dim>& outline;     ///< position: where the outlines would be without forces
  std::span<ScatteredVec<Dim>> velocity;  ///< (outline vertices) under forces and the impulses so far [m/s]
  std::span<const double> inverse_mass;   ///< (outline vertices) [m/kg]
  LumpedSystem<Dim>& system;
  PushedBodies& pressed;        ///< walls of presses, which sweeps of the system move
  std::span<Vec<Dim>> impulse;  ///< have acted; the solution
  std::span<const double> friction;
  SolverOptions options;
};
/// Solves them together with those that bodies of another model have with the outlines. What these give the
/// grains is its caller's to account for.
template <int Dim>
using JointSolve = std::function<SolverReport(const ContactsOfStep<Dim>&)>;

template <int Dim>
struct ExplicitOptionsOf {
  /// beta: internal forces are taken at x + beta dt v, which damps the mesh's own vibrations
  double damping_share = 0;
  /// NLGS; in units of mean radius / dt. In space sweeps start ahead of the last (docs/decisions/0077).
  SolverOptions solver{
      .max_sweeps = 200, .tolerance = 4.5e-6, .relaxation = Dim == 3 ? 1.0 : 1.4, .extrapolated = Dim == 3};
  double friction = 0;
  double wall_friction = 0;
  std::vector<PairFriction> pair_friction{};  ///< of pairs of kinds, instead of those two
  std::vector<PairAdhesion> adhesion{};       ///< of pairs of kinds, in the plane; none: nothing attracts
  Vec<Dim> gravity{};                         ///< [m/s^2]
  double damping = 0;                         ///< zeta [1/s], see MassDamping
};
using ExplicitOptions = ExplicitOptionsOf<2>;

/// That SoftStepReport::residual has to reach: of the worst contact.
template <int Dim>
double residual_limit(const ExplicitOptionsOf<Dim>& options) {
  return options.solver.worst_factor * options.solver.tolerance;
}

/// What is known of the longest stable step; saved with a checkpoint.
struct StableStep {
  double longest = 0;  ///< [s] when the cells were last looked at
  int until_look = 0;  ///< sub-steps until they are again
  int between_looks = 16;
  int until_search = 0;  ///< in space: sub-steps until contacts are looked for again
};

/// Soft grains between walls by symplectic Euler with contact dynamics, on the same data as ImplicitDynamics:
///   v_free = v + dt M^-1 (f_ext - f_int(x)),  v+ = v_free + M^-1 H p,  x+ = x + dt v+,
///   0 <= g(x+) _|_ p_n >= 0,  |p_t| <= mu p_n  (where outlines adhere H acts on (p_n - a, p_t)),
/// with g(x+) linear about x + dt v: at x itself, sliding along an edge would drive vertices into it.
/// In space contacts are looked for every few sub-steps and keep their places in between.
template <int Dim>
class ExplicitStep {
 public:
  static constexpr int dimension = Dim;

  ExplicitStep(GrainsOf<Dim> soft_grains, Box<Dim> box_of_grains,
               const ExplicitOptionsOf<Dim>& explicit_options);

  /// One step of dt, in equal sub-steps of at most longest_stable_step: cells are looked at again every so
  /// many of them, more often while they change. Raises NumericalError if a point is inverted or cells are so
  /// deformed that thousands of sub-steps would be needed, naming the grain, and as check_wall_motion.
  SoftStepReport step(double dt, const JointSolve<Dim>& joint = {});

  /// After `contacts` were changed from outside, as by a snapshot.
  void forget_rows() { lumped_scratch_.kept = false, friction_.clear(); }
  /// Impulse of the grains on a wall in the last step [N s/m in the plane].
  const Vec<Dim>& wall_impulse(int wall) const { return box.impulse[wall]; }
  double mean_radius() const { return mean_radius_; }
  bool adheres() const { return adhesion_.any(); }

  GrainsOf<Dim> grains;
  Box<Dim> box;  ///< a model lends its own for a step
  ExplicitOptionsOf<Dim> options;
  std::vector<ContactOf<Dim>> contacts;
  std::vector<Vec<Dim>> impulse;
  std::vector<double> attraction;  ///< of `contacts`, a [N s/m]; empty if nothing adheres
  double adhesion_energy = 0;      ///< at the end of the last step [J/m], <= 0
  double impulse_time = 0;         ///< the step over which they acted [s]
  WorkBudget work;                 ///< since the start; there is no `inertia`
  FlowOfGrains last_flow;          ///< of the last sub-step
  std::vector<char> met;           ///< (grains) 1: bodies of another model are near; empty: none is
  std::vector<double> other_push;  ///< (presses) of these bodies in the sub-step [N s/m]; empty: none
  StableStep stable;

 private:
  /// Of a batch: its outline's nodes at the start of the step, and the work over the step.
  struct BatchStep {
    WidePlaces<Dim> force, velocity;
    RigidTwistOf<Dim> twist;  ///< of rigid grains at the start of the step
    Wide internal = 0.0, gravity = 0.0, damping = 0.0;
    FlowOfStep flow;
  };
  Vec<Dim, Wide> weight(const BatchOf<Dim>& batch, int node) const;
  void add_work(const BatchOf<Dim>& batch, int node, const Vec<Dim, Wide>& internal_force,
                const Vec<Dim, Wide>& way, BatchStep& step) const;
  FrictionByKind friction_by_kind() const {
    return {grains.kinds(), options.friction, options.wall_friction, options.pair_friction};
  }
  void look_at_cells(double dt);
  double sub_steps(double dt) const;
  void sub_step(double dt, const JointSolve<Dim>& joint, SoftStepReport& report);
  SolverReport kick_and_solve(double dt, const JointSolve<Dim>& joint);
  void take_back_spin();
  const std::vector<Vec<Dim>>& felt();
  const std::vector<double>& friction_of_contacts();
  void add_adhesion();
  void find_contacts(double dt);
  void fly_outline(double dt);
  void kick(double dt);
  void pass_kicked(int b, Message& message);
  void kick_batch(double dt, const WidePlaces<Dim>& force, BatchOf<Dim>& batch, BatchStep& step) const;
  void drift_batch(double dt, BatchOf<Dim>& batch, BatchStep& step) const;
  void drift_outline(double dt);
  void fly_rigid(double dt, const BatchOf<Dim>& batch);
  void kick_rigid(double dt, BatchOf<Dim>& batch, BatchStep& step);
  void drift_rigid(double dt, BatchOf<Dim>& batch, BatchStep& step);
  void set_bodies(const BatchOf<Dim>& batch, const RigidTwistOf<Dim>& twist);
  RigidTwistOf<Dim> twist_of_bodies(const BatchOf<Dim>& batch) const;
  void add_flow();
  void add_contact_work(double dt);
  void add_overlaps(SoftStepReport& report) const;

  double mean_radius_ = 0, smallest_radius_ = 0;
  NeighboursOf<Dim> neighbours_;
  OutlineAdhesion adhesion_;
  std::vector<Vec<Dim>> felt_;
  OutlineStateOf<Dim> outline_;
  std::vector<ScatteredVec<Dim>> outline_velocity_;
  std::vector<Vec<Dim>> outline_velocity_start_;
  std::vector<double> inverse_mass_;  // (outline vertices)
  LumpedBodiesOf<Dim> bodies_;        // the rigid grains
  std::vector<int> body_of_grain_;    // or -1
  typename LumpedSystem<Dim>::Scratch lumped_scratch_;
  std::vector<double> friction_;  // (contacts) under friction_law_
  FrictionByKind friction_law_;
  std::vector<BatchStep> batch_step_;
  MassDamping<Dim> damping_;
};

using ExplicitDynamics = ExplicitStep<2>;

}  // namespace softgrain
