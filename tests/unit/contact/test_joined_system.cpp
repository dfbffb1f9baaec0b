#include <doctest/doctest.h>

#include <vector>

#include "softgrain/contact/joined_system.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "support/contact_problems.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

/// Some contacts of a system.
struct PartOfSystem {
  DelassusSystem<2>& all;
  int first = 0, count = 0;

  int size() const { return count; }
  Mat<2> delassus_block(int contact) const { return all.delassus_block(first + contact); }
  Vec<2> relative_velocity(int contact) const { return all.relative_velocity(first + contact); }
  void apply_impulse(int contact, const Vec<2>& dp) { all.apply_impulse(first + contact, dp); }
};

}  // namespace

TEST_CASE("two systems that share bodies are solved as one") {
  constexpr int contacts = 9, split = 4;
  const ContactProblem problem = random_problem(2, contacts, 0.3, 5);
  std::vector<Vec<2>> q;
  for (std::size_t c = 0; c < contacts; ++c) q.push_back({problem.q[2 * c], problem.q[2 * c + 1]});
  const SolverOptions tight{.max_sweeps = 50000, .tolerance = 1e-12};

  DelassusSystem<2> whole(problem.W, q);
  std::vector<Vec<2>> expected(contacts);
  REQUIRE(solve_nlgs<2>(whole, std::span(expected), problem.friction, tight).converged);

  DelassusSystem<2> shared(problem.W, q);
  PartOfSystem first{shared, 0, split}, second{shared, split, contacts - split};
  JoinedSystem<2, PartOfSystem, PartOfSystem> joined(first, second);
  CHECK(joined.size() == contacts);
  std::vector<Vec<2>> impulse(contacts);
  REQUIRE(solve_nlgs<2>(joined, std::span(impulse), problem.friction, tight).converged);
  for (int c = 0; c < contacts; ++c) {
    CHECK(impulse[c] == expected[c]);
    CHECK(joined.relative_velocity(c) == whole.relative_velocity(c));
  }
}
