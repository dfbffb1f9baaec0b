#include "softgrain/contact/assemble.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include "softgrain/contact/delassus_system.hpp"
#include "support/contact_problems.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

/// A chain: every contact feels its two neighbours.
ContactProblem chain(int contacts) {
  RandomNumbers random(5);
  ContactProblem problem{.dimension = 3, .W = {}, .q = {}, .friction = std::vector<double>(contacts, 0.3)};
  for (int c = 0; c < contacts; ++c)
    for (int b = std::max(0, c - 1); b < std::min(contacts, c + 2); ++b)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          problem.W.push_back({3 * b + i, 3 * c + j, random.uniform(-1, 1) + (b == c && i == j ? 4 : 0)});
  for (int k = 0; k < 3 * contacts; ++k) problem.q.push_back(random.uniform(-2, 2));
  return problem;
}

Eigen::MatrixXd full(const ContactProblem& problem) {
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(problem.q.size(), problem.q.size());
  for (const MatrixEntry& entry : problem.W) W(entry.row, entry.column) += entry.value;
  return W;
}

DelassusSystem<3> system_of(const ContactProblem& problem) {
  std::vector<Vec<3>> q(problem.friction.size());
  for (std::size_t k = 0; k < problem.q.size(); ++k) q[k / 3][static_cast<int>(k % 3)] = problem.q[k];
  return {problem.W, q};
}

}  // namespace

TEST_CASE("the problem that a system poses is the one it was made of, with no entry where nothing is felt") {
  const ContactProblem problem = chain(7);
  DelassusSystem<3> system = system_of(problem);
  const ContactProblem assembled = contact_problem_of<3>(system, problem.friction);
  CHECK(assembled.dimension == 3);
  CHECK(assembled.q == problem.q);
  CHECK(assembled.friction == problem.friction);
  CHECK(assembled.W.size() == problem.W.size());
  CHECK((full(assembled) - full(problem)).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("a problem that is too large to assemble is refused with its size") {
  const ContactProblem problem = chain(1);
  std::vector<Vec<3>> q(most_contacts_assembled + 1);
  DelassusSystem<3> system(problem.W, q);
  const std::vector<double> friction(q.size());
  CHECK_THROWS_WITH_AS(contact_problem_of<3>(system, friction), doctest::Contains("20001 contacts"),
                       UsageError);
}

TEST_CASE("in natural units the mean W_nn is 1, and velocities and energies per impulse stay") {
  const ContactProblem problem = chain(5);
  const std::vector<double> p{1, 0.1, 0, 2, 0, 0.2, 0, 0, 0, 3, 0.3, 0.3, 1, 0, 0};
  const ContactSolution before = assess_impulses({problem, p}, 0);
  const SolvedContactProblem scaled = in_natural_units({problem, p});
  double mean = 0;
  for (const MatrixEntry& entry : scaled.problem.W)
    if (entry.row == entry.column && entry.row % 3 == 0) mean += entry.value / 5;
  CHECK(mean == doctest::Approx(1).epsilon(1e-14));
  const ContactSolution after = assess_impulses(scaled, 0);
  for (std::size_t k = 0; k < p.size(); ++k)
    CHECK(after.velocity[k] == doctest::Approx(before.velocity[k]).epsilon(1e-13));
  CHECK(after.energy / scaled.impulse[0] == doctest::Approx(before.energy / p[0]).epsilon(1e-13));
}
