#include <doctest/doctest.h>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/contact/pushed_bodies.hpp"
#include "support/contact_problems.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

/// A system that leaves the contacts of some bodies to them.
struct WithBodies {
  DelassusSystem<2> base;
  PushedBodies* pushed;

  int size() const { return base.size(); }
  Mat<2> delassus_block(int contact) const { return base.delassus_block(contact); }
  Vec<2> relative_velocity(int contact) const { return base.relative_velocity(contact); }
  void apply_impulse(int contact, const Vec<2>& dp) { base.apply_impulse(contact, dp); }
  Violation sweep(std::span<Vec<2>> impulse, std::span<const double> friction, const SolverOptions& options) {
    Violation violation;
    for (int c = 0; c < size(); ++c)
      if (!pushed->has(c)) nlgs_update<2>(*this, c, impulse[c], friction[c], options.relaxation, violation);
    pushed->sweep<2>(*this, impulse, friction, options.relaxation, violation);
    return violation;
  }
};

std::vector<Vec<2>> local(const std::vector<double>& numbers) {
  std::vector<Vec<2>> vectors;
  for (std::size_t k = 0; k + 1 < numbers.size(); k += 2) vectors.push_back({numbers[k], numbers[k + 1]});
  return vectors;
}

constexpr SolverOptions tight{.max_sweeps = 50000, .tolerance = 1e-12};
constexpr int contacts = 8;
constexpr double share[contacts] = {1, 1, 0, 0.5, 0, 0, -1, 0};

/// The solution of a random problem and one body that some of its contacts push, v = free - mobility push.
struct Solved {
  std::vector<Vec<2>> impulse;
  double velocity = 0;
};
Solved solve_with_body(const ContactProblem& problem, double free, double mobility, double most,
                       double assumed) {
  PushedBodies pushed;
  pushed.bodies = {{.free = free, .mobility = mobility, .most = most, .assumed = assumed}};
  Solved solved{.impulse = std::vector<Vec<2>>(contacts)};
  for (int c = 0; c < contacts; ++c)
    if (share[c] != 0) pushed.add({.contact = c, .body = 0, .share = share[c]}, 0, contacts);
  std::vector<Vec<2>> q = local(problem.q);
  for (int c = 0; c < contacts; ++c) q[c][0] -= share[c] * assumed;
  WithBodies system{{problem.W, q}, &pushed};
  CHECK(solve_nlgs<2>(system, std::span(solved.impulse), problem.friction, tight).converged);
  solved.velocity = pushed.bodies[0].velocity();
  return solved;
}

/// The same with the body's mobility in W and its velocity in q.
std::vector<Vec<2>> solve_in_full(const ContactProblem& problem, double free, double mobility) {
  std::vector<MatrixEntry> W = problem.W;
  std::vector<Vec<2>> q = local(problem.q);
  for (int c = 0; c < contacts; ++c) {
    q[c][0] -= share[c] * free;
    for (int d = 0; d < contacts; ++d)
      W.push_back({.row = 2 * c, .column = 2 * d, .value = mobility * share[c] * share[d]});
  }
  DelassusSystem<2> system(W, q);
  std::vector<Vec<2>> impulse(contacts);
  CHECK(solve_nlgs<2>(system, std::span(impulse), problem.friction, tight).converged);
  return impulse;
}

}  // namespace

TEST_CASE("a body that contacts push gives the impulses of the problem that has it in its Delassus matrix") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const ContactProblem problem = random_problem(2, contacts, 0.3, seed);
    const double free = 0.7, mobility = 0.4;
    const std::vector<Vec<2>> full = solve_in_full(problem, free, mobility);
    for (const double assumed : {0.0, -2.0}) {  // what the system assumes of the velocity is taken back
      const Solved solved = solve_with_body(problem, free, mobility, 1e9, assumed);
      double push = 0;
      for (int c = 0; c < contacts; ++c) {
        CHECK(norm(solved.impulse[c] - full[c]) < 1e-8);
        push += share[c] * solved.impulse[c][0];
      }
      CHECK(solved.velocity == doctest::Approx(free - mobility * push).epsilon(1e-10));
    }
  }
}

TEST_CASE("a body at its largest speed is a wall that moves at that speed") {
  const ContactProblem problem = random_problem(2, contacts, 0.3, 3);
  const Solved solved = solve_with_body(problem, 1e6, 0.4, 0.25, 0);
  CHECK(solved.velocity == 0.25);
  const std::vector<Vec<2>> wall = solve_in_full(problem, 0.25, 0);
  for (int c = 0; c < contacts; ++c) CHECK(norm(solved.impulse[c] - wall[c]) < 1e-8);
}
