#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/lattice/updated_lagrangian.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double zeta = 2e4, rho = 1000;

SoftGrains moving_grain(const Vec<2>& velocity) {
  return {{test::placed(test::disk(3), 1e-3, {0, 0}, velocity)},
          make_law(MaterialLaw::neo_hookean, 1e7, 0.3),
          rho};
}

/// Kinetic and elastic energy, and what of the work is not accounted for.
template <class Dynamics>
double missing_energy(const Dynamics& dynamics, double start) {
  const WorkBudget& work = dynamics.work;
  return start + work.walls - dynamics.grains.kinetic_energy() - work.internal - work.inertia -
         work.contacts - work.damping;
}

}  // namespace

TEST_CASE("a free damped grain slows down as exp(-zeta t), in both integrators and in steps of any length") {
  const Vec<2> v{3, -2};
  const double time = 1e-4, expected = std::exp(-zeta * time);
  const auto check = [&](auto dynamics, int steps) {
    const double start = dynamics.grains.kinetic_energy();
    for (int k = 0; k < steps; ++k) dynamics.step(time / steps);
    const Vec<2> now = (1 / dynamics.grains.mass(0)) * dynamics.grains.momentum();
    CHECK(norm(now - expected * v) < 1e-10);
    CHECK(std::abs(missing_energy(dynamics, start)) < 1e-10 * start);
    CHECK(dynamics.work.damping > 0);
    if (steps == 100)  // to first order in zeta dt
      CHECK(dynamics.work.damping == doctest::Approx(start * (1 - expected * expected)).epsilon(0.03));
  };
  for (const int steps : {1, 3, 100}) {
    check(ImplicitDynamics(moving_grain(v), {}, {.damping = zeta}), steps);
    check(ExplicitDynamics(moving_grain(v), {}, {.damping_share = 0.5, .damping = zeta}), steps);
  }
  PointGrain grain = disk_of_points(1e-3, {}, 2e-4, 24);
  for (Vec<2>& v_p : grain.velocity) v_p = v;
  UpdatedLagrangianDynamics lagrangian({std::move(grain)}, {}, make_law(MaterialLaw::neo_hookean, 1e7, 0.3),
                                       rho, {.cell = 2e-4, .damping = zeta});
  for (int k = 0; k < 1000; ++k) lagrangian.step(time / 1000);
  for (const Vec<2>& v_p : lagrangian.grains[0].velocity) CHECK(norm(v_p - expected * v) < 1e-9);
}

TEST_CASE("grains that follow the walls feel no damping, grains that do not are brought to follow them") {
  // walls at y = -2 mm, at rest, and 2 mm, with -40 m/s; x between walls that go apart with 10 m/s each
  const Box<2> walls({
      test::floor_at(-2e-3),
      {.point = {0, 2e-3}, .normal = {0, -1}, .velocity = {0, -40}},
      {.point = {-5e-3, 0}, .normal = {1, 0}, .velocity = {-10, 0}},
      {.point = {5e-3, 0}, .normal = {-1, 0}, .velocity = {10, 0}},
  });
  const AffineMotion motion(walls);
  CHECK(norm(motion.at(Vec<2>{0, -2e-3}) - Vec<2>{0, 0}) < 1e-12);
  CHECK(norm(motion.at(Vec<2>{5e-3, 0}) - Vec<2>{10, -20}) < 1e-12);
  CHECK(norm(motion.at(Vec<2>{-2.5e-3, 1e-3}) - Vec<2>{-5, -30}) < 1e-12);
  CHECK(norm(AffineMotion(Box<2>({walls.walls.front()})).at(Vec<2>{1, 1})) == 0);  // nothing faces the floor

  const MassDamping damping(zeta, 1e-5, walls);
  const Vec<2> x{1e-3, 1e-3}, follows = motion.at(x);
  CHECK(norm(damping.velocity_change(x, follows)) == 0);
  const Vec<2> change = damping.velocity_change(x, follows + Vec<2>{1, 2});
  CHECK(norm(change + (1 - std::exp(-zeta * 1e-5)) * Vec<2>{1, 2}) < 1e-12);
}

TEST_CASE("the work of two damped grains that collide is accounted for, and they rebound more slowly") {
  const auto pair = [] {
    return SoftGrains({test::placed(test::disk(3), 1e-3, {0, 0}, {2, 0}),
                       test::placed(test::disk(3), 1e-3, {2.05e-3, 0}, {-2, 0})},
                      make_law(MaterialLaw::neo_hookean, 1e7, 0.3), rho);
  };
  const auto rebound = [&](auto dynamics, double dt) {
    const double start = dynamics.grains.kinetic_energy();
    for (int k = 0; k * dt < 2e-4; ++k) dynamics.step(dt);
    CHECK(dynamics.work.contacts > -1e-2 * start);
    CHECK(std::abs(missing_energy(dynamics, start)) < 2e-3 * start);
    return dynamics.grains.kinetic_energy() / start;
  };
  const double dt = stable_time_step(pair());
  for (const double rate : {0.0, 2e3}) {
    CAPTURE(rate);
    const double explicitly =
        rebound(ExplicitDynamics(pair(), {}, {.damping_share = 0.5, .damping = rate}), dt);
    const double implicitly = rebound(ImplicitDynamics(pair(), {}, {.tolerance = 1e-6, .damping = rate}), dt);
    if (rate == 0) CHECK(explicitly > 0.7);
    if (rate > 0) CHECK(explicitly < 0.6);
    CHECK(implicitly == doctest::Approx(explicitly).epsilon(0.15));
  }
}
