#include "softgrain/contact/contact_problem.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "softgrain/contact/assemble.hpp"
#include "softgrain/contact/nesterov.hpp"
#include "softgrain/contact/nlgs.hpp"

namespace softgrain {

namespace {

constexpr int sweeps_between_checks = 10;  // a check costs about a sweep
constexpr int first_turn = 1000;  // of a method, before the other one tries; each turn is twice as long

template <int Dim>
std::vector<Vec<Dim>> local_vectors(const std::vector<double>& numbers) {
  std::vector<Vec<Dim>> vectors(numbers.size() / Dim);
  for (std::size_t k = 0; k < numbers.size(); ++k) vectors[k / Dim][static_cast<int>(k % Dim)] = numbers[k];
  return vectors;
}

/// Mean W_nn [1/kg], or 1.
template <int Dim>
double mean_normal_delassus(const DelassusSystem<Dim>& system) {
  double sum = 0;
  for (int c = 0; c < system.size(); ++c) sum += system.delassus_block(c)(0, 0);
  return sum > 0 ? sum / system.size() : 1;
}

/// What p is worth: everything but the number of sweeps.
template <int Dim>
ContactSolution assess(const DelassusSystem<Dim>& system, const std::vector<Vec<Dim>>& p,
                       const ContactProblem& problem) {
  const double W_nn = mean_normal_delassus(system);
  std::vector<Vec<Dim>> u(p.size()), W_nn_p(p.size());
  double q_square = 0;
  for (int c = 0; c < system.size(); ++c) {
    u[c] = system.relative_velocity(c);
    W_nn_p[c] = W_nn * p[c];
    q_square += dot(system.free_velocity()[c], system.free_velocity()[c]);
  }
  ContactSolution solution{.impulse = flat<Dim>(p), .velocity = flat<Dim>(u)};
  solution.residual =
      natural_map_residual<Dim>(W_nn_p, u, problem.friction) / (q_square > 0 ? std::sqrt(q_square) : 1);
  solution.energy = contact_energy<Dim>(p, u, system.free_velocity());
  return solution;
}

/// One method on its way, with the best that it has seen.
template <int Dim>
class Attempt {
 public:
  Attempt(const ContactProblem& problem, const ContactProblemOptions& options, ContactMethod method)
      : problem_(problem),
        options_(options),
        system_(problem.W, local_vectors<Dim>(problem.q)),
        p_(system_.size()),
        best(assess(system_, p_, problem)) {
    best.method = method;
    if (method == ContactMethod::nesterov) nesterov_.emplace(system_, p_, problem.friction);
  }
  Attempt(const Attempt&) = delete;

  bool converged() const { return best.residual <= options_.tolerance; }
  /// Given up: after all sweeps, or without hope.
  bool ended() const { return best.sweeps >= options_.max_sweeps || best.sweeps > 5 * best_sweeps_ + 20000; }

  /// Goes on until converged, ended, or `sweeps` in all.
  void advance(int sweeps) {
    while (!converged() && !ended() && best.sweeps < sweeps) {
      for (int k = 0; k < sweeps_between_checks && best.sweeps < options_.max_sweeps; ++k, ++best.sweeps)
        sweep();
      ContactSolution now = assess(system_, p_, problem_);
      if (!(now.residual < best.residual)) continue;
      now.method = best.method;
      now.sweeps = best_sweeps_ = best.sweeps;
      best = std::move(now);
    }
    best.converged = converged();
  }

 private:
  void sweep() {
    if (nesterov_) return nesterov_->advance();
    ahead_.go_ahead(system_, std::span(p_));
    ahead_.see(nlgs_sweep<Dim>(system_, std::span(p_), problem_.friction, 1));
  }

  const ContactProblem& problem_;
  const ContactProblemOptions& options_;
  DelassusSystem<Dim> system_;
  std::vector<Vec<Dim>> p_;
  std::optional<NesterovIteration<Dim, DelassusSystem<Dim>>> nesterov_;
  Extrapolation<Dim> ahead_;  // of NLGS
  int best_sweeps_ = 0;

 public:
  ContactSolution best;
};

template <int Dim>
ContactSolution solve(const ContactProblem& problem, const ContactProblemOptions& options) {
  if (options.method != ContactMethod::automatic) {
    Attempt<Dim> attempt(problem, options, options.method);
    attempt.advance(options.max_sweeps);
    return attempt.best;
  }
  Attempt<Dim> nesterov(problem, options, ContactMethod::nesterov),
      nlgs(problem, options, ContactMethod::nlgs);
  for (std::int64_t sweeps = first_turn; !(nesterov.ended() && nlgs.ended()); sweeps *= 2) {
    const int most = static_cast<int>(std::min<std::int64_t>(sweeps, options.max_sweeps));
    for (Attempt<Dim>* attempt : {&nesterov, &nlgs}) {
      attempt->advance(most);
      if (attempt->converged()) return attempt->best;
    }
  }
  return nlgs.best.residual < nesterov.best.residual ? nlgs.best : nesterov.best;
}

template <int Dim>
ContactSolution assess(const SolvedContactProblem& solved) {
  const ContactProblem& problem = solved.problem;
  DelassusSystem<Dim> system(problem.W, local_vectors<Dim>(problem.q));
  const std::vector<Vec<Dim>> p = local_vectors<Dim>(solved.impulse);
  for (int c = 0; c < system.size(); ++c) system.apply_impulse(c, p[c]);
  return assess<Dim>(system, p, problem);
}

}  // namespace

SolvedContactProblem in_natural_units(SolvedContactProblem solved) {
  ContactProblem& problem = solved.problem;
  double sum = 0;
  for (const MatrixEntry& entry : problem.W)
    if (entry.row == entry.column && entry.row % problem.dimension == 0) sum += entry.value;
  if (!(sum > 0)) return solved;
  const double unit = problem.contacts() / sum;
  for (MatrixEntry& entry : problem.W) entry.value *= unit;
  for (double& p : solved.impulse) p /= unit;
  return solved;
}

ContactSolution assess_impulses(const SolvedContactProblem& solved, double tolerance) {
  ContactSolution solution = solved.problem.dimension == 2 ? assess<2>(solved) : assess<3>(solved);
  solution.converged = solution.residual <= tolerance;
  return solution;
}

ContactSolution solve_contact_problem(const ContactProblem& problem, const ContactProblemOptions& options) {
  return problem.dimension == 2 ? solve<2>(problem, options) : solve<3>(problem, options);
}

}  // namespace softgrain
