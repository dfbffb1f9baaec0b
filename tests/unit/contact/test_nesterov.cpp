#include <doctest/doctest.h>

#include "softgrain/contact/assemble.hpp"
#include "softgrain/contact/nesterov.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "support/contact_problems.hpp"
#include "support/interior_point.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

/// W and q of the normal components alone.
struct Frictionless {
  Eigen::MatrixXd W;
  Eigen::VectorXd q;

  explicit Frictionless(const ContactProblem& problem) {
    const Eigen::MatrixXd all = dense_W(problem);
    const int n = problem.contacts(), d = problem.dimension;
    W = all(Eigen::seqN(0, n, d), Eigen::seqN(0, n, d));
    q = vector_of(problem.q)(Eigen::seqN(0, n, d));
  }
  double energy(const Eigen::VectorXd& p) const { return p.dot(W * p) / 2 + q.dot(p); }
};

/// Iterations until the largest violation of the law is below `tolerance` [m/s], at most 20000.
int iterations_of_nesterov(ContactScene<2>& scene, std::vector<Vec<2>>& p, double tolerance) {
  auto system = scene.system();
  NesterovIteration<2, decltype(system)> iteration(system, std::span(p), scene.contacts.friction);
  int k = 0;
  for (; k < 20000 && iteration.violation().max_square > tolerance * tolerance; ++k) iteration.advance();
  return k;
}

/// The normal components of a local vector.
Eigen::VectorXd normal(const ContactProblem& problem, const std::vector<double>& numbers) {
  return vector_of(numbers)(Eigen::seqN(0, problem.contacts(), problem.dimension));
}

ContactSolution solve(const ContactProblem& problem, ContactMethod method, double tolerance = 1e-13) {
  return solve_contact_problem(problem, {.method = method, .tolerance = tolerance});
}

}  // namespace

TEST_CASE("NLGS, Nesterov and an interior point agree on squeezed frictionless packings") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ContactProblem problem = squeezed_packing(8, 0, seed);
    const Frictionless oracle(problem);
    const Eigen::VectorXd p = solve_by_interior_point(oracle.W, oracle.q);
    const Eigen::VectorXd u = oracle.W * p + oracle.q;
    REQUIRE(u.cwiseMin(p).cwiseAbs().maxCoeff() < 1e-10);  // the oracle itself obeys the law
    REQUIRE((p.array() > 1e-3).count() > problem.contacts() / 4);
    for (const ContactMethod method : {ContactMethod::nesterov, ContactMethod::nlgs}) {
      const ContactSolution solution = solve(problem, method);
      CHECK(solution.converged);
      CHECK((normal(problem, solution.velocity) - u).norm() < 1e-10);
      CHECK(solution.energy == doctest::Approx(oracle.energy(p)).epsilon(1e-10));
    }
  }
}

TEST_CASE("Nesterov solves rigid bodies through the four questions alone, as NLGS does") {
  ContactScene<2> one(8, [](int, int) { return 0.0; }), two(8, [](int, int) { return 0.0; });
  auto other = two.system();
  std::vector<Vec<2>> p(one.contacts.size()), p_nlgs(two.contacts.size());
  const SolverOptions options{.max_sweeps = 20000, .tolerance = 1e-11, .velocity_scale = 1};
  CHECK(iterations_of_nesterov(one, p, 1e-11) < 20000);
  CHECK(solve_nlgs<2>(other, std::span(p_nlgs), two.contacts.friction, options).converged);
  for (std::size_t i = 0; i < one.bodies.velocity.size(); ++i)
    CHECK(norm(one.bodies.velocity[i] - two.bodies.velocity[i]) < 1e-8);
}

TEST_CASE("Nesterov finds impulses that obey Signorini and Coulomb in every contact") {
  for (const int dimension : {2, 3})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const ContactProblem problem = random_problem(dimension, 8, 0.1 * static_cast<double>(seed), seed);
      const ContactSolution solution = solve(problem, ContactMethod::nesterov);
      CHECK(solution.converged);
      const Eigen::VectorXd p = vector_of(solution.impulse), q = vector_of(problem.q);
      const Eigen::VectorXd u = dense_W(problem) * p + q;
      CHECK((u - vector_of(solution.velocity)).norm() < 1e-12);
      CHECK(law_defects(problem, p, u).worst() < 1e-9);
      CHECK(p.dot(u + q) <= 0);
    }
}

TEST_CASE("Nesterov does not cycle where friction is large") {
  for (const double mu : {2.0, 3.0})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const ContactProblem problem = squeezed_packing(6, mu, seed);
      const ContactSolution solution = solve(problem, ContactMethod::nesterov, 1e-10);
      CHECK(solution.converged);
      const Eigen::VectorXd p = vector_of(solution.impulse);
      CHECK(law_defects(problem, p, dense_W(problem) * p + vector_of(problem.q)).worst() < 1e-7);
    }
}

TEST_CASE("frictional packings dissipate, more with friction than without, by either method") {
  double smooth_energy = 0;
  for (const double mu : {0.0, 0.5}) {
    const ContactProblem problem = squeezed_packing(7, mu, 9);
    for (const ContactMethod method : {ContactMethod::nesterov, ContactMethod::nlgs}) {
      const ContactSolution solution = solve(problem, method, 1e-11);
      CHECK(solution.converged);
      const Eigen::VectorXd p = vector_of(solution.impulse);
      CHECK(law_defects(problem, p, dense_W(problem) * p + vector_of(problem.q)).worst() < 1e-8);
      CHECK(solution.energy < smooth_energy);
    }
    smooth_energy = solve(problem, ContactMethod::nesterov).energy;
  }
}

TEST_CASE("both methods stop a tall column in a tenth of the sweeps of plain Gauss-Seidel") {
  const ContactProblem problem = falling_column(100, 1, 1);
  int most = 0;
  for (const ContactMethod method : {ContactMethod::nesterov, ContactMethod::nlgs}) {
    const ContactSolution solution = solve(problem, method, 1e-8);
    CHECK(solution.converged);
    for (int k = 0; k < 100; ++k) CHECK(solution.impulse[2 * k] == doctest::Approx(100 - k).epsilon(1e-4));
    most = std::max(most, solution.sweeps);
  }
  std::vector<Vec<2>> q(problem.contacts()), p(problem.contacts());
  for (int c = 0; c < problem.contacts(); ++c) q[c] = {problem.q[2 * c], problem.q[2 * c + 1]};
  DelassusSystem<2> system(problem.W, q);
  for (int k = 0; k < 10 * most; ++k) nlgs_sweep<2>(system, std::span(p), problem.friction, 1);
  CHECK_FALSE(assess_impulses({problem, flat<2>(p)}, 1e-8).converged);
}

TEST_CASE("Nesterov starts from the impulses it is given") {
  ContactScene<2> scene(8);
  std::vector<Vec<2>> p(scene.contacts.size());
  CHECK(iterations_of_nesterov(scene, p, 1e-11) > 10);
  CHECK(iterations_of_nesterov(scene, p, 1e-9) == 0);
}
