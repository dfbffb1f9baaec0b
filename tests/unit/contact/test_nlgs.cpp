#include <doctest/doctest.h>

#include <limits>

#include "softgrain/contact/nlgs.hpp"
#include "support/allocations.hpp"
#include "support/contact_problems.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

template <int Dim>
std::vector<Vec<Dim>> local(const Eigen::VectorXd& numbers) {
  std::vector<Vec<Dim>> vectors(static_cast<std::size_t>(numbers.size() / Dim));
  for (int k = 0; k < numbers.size(); ++k) vectors[k / Dim][k % Dim] = numbers[k];
  return vectors;
}

/// A problem with its system and impulses, from rest.
template <int Dim>
struct Solve {
  ContactProblem problem;
  DelassusSystem<Dim> system;
  std::vector<Vec<Dim>> p;

  explicit Solve(const ContactProblem& given)
      : problem(given), system(problem.W, local<Dim>(vector_of(problem.q))), p(problem.contacts()) {}

  SolverReport nlgs(const SolverOptions& options) {
    return solve_nlgs<Dim>(system, std::span(p), problem.friction, options);
  }
  Eigen::VectorXd impulse() const {
    return Eigen::Map<const Eigen::VectorXd>(p[0].c.data(), Dim * problem.contacts());
  }
  /// u = W p + q by the dense matrix.
  Eigen::VectorXd velocity() const { return dense_W(problem) * impulse() + vector_of(problem.q); }
};

constexpr SolverOptions tight{.max_sweeps = 20000, .tolerance = 1e-12};

}  // namespace

TEST_CASE("a falling column is stopped by impulses that carry the momentum above") {
  Solve<2> column(falling_column(10, 2, 0.5));
  const SolverReport report = column.nlgs(tight);
  CHECK(report.converged);
  for (int k = 0; k < 10; ++k) CHECK(column.p[k][0] == doctest::Approx((10 - k) * 2 * 0.5).epsilon(1e-9));
  CHECK(column.velocity().cwiseAbs().maxCoeff() < 1e-11);
}

TEST_CASE("sweeps that start ahead of the last find the same impulses in fewer sweeps") {
  SolverOptions ahead = tight;
  ahead.extrapolated = true;
  int plain_sweeps = 0, ahead_sweeps = 0;
  for (const double mu : {0.0, 0.3}) {
    Solve<2> plain(falling_column(30, 2, 0.5)), fast = plain;
    plain.problem.friction.assign(30, mu);
    fast.problem.friction.assign(30, mu);
    const SolverReport slow_report = plain.nlgs(tight), fast_report = fast.nlgs(ahead);
    CHECK(slow_report.converged);
    CHECK(fast_report.converged);
    plain_sweeps += slow_report.sweeps;
    ahead_sweeps += fast_report.sweeps;
    for (int k = 0; k < 30; ++k) {
      CHECK(fast.p[k][0] == doctest::Approx((30 - k) * 2 * 0.5).epsilon(1e-8));
      CHECK(fast.p[k][0] == doctest::Approx(plain.p[k][0]).epsilon(1e-8));
    }
    CHECK(fast.velocity().cwiseAbs().maxCoeff() < 1e-10);
  }
  CHECK(ahead_sweeps < plain_sweeps / 4);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Solve<2> solve(random_problem(2, 8, 0.4, seed));
    CHECK(solve.nlgs(ahead).converged);
    CHECK(law_defects(solve.problem, solve.impulse(), solve.velocity()).worst() < 1e-9);
  }
}

TEST_CASE_TEMPLATE("NLGS finds impulses that obey Signorini and Coulomb in every contact", Dim,
                   std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Solve<Dim::value> solve(random_problem(Dim::value, 8, 0.1 * static_cast<double>(seed), seed));
    CHECK(solve.nlgs(tight).converged);
    const Eigen::VectorXd p = solve.impulse(), u = solve.velocity();
    CHECK(law_defects(solve.problem, p, u).worst() < 1e-9);
    CHECK(p.dot(u + vector_of(solve.problem.q)) <= 0);  // no energy from nothing
  }
}

TEST_CASE("NLGS leaves the velocities that belong to its impulses") {
  Solve<2> solve(squeezed_packing(5, 0.4, 1));
  solve.nlgs({.max_sweeps = 7, .tolerance = 0});
  const auto expected = local<2>(solve.velocity());
  for (int c = 0; c < solve.system.size(); ++c)
    CHECK(norm(solve.system.relative_velocity(c) - expected[c]) < 1e-14);
}

TEST_CASE("a start from the solution is recognised in one sweep, even by another tolerance's unit") {
  Solve<2> solve(squeezed_packing(5, 0.4, 2));
  CHECK(solve.nlgs(tight).sweeps > 20);
  const auto solution = solve.p;
  const SolverReport again = solve.nlgs({.max_sweeps = 100, .tolerance = 1e-10, .velocity_scale = 0.1});
  CHECK(again.converged);
  CHECK(again.sweeps == 1);
  for (int c = 0; c < solve.system.size(); ++c) CHECK(norm(solve.p[c] - solution[c]) < 1e-10);
}

TEST_CASE("over-relaxation changes the way, not the velocities") {
  const ContactProblem problem = falling_column(60, 1, 1);
  Solve<2> plain(problem), relaxed(problem);
  const SolverReport slow = plain.nlgs({.max_sweeps = 100000, .tolerance = 1e-9, .relaxation = 1});
  const SolverReport fast = relaxed.nlgs({.max_sweeps = 100000, .tolerance = 1e-9, .relaxation = 1.6});
  CHECK(fast.converged);
  CHECK(fast.sweeps < slow.sweeps / 2);
  CHECK((plain.velocity() - relaxed.velocity()).norm() < 1e-7);
}

TEST_CASE("over-relaxed impulses stay in the cone in every sweep") {
  Solve<2> solve(squeezed_packing(6, 0.3, 7));
  for (int sweep = 0; sweep < 5; ++sweep) {
    solve.nlgs({.max_sweeps = 1, .tolerance = 0, .relaxation = 1.6});
    for (const Vec<2>& p : solve.p) CHECK(std::abs(p[1]) <= 0.3 * p[0] * (1 + 1e-14));
  }
}

TEST_CASE("the velocities depend on no order of the contacts, the impulses may") {
  const ContactProblem problem = squeezed_packing(5, 0, 3);
  const int n = problem.contacts();
  const auto turned = [n](int row) { return 2 * (n - 1 - row / 2) + row % 2; };  // last contact first
  ContactProblem reversed = problem;
  for (MatrixEntry& entry : reversed.W) entry = {turned(entry.row), turned(entry.column), entry.value};
  for (int k = 0; k < 2 * n; ++k) reversed.q[turned(k)] = problem.q[k];
  Solve<2> forward(problem), backward(reversed);
  CHECK(forward.nlgs(tight).converged);
  CHECK(backward.nlgs(tight).converged);
  const Eigen::VectorXd u = forward.velocity(), v = backward.velocity();
  for (int k = 0; k < 2 * n; ++k) CHECK(u[k] == doctest::Approx(v[turned(k)]).scale(1).epsilon(1e-10));
}

TEST_CASE("NLGS reports the violation in units of velocity_scale, and says when it stopped early") {
  const ContactProblem problem = squeezed_packing(5, 0.3, 4);
  Solve<2> one(problem), two(problem);
  const SolverReport a = one.nlgs({.max_sweeps = 3, .tolerance = 1e-6, .velocity_scale = 1});
  const SolverReport b = two.nlgs({.max_sweeps = 3, .tolerance = 1e-6, .velocity_scale = 4});
  CHECK(!a.converged);
  CHECK(a.sweeps == 3);
  CHECK(a.residual_mean == doctest::Approx(4 * b.residual_mean));
  CHECK(a.residual_max == doctest::Approx(4 * b.residual_max));
  CHECK(a.residual_max > a.residual_mean);
}

TEST_CASE("a mean below the tolerance is not enough when the worst contact is far off") {
  Solve<2> strict(squeezed_packing(6, 0, 5)), lenient(strict.problem);
  const SolverReport a = strict.nlgs({.tolerance = 1e-3, .worst_factor = 1});
  const SolverReport b = lenient.nlgs({.tolerance = 1e-3, .worst_factor = 100});
  CHECK(a.residual_max <= 1e-3);
  CHECK(b.residual_max > 1e-3);
  CHECK(b.sweeps < a.sweeps);
}

TEST_CASE("NLGS sweeps min_sweeps times even when all is well, and gives up on NaN") {
  Solve<2> rest(falling_column(3, 1, 0));
  CHECK(rest.nlgs({.min_sweeps = 4}).sweeps == 4);
  ContactProblem broken = falling_column(3, 1, 1);
  broken.q[2] = std::numeric_limits<double>::quiet_NaN();
  Solve<2> nan(broken);
  const SolverReport report = nan.nlgs({.max_sweeps = 50});
  CHECK(report.sweeps == 1);
  CHECK(!report.converged);
}

TEST_CASE("NLGS allocates nothing") {
  Solve<2> solve(squeezed_packing(5, 0.4, 6));
  const std::size_t before = allocations();
  solve.nlgs({.max_sweeps = 10, .tolerance = 0});
  CHECK(allocations() == before);
}

TEST_CASE("a system that brings its own sweep is swept by it") {
  struct OwnSweep : DelassusSystem<2> {
    using DelassusSystem<2>::DelassusSystem;
    int sweeps = 0;
    Violation sweep(std::span<Vec<2>>, std::span<const double>, const SolverOptions&) {
      return {.sum_of_squares = 8, .max_square = 4, .contacts = ++sweeps};
    }
  };
  const ContactProblem problem = falling_column(3, 1, 1);
  OwnSweep system(problem.W, local<2>(vector_of(problem.q)));
  std::vector<Vec<2>> p(3);
  const SolverReport report =
      solve_nlgs<2>(system, std::span(p), problem.friction, {.max_sweeps = 2, .velocity_scale = 0.5});
  CHECK(system.sweeps == 2);
  CHECK(report.residual_mean == doctest::Approx(2 / 0.5));  // sqrt(8/2)
  CHECK(report.residual_max == doctest::Approx(2 / 0.5));
}
