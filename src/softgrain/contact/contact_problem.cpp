#include "softgrain/contact/contact_problem.hpp"

#include <cmath>
#include <limits>
#include <span>

#include "softgrain/contact/assemble.hpp"
#include "softgrain/contact/nesterov.hpp"
#include "softgrain/contact/nlgs.hpp"

namespace softgrain {

namespace {

constexpr int sweeps_between_checks = 10;  // a check costs about a sweep

template <int Dim>
std::vector<Vec<Dim>> local_vectors(const std::vector<double>& numbers) {
  std::vector<Vec<Dim>> vectors(numbers.size() / Dim);
  for (std::size_t k = 0; k < numbers.size(); ++k) vectors[k / Dim][static_cast<int>(k % Dim)] = numbers[k];
  return vectors;
}

/// What p is worth: everything but the number of sweeps.
template <int Dim>
ContactSolution assess(const DelassusSystem<Dim>& system, const std::vector<Vec<Dim>>& p,
                       const ContactProblem& problem) {
  std::vector<Vec<Dim>> u(p.size());
  double q_square = 0;
  for (int c = 0; c < system.size(); ++c) {
    u[c] = system.relative_velocity(c);
    q_square += dot(system.free_velocity()[c], system.free_velocity()[c]);
  }
  ContactSolution solution{.impulse = flat<Dim>(p), .velocity = flat<Dim>(u)};
  solution.residual =
      natural_map_residual<Dim>(p, u, problem.friction) / (q_square > 0 ? std::sqrt(q_square) : 1);
  solution.energy = contact_energy<Dim>(p, u, system.free_velocity());
  return solution;
}

/// Calls `sweep`, which improves p and the system together, and keeps the best.
template <int Dim, class Sweep>
ContactSolution iterate(const DelassusSystem<Dim>& system, const std::vector<Vec<Dim>>& p,
                        const ContactProblem& problem, const ContactProblemOptions& options, Sweep sweep) {
  ContactSolution best = assess(system, p, problem);
  int sweeps = 0, best_sweeps = 0;
  const auto hopeless = [&] { return sweeps > 5 * best_sweeps + 20000; };
  while (best.residual > options.tolerance && sweeps < options.max_sweeps && !hopeless()) {
    for (int k = 0; k < sweeps_between_checks && sweeps < options.max_sweeps; ++k, ++sweeps) sweep();
    ContactSolution now = assess(system, p, problem);
    if (!(now.residual < best.residual)) continue;
    best = std::move(now);
    best_sweeps = sweeps;
  }
  best.sweeps = sweeps;
  best.converged = best.residual <= options.tolerance;
  return best;
}

template <int Dim>
ContactSolution solve(const ContactProblem& problem, const ContactProblemOptions& options) {
  DelassusSystem<Dim> system(problem.W, local_vectors<Dim>(problem.q));
  std::vector<Vec<Dim>> p(system.size());
  if (options.method == ContactMethod::nlgs)
    return iterate<Dim>(system, p, problem, options,
                        [&] { nlgs_sweep<Dim>(system, std::span(p), problem.friction, 1); });
  NesterovIteration<Dim, DelassusSystem<Dim>> nesterov(system, p, problem.friction);
  return iterate<Dim>(system, p, problem, options, [&] { nesterov.advance(); });
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
