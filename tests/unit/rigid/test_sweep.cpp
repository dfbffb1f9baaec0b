#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/contact/nlgs.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;
using test::Plane;
using test::Space;

namespace {

template <int N>
double largest_difference(const std::vector<Vec<N>>& a, const std::vector<Vec<N>>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
  return largest;
}

template <int Dim>
void check_same_state(const test::ContactScene<Dim>& a, const test::ContactScene<Dim>& b) {
  CHECK(largest_difference(a.contacts.impulse, b.contacts.impulse) < 1e-13);  // impulses are about 1
  CHECK(largest_difference(a.bodies.velocity, b.bodies.velocity) < 1e-13);
  CHECK(largest_difference(a.bodies.spin, b.bodies.spin) < 1e-13);
}

/// Some sweeps by the system's own sweep and by the plain one, in the same order of contacts.
template <int Dim>
void check_own_sweep(const FrictionRule& friction, double relaxation) {
  test::ContactScene<Dim> own(Dim == 2 ? 9 : 4, friction), plain(Dim == 2 ? 9 : 4, friction);
  auto own_system = own.system(), plain_system = plain.system();
  for (int sweep = 0; sweep < 5; ++sweep) {
    const Violation by_own =
        own_system.sweep(own.contacts.impulse, own.contacts.friction, {.relaxation = relaxation});
    const Violation by_plain =
        nlgs_sweep<Dim>(plain_system, plain.contacts.impulse, plain.contacts.friction, relaxation);
    if (relaxation != 1) continue;  // the over-relaxed jump is measured before or after the clamp
    CHECK(by_own.sum_of_squares == doctest::Approx(by_plain.sum_of_squares).epsilon(1e-12));
    CHECK(by_own.max_square == doctest::Approx(by_plain.max_square).epsilon(1e-12));
    CHECK(by_own.contacts == by_plain.contacts);
  }
  check_same_state(own, plain);
}

double frictionless(int, int) { return 0; }

/// Signorini's and Coulomb's laws at one contact; u is about 1 where it does not vanish.
template <int Dim>
void check_law(const Vec<Dim>& u, const Vec<Dim>& p, double mu) {
  const double accuracy = 1e-9;
  Vec<Dim> u_t = u, p_t = p;
  u_t[0] = p_t[0] = 0;
  REQUIRE(p[0] >= 0);
  REQUIRE(u[0] > -accuracy);
  REQUIRE(std::abs(p[0] * u[0]) < accuracy);
  REQUIRE(norm(p_t) <= mu * p[0] + accuracy);
  if (p[0] < 1e-6 || mu == 0) return;
  if (norm(p_t) < mu * p[0] - 1e-6)
    REQUIRE(norm(u_t) < accuracy);  // sticks
  else
    REQUIRE(std::abs(dot(u_t, p_t) + norm(u_t) * norm(p_t)) < accuracy);  // slides against its friction
}

}  // namespace

TEST_CASE_TEMPLATE("the fused sweep is the plain sweep", Dimension, Plane, Space) {
  check_own_sweep<Dimension::value>(test::mixed_friction, 1);
  check_own_sweep<Dimension::value>(frictionless, 1);
}

TEST_CASE_TEMPLATE("without friction the over-relaxed fused sweep is the plain sweep", Dimension, Plane,
                   Space) {
  check_own_sweep<Dimension::value>(frictionless, 1.3);
}

TEST_CASE("four contacts at once change what one by one change") {
  for (const double relaxation : {1.0, 1.3}) {
    test::ContactScene<2> four(9), one(9);
    for (ContactBlock& block : one.contacts.blocks)
      for (ContactBatch* batch : {&block.frictionless, &block.frictional}) batch->fours_end = batch->begin;
    auto system_of_four = four.system(), system_of_one = one.system();
    for (int sweep = 0; sweep < 5; ++sweep) {
      const SolverOptions options{.relaxation = relaxation};
      const Violation a = system_of_four.sweep(four.contacts.impulse, four.contacts.friction, options);
      const Violation b = system_of_one.sweep(one.contacts.impulse, one.contacts.friction, options);
      CHECK(a.sum_of_squares == doctest::Approx(b.sum_of_squares).epsilon(1e-12));
      CHECK(a.max_square == doctest::Approx(b.max_square).epsilon(1e-12));
      CHECK(a.contacts == b.contacts);
    }
    check_same_state(four, one);
  }
}

TEST_CASE_TEMPLATE("sweeps end where Signorini's and Coulomb's laws hold in every contact", Dimension, Plane,
                   Space) {
  constexpr int Dim = Dimension::value;
  for (const double relaxation : {1.0, 1.3}) {
    test::ContactScene<Dim> scene(Dim == 2 ? 7 : 4);
    auto system = scene.system();
    const SolverReport report = solve_nlgs<Dim>(
        system, scene.contacts.impulse, scene.contacts.friction,
        {.max_sweeps = 100000, .tolerance = 1e-13, .velocity_scale = 1, .relaxation = relaxation});
    REQUIRE(report.converged);
    int carrying = 0, sticking = 0;
    for (int c = 0; c < system.size(); ++c) {
      const Vec<Dim>& p = scene.contacts.impulse[c];
      check_law(system.relative_velocity(c), p, scene.contacts.friction[c]);
      carrying += p[0] > 0 ? 1 : 0;
      sticking += std::abs(p[1]) < 0.39 * p[0] ? 1 : 0;
    }
    CHECK(carrying > 20);
    CHECK(sticking > 5);
  }
}

TEST_CASE_TEMPLATE("kept impulses applied to the free velocities give the velocities of their solution",
                   Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  test::ContactScene<Dim> solved(Dim == 2 ? 7 : 4), started(Dim == 2 ? 7 : 4);
  auto solved_system = solved.system(), started_system = started.system();
  for (int sweep = 0; sweep < 5; ++sweep)
    solved_system.sweep(solved.contacts.impulse, solved.contacts.friction, {});
  started.contacts.impulse = solved.contacts.impulse;
  started_system.apply_impulses(started.contacts.impulse);
  check_same_state(solved, started);
}
