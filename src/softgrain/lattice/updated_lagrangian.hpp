#pragma once
#include <span>
#include <vector>

#include "softgrain/contact/solver_options.hpp"
#include "softgrain/geometry/box.hpp"
#include "softgrain/geometry/wall.hpp"
#include "softgrain/geometry/wall_motion.hpp"
#include "softgrain/lattice/contact_on.hpp"
#include "softgrain/lattice/grain_equations.hpp"
#include "softgrain/lattice/lattice_contacts.hpp"
#include "softgrain/lattice/point_grain.hpp"
#include "softgrain/material/any_law.hpp"
#include "softgrain/model/soft_step_report.hpp"
#include "softgrain/model/work_budget.hpp"

namespace softgrain {

struct UpdatedLagrangianOptions {
  ShapeFunction shape = ShapeFunction::gimp;
  ContactOn contact_on = ContactOn::outline;
  double cell = 0;  ///< h of the lattice [m]
  double pic_share =
      0.03;                ///< of a point's velocity that is taken from the nodes in a step (0: FLIP, 1: PIC)
  double wall_reach = -1;  ///< grid_nodes: a wall acts on nodes nearer than this [cells]; below 0: as far as
                           ///< if it were filled with points like the grains
  SolverOptions solver{.max_sweeps = 500, .tolerance = 1e-7};  ///< NLGS; in units of mean radius / dt
  double friction = 0;
  double wall_friction = 0;
  Vec<2> gravity{};    ///< [m/s^2]
  double damping = 0;  ///< zeta [1/s], see MassDamping
  bool implicit = false;
  double tolerance = 1e-4;  ///< implicit: largest correction of Newton's last iteration, over the mean radius
  int max_iterations = 20;  ///< of Newton's method
};

/// Grains of points by updated-Lagrangian MPM, for comparison with the total-Lagrangian one (theory
/// (55)-(60)): the lattice is reset in each step, and points and outlines move through it.
///
/// Explicit, by symplectic Euler with contact dynamics; strains are updated last, from velocities that went
/// through the points once more (MUSL): nodes with little mass would otherwise strain the points beside them
/// without bound. Forces and contacts act on the same nodes before that, so that they balance where nothing
/// moves.
///
/// Implicit, as in the paper, by backward Euler on the nodes (theory (60a)-(60d)): the stress at the end of a
/// step balances what moves the nodes in it, by Newton's method with A = M/dt^2 + K of each grain; contacts
/// see A.
class UpdatedLagrangianDynamics {
 public:
  /// Raises UsageError if there is no grain, or an option is out of range.
  UpdatedLagrangianDynamics(std::vector<PointGrain> point_grains, Box<2> box_of_grains, AnyLaw material,
                            double mass_density, const UpdatedLagrangianOptions& lagrangian_options);

  /// One step of dt, which must be stable (stable_time_step below) if it is explicit. Raises NumericalError,
  /// naming the grain, if a point is inverted or the outline has left the points, and as check_wall_motion.
  /// An implicit step that has no solution is taken back and made in shorter ones; the error comes when they
  /// are far below the explicit one.
  SoftStepReport step(double dt);

  /// Impulse of the grains on a wall in the last step [N s/m].
  const Vec<2>& wall_impulse(int wall) const { return box.impulse[wall]; }
  double elastic_energy() const;  ///< sum_p V_p psi(F_p) [J/m]
  /// Cauchy stress of a point [Pa], tension positive.
  Mat<2> stress(int grain, int point) const;

  std::vector<PointGrain> grains;
  Box<2> box;  ///< a model lends its own for a step
  AnyLaw law;
  double density = 0;  ///< rho [kg/m^3]
  UpdatedLagrangianOptions options;
  std::vector<LatticeContact> contacts;  ///< of the last (sub-)step
  std::vector<Vec<2>> impulse;           ///< their impulses (normal, tangential) [N s/m]
  double impulse_time = 0;               ///< the (sub-)step over which they acted [s]
  WorkBudget work;  ///< since the start; `internal` holds what is lost between points and nodes too

 private:
  SoftStepReport explicit_step(double dt);
  void find_stencils();
  void gather_momentum();
  void strain_points(double dt);
  void kick_nodes(double dt);
  template <class Law>
  void add_internal_impulse(const Law& material, double dt);
  void add_contact_work(const LatticeContacts& system);
  double kinetic_energy_of_nodes() const;
  double kinetic_energy_of_points() const;
  void find_outline_weights();
  void find_contacts(LatticeContacts& system, double dt) const;
  std::vector<double> friction_of(std::span<const LatticeContact> of) const;
  void move_points(double dt, double pic_share);
  void move_outlines(double dt);
  SoftStepReport report_of(const SolverReport& solved);

  // Backward Euler, in implicit_lattice_step.cpp.
  enum class Failure { none, inverted_point, indefinite_matrix, not_finite, no_convergence };
  SoftStepReport implicit_step(double dt);
  Failure try_step(double dt, SoftStepReport& report);
  void begin_implicit(double dt);
  Failure solve_nodes(double dt, SoftStepReport& report);
  template <class Work>
  bool all_grains(const Work& of_grain);
  Failure strain_all(double dt);
  void find_residual(double dt);
  Failure factor(double dt, SoftStepReport& report);
  void solve_grains(std::span<Vec<2>> of_nodes) const;
  double largest_correction() const;
  void carry_impulses(std::span<const LatticeContact> old, std::span<const Vec<2>> old_impulse);
  void add_work_of_contacts(const LatticeContacts& system);
  void end_implicit(double dt);
  [[noreturn]] void give_up(Failure failure, double dt) const;

  Lattice lattice_;
  double mean_radius_ = 0, smallest_radius_ = 0;
  OutlineWeights outline_;
  std::vector<std::vector<Stencil>> stencil_;             // (grains) (points)
  std::vector<Vec<2>> impulse_on_node_;                   // dt f_i [N s/m]
  std::vector<Vec<2>> start_velocity_, kicked_velocity_;  // v_i before and after the kick [m/s]
  MassDamping<2> damping_;

  std::vector<GrainEquations> equations_;      // (grains)
  std::vector<std::vector<Mat<2>>> end_F_;     // (grains) (points) F at the end of the step
  std::vector<Vec<2>> flight_velocity_;        // v_i- and what gravity and damping change of it [m/s]
  std::vector<Vec<2>> residual_, correction_;  // [N/m], [m]
  int failed_grain_ = -1;
};

/// A stable step [s]: `safety` times what a pressure wave in unstrained material needs across a cell [m].
double stable_time_step(const AnyLaw& law, double density, double cell, double safety = 0.2);

}  // namespace softgrain
