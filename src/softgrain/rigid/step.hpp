#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "softgrain/contact/solver_options.hpp"
#include "softgrain/contact/step_report.hpp"
#include "softgrain/rigid/contacts.hpp"
#include "softgrain/rigid/narrow_sweeps.hpp"
#include "softgrain/rigid/neighbours.hpp"
#include "softgrain/rigid/particles.hpp"
#include "softgrain/rigid/rigid_contact_system.hpp"

namespace softgrain {

/// Adds the forces on the particles, and on the walls after them, at their present positions [N/m in 2D, N in
/// 3D]. Walls of presses follow theirs.
template <int Dim>
using ForceField = std::function<void(const RigidParticles<Dim>&, std::span<Vec<Dim>> force)>;

struct RigidStepOptions {
  SolverOptions
      solver;  ///< velocity_scale 0: 2 <R> / dt, so that the tolerance is overlap per step over diameter
  ContactLaw law;
  Precision precision = Precision::full;  ///< of the sweeps
};

/// Work done in one step by each cause [J/m in 2D]; the sum of force, contact and wall is the change
/// of kinetic energy, to round-off.
struct StepWork {
  double force = 0;    ///< by the force field
  double contact = 0;  ///< by contact impulses in the frame of the contact: minus the energy dissipated there
  double wall = 0;     ///< by moving walls, and by the cell
  double between = 0;  ///< of `contact`: between grains and with walls
  double friction = 0;  ///< of `between`: by sliding
  double push_out = 0;  ///< against the force field, by a way out that adds no velocity
};

/// Overlaps of the contacts that carry impulse [m].
struct Overlaps {
  int contacts = 0;
  double sum = 0, deepest = 0;

  Overlaps& operator+=(const Overlaps& more) {
    contacts += more.contacts;
    sum += more.sum;
    deepest = std::max(deepest, more.deepest);
    return *this;
  }
};

/// Rigid particles under contact dynamics: state, lists and scratch of the step. `friction` and the force
/// field are data, so that one step serves gravity, attraction and none.
template <int Dim>
class RigidDynamics {
 public:
  /// skin [m] of the lists of pairs. Raises UsageError for options out of range.
  RigidDynamics(RigidParticles<Dim> particles, FrictionRule friction, RigidStepOptions options, double skin);

  /// One step of Moreau's mid-point scheme (theory (2)-(4)). Raises NumericalError if a velocity is not
  /// finite.
  StepReport step(const ForceField<Dim>& field, double dt);

  /// The same in parts, whose contacts other bodies may share. First lists, and the velocities without
  /// contacts, under the forces at x + lead v: lead = dt/2 in Moreau's scheme, 0 in symplectic Euler's.
  void begin_step(const ForceField<Dim>& field, double dt, double lead);
  /// The contacts with gaps and frames at the present positions, to be solved in full precision; their
  /// impulses have not acted. Keeps references.
  RigidContactSystem<Dim> contact_system(double dt);
  /// The presses under the impulses that their contacts carry now.
  PushedBodies pressed_walls(double dt) const;
  /// x + (dt - lead) v+, work and overlaps. Raises NumericalError as step.
  StepReport end_step(const SolverReport& solver, double dt, double lead);

  RigidParticles<Dim> particles;
  RigidContacts<Dim> contacts;
  NeighbourReference<Dim> reference;  ///< of the list of contacts; force fields may share it
  RigidStepOptions options;
  StepWork work;  ///< of the last step

  /// Impulse of the particles on wall w in the last step, [N s/m in 2D]; zero before the first.
  Vec<Dim> wall_impulse(int wall) const { return wall_impulse_.empty() ? Vec<Dim>{} : wall_impulse_[wall]; }

  /// Makes the contacts of renewed lists again from the reference as it is.
  void rebuild_contacts();
  /// Before the reference is set: ranks share the grains, where sweeps in single precision are all that looks
  /// at the contacts inside them. Each then has the contacts inside its own grains and those between grains,
  /// and follows the particles of both (RigidParticles::followed).
  void share_grains();
  /// On all ranks: the first one then knows all particles and contacts, until the next step
  /// (ModelOf::gather).
  void gather();
  /// On all ranks: all then know positions, velocities and spins of all particles, until the next step.
  void know_all();
  /// From now on, another one between grains or at walls; impulses stay.
  void set_friction(FrictionRule friction);

 private:
  void follow_others();
  void collect_contacts();
  void take_own_contacts();
  std::vector<int> first_particles() const;
  void kick(const ForceField<Dim>& field, double dt);
  void prepare(int begin, int end, double dt);
  void list_pressed_walls();
  void list_between_again();
  double pull_on(const Press& press) const;
  void move_presses(double dt);
  void end_step_of_presses(double dt);
  SolverReport solve(double dt);
  SolverReport solve_in_single_precision(RigidContactSystem<Dim>& system, const SolverOptions& solver,
                                         double dt);
  double friction_work() const;
  double work_of_cell() const;
  void temper_restitution(double dt);
  void push_out(double dt);
  void account_work(double dt);
  void add_up_wall_impulses();
  void account_contacts();
  Overlaps overlaps_of(const ContactBlock& block) const;
  [[noreturn]] void throw_not_finite() const;
  StepReport report(const SolverReport& solver) const;

  FrictionRule friction_;
  std::vector<Vec<Dim>> force_, velocity_start_;
  std::vector<Spin<Dim>> spin_start_;
  std::vector<double> offset_;
  std::vector<Vec<Dim>> wall_impulse_;            // (walls)
  std::vector<Vec<Dim>> velocity_kept_, pushes_;  // of push_out
  std::vector<double> frictionless_;
  RigidContacts<Dim> replaced_;                     // its memory serves the next list
  std::optional<RigidContacts<Dim>> own_contacts_;  // while `contacts` are those of all ranks
  NarrowSweepsOf<Dim> narrow_;
  std::vector<Overlaps> overlaps_;  // of each block
  std::vector<bool> pressed_;       // (walls) those of presses when the list of contacts was made
  double mean_radius_ = 0;
};

}  // namespace softgrain
