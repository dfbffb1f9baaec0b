#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/contact/solver_options.hpp"
#include "softgrain/geometry/box.hpp"
#include "softgrain/geometry/wall_motion.hpp"
#include "softgrain/model/soft_step_report.hpp"
#include "softgrain/model/work_budget.hpp"
#include "softgrain/soft/elastic_contacts.hpp"
#include "softgrain/soft/friction_by_kind.hpp"
#include "softgrain/soft/history.hpp"
#include "softgrain/soft/outline_adhesion.hpp"
#include "softgrain/soft/outline_contacts.hpp"
#include "softgrain/soft/rigid_motion.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// x and y of each vector, one after the other.
inline std::span<Wide> numbers(WideVectors& vectors) { return {&vectors[0][0], 2 * vectors.size()}; }

struct ImplicitOptions {
  double tolerance = 1e-4;  ///< largest correction of Newton's last iteration, over the mean grain radius
  int max_iterations = 40;  ///< of Newton's method
  /// The same in a quasi-static step; and in one whose inertia A does not have, where iterations also carry
  /// grains into the places that they fall into
  int quasi_static_iterations = 20, slow_iterations = 400;
  double proximal =
      0.5;  ///< c of the term c p/l on the outline's diagonal of the tangent (p/l contact pressure)
  /// In times of a wave through the smallest grain, R/c (docs/decisions/0023): a (sub-)step longer than this
  /// is quasi-static, and A has the inertia of a step of at most that; where hardly any force holds the
  /// grains, of at most the last (docs/decisions/0031)
  double quasi_static_from = 6, inertia_of_at_most = 20, floppy_inertia_of_at_most = 30;
  /// A is factored in single precision for steps up to this many explicit ones (h/c, stable_time_step); its
  /// condition is about 4 times the square of their ratio (docs/decisions/0019). 0: never
  double single_precision_steps = 60;
  SolverOptions solver{.max_sweeps = 500,
                       .extrapolated = true};  ///< NLGS, to a quarter of Newton's tolerance
  double friction = 0;                         ///< mu between grains
  double wall_friction = 0;                    ///< mu against walls
  std::vector<PairFriction> pair_friction{};   ///< of pairs of kinds, instead of those two
  std::vector<PairAdhesion> adhesion{};        ///< of pairs of kinds; none: nothing attracts
  Vec<2> gravity{};                            ///< [m/s^2]
  double damping = 0;                          ///< zeta [1/s], see MassDamping
};

/// Soft grains between walls by backward Euler with position-level contact (docs/theory.md, implicit MPM):
///   M (x - x_n - dt v_n)/dt^2 + f_int(x) = f_ext + H p/dt,   v = (x - x_n)/dt,
/// (f_ext: gravity and damping, which is that of v_n),
///   0 <= g(x) _|_ p_n >= 0,  |p_t| <= mu p_n;
/// where outlines adhere H acts on (p_n - a(g), p_t) instead (AdhesiveContact).
/// Newton's method detects contacts anew in every iteration; A = M/dt^2 + K + proximal term is factored once
/// a step, and again where Newton's method needs many iterations; each grain follows the secant of its last
/// two corrections (docs/decisions/0021).
///
/// A quasi-static step, dt > 6 R/c, starts Newton's method at x_n where grains touch, and solves the same
/// equations with A = M/t^2 + K + proximal term, t = min(dt, 20 R/c): a grain's rigid motions cost something
/// in A, though nothing in the residual, so that NLGS works as well as in a step of t. That the forces
/// balance is asked for apart (docs/decisions/0023).
class ImplicitDynamics {
 public:
  static constexpr int dimension = 2;

  ImplicitDynamics(SoftGrains soft_grains, Box<2> box_of_grains, const ImplicitOptions& implicit_options);

  /// One step of dt; walls move by dt times their velocity. A sub-step in which Newton's method or NLGS does
  /// not converge, that leaves a contact too deep, moves a grain by more than half its radius (two radii in a
  /// slow step, whose iterations are small), inverts a
  /// point or makes A indefinite is taken back and tried again with a quarter of its length; sub-steps grow
  /// again while they succeed, also from one step to the next. Raises NumericalError, naming the grain, for
  /// sub-steps far below the explicit one.
  SoftStepReport step(double dt);

  /// Impulse of the grains on a wall in the last step [N s/m].
  const Vec<2>& wall_impulse(int wall) const { return box.impulse[wall]; }
  double mean_radius() const { return mean_radius_; }
  bool adheres() const { return adhesion_.any(); }

  SoftGrains grains;
  Box<2> box;  ///< a model lends its own for a step
  ImplicitOptions options;
  std::vector<OutlineContact> contacts;  ///< at the end of the last step
  std::vector<Vec<2>> impulse;           ///< of `contacts`, (p_n, p_t) [N s/m]
  std::vector<double> attraction;        ///< of `contacts`, a [N s/m]; empty if nothing adheres
  double adhesion_energy = 0;            ///< at the end of the last step [J/m], <= 0
  double impulse_time = 0;               ///< the (sub-)step over which `impulse` acted [s]
  double sub_step = 0;                   ///< the longest to try next [s]; 0: the whole step
  /// Sub-steps of that length that succeeded, and how many shall before twice the length is tried
  int successes = 0, patience = 1;
  WorkBudget work;         ///< since the start
  FlowOfGrains last_flow;  ///< of the last (sub-)step
  /// Unless empty: becomes the last contact problem of every step.
  std::optional<SolvedContactProblem> caught;

 private:
  enum class Failure {
    none,
    inverted_point,
    indefinite_matrix,
    not_finite,
    too_far,
    no_convergence,
    too_deep
  };

  /// A correction larger than this, over the mean radius, is not trusted.
  static constexpr double largest_correction = 0.5;

  /// Largest correction of an iteration, over the mean radius, and what is compared with the tolerance: the
  /// same, or, of a quasi-static step, a quarter of it or a tenth of the unbalanced force of a grain over its
  /// contact force, whichever is more.
  struct Imbalance {
    double correction = 0, residual = 0;
  };

  /// Of a batch, some of whose grains keep their spin: a couple -c q on the grains in `lanes`, see
  /// hold_spins.
  struct HeldSpin {
    Wide lanes = 0.0;                 ///< 1 or 0; nothing is held while `direction` is empty
    WideVectors direction, response;  ///< q, and u = A^-1 q
    Wide inverse = 0.0;               ///< 1/(q . u), or 0
    Wide wanted = 0.0, left = 0.0;    ///< q . (x - x_n) at the end; and what lacks of it
    Wide couple = 0.0;                ///< c
  };

  /// Of a batch of rigid grains, in an iteration (theory (71)): A on their three motions answers forces f_i
  /// on the nodes by
  ///   u_i = W^-1 sum_j f_j + a_i s^-1 sum_j a_j . f_j,
  /// a_i the motion of node i in a turn about the place where A has no coupling.
  struct RigidStep {
    WideVectors arm;                               ///< a_i [m]
    Wide compliance = 0.0, turn_compliance = 0.0;  ///< 1/W [m^2/N], 1/s [1/N]
    Vec<2, Wide> way;                              ///< without contact forces: W^-1 sum f [m],
    Wide turn = 0.0;                               ///< and s^-1 sum a . f
  };

  bool quasi_static(double dt) const { return dt > options.quasi_static_from * wave_time_; }
  /// Longer than any step whose inertia A has.
  bool slow(double dt) const { return dt > options.inertia_of_at_most * wave_time_; }
  /// The step whose inertia A has [s].
  double step_of_matrix(double dt) const { return std::min(dt, inertia_of_ * wave_time_); }
  bool floppy(double dt) const { return slow(dt) && mean_contact_force(dt) < least_contact_force_; }
  bool more_inertia(double dt);
  Failure renew(double dt, SoftStepReport& report);
  Failure try_step(double dt, SoftStepReport& report);
  int most_iterations(double dt) const;
  void start(double dt);
  void set_flying(double dt);
  Vec<2, Wide> velocity_of_cell(std::size_t b) const;
  void hold_touching();
  std::vector<bool> touching_grains() const;
  int runaway_grain(double dt);
  void find_first_contacts();
  void scale_to(double factor);
  void hold_spins(double dt);
  void hold_in_compliance(std::size_t b);
  void hold_increment(std::size_t b);
  void hold_correction(std::size_t b);
  Failure factor(double dt, double proximal, SoftStepReport& report);
  Failure residual(double dt);
  int solve_elastic(int b, double dt);
  void solve_rigid(int b, double dt);
  void correct_rigid(int b);
  void keep_rigid(int b);
  void end_rigid(int b, double dt);
  Wide inertia_work_of_rigid(int b, std::span<const Vec<2>> force) const;
  bool solve_contacts(double dt, SoftStepReport& report);
  Imbalance correct(int iteration, bool same_matrix);
  double largest_correction_of_grains();
  double unbalanced_force(std::span<const Vec<2>> contact_force);
  void follow_secant(bool accelerated);
  void follow_search(bool first);
  void follow_momentum(bool first, bool accelerated);
  double mean_contact_force(double dt) const;  // sum of all, over the number of grains [N/m]
  double find_depth();
  void catch_problem(double dt);
  void flow(double dt);
  Failure finish(double dt, SoftStepReport& report);
  void balance_momentum(double dt, std::span<const Vec<2>> contact_force);
  /// v_n and what damping changes of it, of a node of a batch, counted from first_here on.
  Vec<2, Wide> flight_velocity(std::size_t b, std::size_t i) const {
    const Vec<2, Wide>& v = velocity_start_[b][i];
    return options.damping > 0 ? v + damping_.velocity_change(start_[b][i], v) : v;
  }
  void add_work(std::span<const Vec<2>> contact_force);
  void take_back();
  [[noreturn]] void give_up(Failure failure, double dt) const;
  FrictionByKind friction_by_kind() const {
    return {grains.kinds(), options.friction, options.wall_friction, options.pair_friction};
  }
  std::vector<double> friction_of_contacts() const;
  const std::vector<Vec<2>>& felt();
  void carry_to(std::span<const OutlineContact> found);
  double energy_of_adhesion(std::span<const OutlineContact> of_contacts) const;

  double mean_radius_ = 0, smallest_radius_ = 0;
  double explicit_step_ = 0;        // h/c [s]
  double wave_time_ = 0;            // R/c of the smallest grain and the fastest waves [s]
  double least_contact_force_ = 0;  // of a packing that carries something, of the softest kind [N/m]
  OutlineNeighbours neighbours_;
  OutlineAdhesion adhesion_;
  std::vector<BatchedCholesky> matrix_;
  std::vector<OutlineCompliance> compliance_;  // of this rank's batches, and of others where sweeps need them
  ElasticScratch scratch_;
  int batches() const { return static_cast<int>(grains.batches.size()); }
  /// of_batch(b) for each batch on its rank, see shared_for.
  template <class Work, class Result>
  void share(const Work& of_batch, const Result& result) {
    shared_for(grains.shares, batches(), of_batch, result);
  }
  /// Do ranks share the sweeps? Contacts of presses, and those that attract, take turns alone.
  bool shares_contacts() const { return box.presses.empty() && !adheres(); }
  static std::size_t compliance_size(const GrainBatch& batch) {
    const std::size_t width = 2 * batch.topology->grid.outline_nodes();
    return Wide::size * width * width;
  }
  bool none_failed(std::span<const int> grain_of_batch);
  /// The nodes of a batch from here on are known on all ranks: its outlines, of rigid grains all.
  int first_known(int b) const {
    const Topology& topology = *grains.batches[b].topology;
    return topology.rigid() ? 0 : topology.grid.outline_begin;
  }
  /// And from here on those that this rank knows.
  int first_here(int b) const { return grains.shares.mine(b) ? 0 : first_known(b); }
  void pass_known(int b, WideVectors& of_nodes, Message& message) const {
    message(std::span(of_nodes).subspan(static_cast<std::size_t>(first_known(b))));
  }

  std::vector<WideVectors> start_, velocity_start_;      // per batch, of the nodes from first_here on
  std::vector<WideVectors> half_solved_, force_, kept_;  // per batch
  std::vector<WideVectors> correction_, moved_;          // of the iteration before: f, and what became of x
  std::vector<Wide> flying_;                             // 1 for grains whose start is x_n + dt v_n, else 0
  std::vector<Wide> pace_;                               // t_k of follow_momentum
  std::vector<Wide> size_, halvings_;  // of the last correction and of its move, of follow_search
  std::vector<Vec<2>> proximal_;       // (outline vertices) c p/l on both components [N/m^2]
  std::vector<HeldSpin> held_;         // per batch
  std::vector<RigidStep> rigid_;       // per batch
  std::vector<Vec<2>> outline_increment_;
  OutlineState outline_;
  std::vector<Wall<2>> walls_start_;
  PeriodicCell<2> cell_start_;
  double press_moved_ = 0;  // of a wall by the present iteration [m]
  std::vector<OutlineContact> contacts_start_, found_;
  std::vector<Vec<2>> impulse_start_, felt_;
  std::vector<double> attraction_start_;
  int failed_grain_ = -1;
  bool slow_ = false;      // the whole step is slow
  double inertia_of_ = 0;  // A has the inertia of a step of at most this [R/c]
  MassDamping<2> damping_;
};

}  // namespace softgrain
