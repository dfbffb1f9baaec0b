#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "support/rigid_solids.hpp"
#include "support/solid_grains.hpp"

// Rigid spheres, alone and against elastic ones, by closed forms of mechanics.

using namespace softgrain;
using test::angular_momentum;
using test::Twist;
using test::twist_of;

namespace {

const std::shared_ptr<const SolidTopology>& sphere() {
  static const auto shape = std::make_shared<const SolidTopology>(rigid_ball(4));
  return shape;
}

constexpr double density = 2;
const SolverOptions exact{.max_sweeps = 500, .tolerance = 1e-15, .relaxation = 1.2};

SolidGrains spheres(std::vector<PlacementOf<3>> placed) {
  return {std::move(placed), {test::rigid_material(density)}};
}

double mass_of(double R) { return density * 4 * 3.14159265358979 / 3 * R * R * R; }

}  // namespace

TEST_CASE(
    "a rigid sphere has the mass and the moment of inertia of a ball, and keeps its shape as it turns") {
  SolidGrains grains = spheres({{.topology = sphere(), .radius = 0.5, .centre = {1, 2, 3}, .velocity = {}}});
  const RigidMassOf<3> all = rigid_mass(grains, grains.batches[0]);
  CHECK(std::abs(all.mass[0] / mass_of(0.5) - 1) < 1e-12);
  CHECK(std::abs(all.inertia[0] / (0.4 * mass_of(0.5) * 0.25) - 1) < 1e-12);
  // a turn by omega t, against the same turn of one vertex by itself
  SolidBatch& batch = grains.batches[0];
  RigidTwistOf<3> twist;
  for (int d = 0; d < 3; ++d) twist.spin[d] = Wide(std::array{0.3, -0.5, 0.7}[static_cast<std::size_t>(d)]);
  set_rigid_twist(twist, batch.position, batch.velocity);
  const Vec<3> r0 = lane_of(batch.position[7] - batch.position.back(), 0), w{0.3, -0.5, 0.7};
  ExplicitStep<3> dynamics(grains, test::walls_at(-10, 10), {});
  const int steps = 1000;
  for (int k = 0; k < steps; ++k) dynamics.step(0.01);
  const double angle = norm(w) * 10;
  const Vec<3> n = (1 / norm(w)) * w;
  const Vec<3> expected =
      std::cos(angle) * r0 + std::sin(angle) * cross(n, r0) + ((1 - std::cos(angle)) * dot(n, r0)) * n;
  const SolidBatch& after = dynamics.grains.batches[0];
  CHECK(norm(lane_of(after.position[7] - after.position.back(), 0) - expected) < 1e-10);
}

TEST_CASE("a sphere that slides comes to roll with 5/7 of its speed, after 2 v_0/(7 mu g)") {
  const double v0 = 1, mu = 0.3, g = 1;
  for (const Vec<3> along : {Vec<3>{1, 0, 0}, Vec<3>{0.6, -0.8, 0}}) {
    ExplicitStep<3> dynamics(
        spheres({{.topology = sphere(), .radius = 1, .centre = {0, 0, 1}, .velocity = v0 * along}}),
        test::walls_at(0, 10), {.solver = exact, .wall_friction = mu, .gravity = {0, 0, -g}});
    const double dt = 0.01, rolls = 2 * v0 / (7 * mu * g);
    double time = 0;
    for (; time < 0.7 * rolls; time += dt) dynamics.step(dt);
    CHECK(std::abs(dot(twist_of(dynamics.grains, 0).velocity, along) - (v0 - mu * g * time)) < 1e-9);
    for (; time < 3 * rolls; time += dt) dynamics.step(dt);
    const Twist end = twist_of(dynamics.grains, 0);
    CHECK(norm(end.velocity - (5.0 / 7 * v0) * along) < 1e-9);
    CHECK(norm(end.spin - cross(Vec<3>{0, 0, 1}, end.velocity)) < 1e-9);  // omega = e_z x v/R
    CHECK(std::abs(dynamics.grains.node_position(0, dynamics.grains.topology(0).grid.nodes() - 1)[2] - 1) <
          1e-9);
    const WorkBudget& work = dynamics.work;
    const double lost = 0.5 * mass_of(1) * v0 * v0 * (2.0 / 7);  // of the kinetic energy
    CHECK(std::abs(work.contacts / lost - 1) < 1e-9);
  }
}

TEST_CASE(
    "a sphere on an incline slides by g (sin a - mu cos a), and rolls by 5/7 g sin a where friction holds") {
  const double angle = 0.4, g = 1, dt = 0.005;
  for (const double mu : {0.05, 0.5}) {  // 2/7 tan a = 0.12
    ExplicitStep<3> dynamics(
        spheres({{.topology = sphere(), .radius = 1, .centre = {0, 0, 1}, .velocity = {}}}),
        test::walls_at(0, 10),
        {.solver = exact, .wall_friction = mu, .gravity = {g * std::sin(angle), 0, -g * std::cos(angle)}});
    for (int k = 0; k < 200; ++k) dynamics.step(dt);
    const double rate = mu > 0.12 ? 5.0 / 7 * std::sin(angle) : std::sin(angle) - mu * std::cos(angle);
    CHECK(std::abs(twist_of(dynamics.grains, 0).velocity[0] / (rate * g * 200 * dt) - 1) < 1e-9);
  }
}

TEST_CASE("an oblique impact of two rigid spheres keeps momentum and angular momentum") {
  ExplicitStep<3> dynamics(
      spheres({{.topology = sphere(), .radius = 1, .centre = {0, 0, 0}, .velocity = {1, 0.2, 0}},
               {.topology = sphere(), .radius = 0.6, .centre = {1.7, 0.5, 0.4}, .velocity = {-0.5, 0, 0.1}}}),
      test::walls_at(-20, 20), {.solver = exact, .friction = 0.4});
  const Vec<3> momentum = dynamics.grains.momentum(), angular = angular_momentum(dynamics.grains);
  const double before = dynamics.grains.kinetic_energy();
  for (int k = 0; k < 1000; ++k) dynamics.step(0.001);
  CHECK(norm(dynamics.grains.momentum() - momentum) < 1e-12 * norm(momentum));
  CHECK(norm(angular_momentum(dynamics.grains) - angular) < 2e-3 * norm(angular));
  CHECK(norm(twist_of(dynamics.grains, 1).spin) > 0.1);
  const double lost = before - dynamics.grains.kinetic_energy();
  CHECK(lost > 0.1 * before);
  CHECK(std::abs(dynamics.work.contacts / lost - 1) < 1e-9);
}

namespace {

/// The force on an elastic sphere of radius 1, E = 1, that two rigid ones press from both sides, and d, by
/// how much its centre comes nearer to theirs than the radii: where d is first `wanted`, and the energy that
/// lacks.
struct Pressed {
  double force = 0, energy_error = 0;
};
Pressed press_between(double R, double wanted, int n) {
  const double nu = 0.45, v = 0.01;
  std::vector<PlacementOf<3>> placed{
      {.topology = sphere(), .radius = R, .centre = {0, 0, -R - 1}, .velocity = {}, .kind = 1},
      {.topology = test::ball(n), .radius = 1, .centre = {}, .angle = test::some_turn(1), .velocity = {}},
      {.topology = sphere(), .radius = R, .centre = {0, 0, R + 1}, .velocity = {}, .kind = 1}};
  const double high = 2 * R + 1;
  ExplicitStep<3> dynamics({std::move(placed),
                            {GrainMaterial{.law = make_law(MaterialLaw::neo_hookean, 1, nu), .density = 1},
                             GrainMaterial{.law = {}, .density = R > 10 ? 1e-3 : 1e2, .rigid = true}}},
                           test::walls_at(-high, high), {.damping_share = 0.5});
  const double dt = 0.8 * longest_stable_step(dynamics.grains, 0.5), window = 2.2 * v;
  double sum = 0, count = 0, time = 0, d = 0;
  for (; d < wanted + window; time += dt) {
    const double speed = v * std::min(1.0, time / 10);
    dynamics.box.walls[0].velocity = {0, 0, speed};
    dynamics.box.walls[1].velocity = {0, 0, -speed};
    dynamics.step(dt);
    d = dynamics.box.walls[0].point[2] + high;
    if (std::abs(d - wanted) > window) continue;
    sum += (dynamics.box.impulse[1][2] - dynamics.box.impulse[0][2]) / (2 * dt);
    count += 1;
  }
  const WorkBudget& work = dynamics.work;
  return {sum / count / (1 / (1 - nu * nu)),
          (work.walls - dynamics.grains.kinetic_energy() - work.internal - work.contacts) / work.walls};
}

}  // namespace

TEST_CASE(
    "an elastic sphere between rigid ones bears Hertz's force of both curvatures, and more at finite "
    "strain") {
  // 4/3 sqrt(R*) d^1.5; against large spheres as between walls (converged: 0.04872 at d = 0.1)
  const Pressed large = press_between(50, 0.1, 4);
  CHECK(std::abs(large.force / (0.04872 * std::sqrt(50.0 / 51)) - 1) < 0.06);
  CHECK(std::abs(large.energy_error) < 1e-9);
  const double d = 0.1, alike = 0.5, Hertz = 4.0 / 3 * std::sqrt(alike) * std::pow(d, 1.5);
  const Pressed equal = press_between(1, d, 4);
  MESSAGE("over Hertz between equal ones: ", equal.force / Hertz,
          ", between large ones over the plate's: ", large.force / (0.04872 * std::sqrt(50.0 / 51)));
  CHECK(equal.force / Hertz > 0.95);
  CHECK(equal.force / Hertz < 1.25);
}
