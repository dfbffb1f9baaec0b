#pragma once
#include <optional>
#include <span>
#include <vector>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/contact/solver_options.hpp"
#include "softgrain/mpm/elastic_contacts.hpp"
#include "softgrain/mpm/outline_contacts.hpp"
#include "softgrain/mpm/soft_grains.hpp"
#include "softgrain/mpm/soft_step_report.hpp"
#include "softgrain/mpm/wall_motion.hpp"

namespace softgrain {

/// x and y of each vector, one after the other.
inline std::span<Wide> numbers(WideVectors& vectors) { return {&vectors[0][0], 2 * vectors.size()}; }

struct ImplicitOptions {
  double tolerance = 1e-4;  ///< largest correction of Newton's last iteration, over the mean grain radius
  int max_iterations = 40;  ///< of Newton's method
  double proximal =
      0.5;  ///< c of the term c p/l on the outline's diagonal of the tangent (p/l contact pressure)
  int max_halvings = 8;  ///< of the time step before NumericalError
  /// A is factored in single precision for steps up to this many explicit ones (h/c, stable_time_step); its
  /// condition is about 4 times the square of their ratio (docs/decisions/0019). 0: never
  double single_precision_steps = 60;
  SolverOptions solver{.max_sweeps = 500};  ///< NLGS, to a quarter of Newton's tolerance
  double friction = 0;                      ///< mu between grains
  double wall_friction = 0;                 ///< mu against walls
  Vec<2> gravity{};                         ///< [m/s^2]
  double damping = 0;                       ///< zeta [1/s], see MassDamping
};

/// Soft grains between walls by backward Euler with position-level contact (docs/theory.md, implicit MPM):
///   M (x - x_n - dt v_n)/dt^2 + f_int(x) = f_ext + H p/dt,   v = (x - x_n)/dt,
/// (f_ext: gravity and damping, which is that of v_n),
///   0 <= g(x) _|_ p_n >= 0,  |p_t| <= mu p_n.
/// Newton's method detects contacts anew in every iteration; A = M/dt^2 + K + proximal term is factored once
/// a step, and again where Newton's method needs many iterations; each grain follows the secant of its last
/// two corrections (docs/decisions/0021).
class ImplicitDynamics {
 public:
  ImplicitDynamics(SoftGrains soft_grains, std::vector<Wall<2>> plates,
                   const ImplicitOptions& implicit_options);

  /// One step of dt; walls move by dt times their velocity. A sub-step that does not converge, inverts a
  /// point or makes A indefinite is taken back and halved. Raises NumericalError after max_halvings, naming
  /// the grain.
  SoftStepReport step(double dt);

  /// Impulse of the grains on a wall in the last step [N s/m].
  const Vec<2>& wall_impulse(int wall) const { return wall_impulse_[wall]; }
  double mean_radius() const { return mean_radius_; }

  SoftGrains grains;
  std::vector<Wall<2>> walls;
  ImplicitOptions options;
  std::vector<OutlineContact> contacts;  ///< at the end of the last step
  std::vector<Vec<2>> impulse;           ///< theirs (p_n, p_t) [N s/m]
  double impulse_time = 0;               ///< the (sub-)step over which they acted [s]
  WorkBudget work;                       ///< since the start
  /// Unless empty: becomes the last contact problem of every step.
  std::optional<SolvedContactProblem> caught;

 private:
  enum class Failure { none, inverted_point, indefinite_matrix, not_finite, too_far, no_convergence };

  Failure try_step(double dt, SoftStepReport& report);
  Failure factor(double dt, double proximal, SoftStepReport& report);
  Failure residual(double dt);
  bool solve_contacts(double dt, SoftStepReport& report);
  double correct(bool same_matrix);
  void catch_problem(double dt);
  Failure finish(double dt, SoftStepReport& report);
  void balance_momentum(double dt);
  /// v_n and what damping changes of it, of a node of a batch.
  Vec<2, Wide> flight_velocity(std::size_t b, std::size_t i) const {
    const Vec<2, Wide>& v = velocity_start_[b][i];
    return options.damping > 0 ? v + damping_.velocity_change(start_[b][i], v) : v;
  }
  void add_work();
  void take_back();
  [[noreturn]] void give_up(Failure failure, double dt) const;
  std::vector<double> friction_of_contacts() const;

  double mean_radius_ = 0, smallest_radius_ = 0;
  double explicit_step_ = 0;  // h/c [s]
  OutlineNeighbours neighbours_;
  std::vector<BatchedCholesky> matrix_;
  std::vector<OutlineCompliance> compliance_;
  ElasticScratch scratch_;
  int batches() const { return static_cast<int>(grains.batches.size()); }
  bool none_failed(std::span<const int> grain_of_batch);

  std::vector<WideVectors> start_, velocity_start_, half_solved_, force_, kept_;  // per batch
  std::vector<WideVectors> correction_, moved_;  // of the iteration before: f, and what became of x
  std::vector<Vec<2>> outline_increment_;
  OutlineState outline_;
  std::vector<Wall<2>> walls_start_;
  std::vector<OutlineContact> contacts_start_;
  std::vector<Vec<2>> impulse_start_;
  std::vector<Vec<2>> wall_impulse_;
  int failed_grain_ = -1;
  MassDamping damping_;
};

}  // namespace softgrain
