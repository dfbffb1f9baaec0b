#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "softgrain/soft/rigid_motion.hpp"
#include "softgrain/soft/rigid_outline.hpp"
#include "support/outlines.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, rho = 2000, g = 9.81, pi = std::numbers::pi;

std::shared_ptr<const Topology> shape_of(Topology shape) {
  return std::make_shared<const Topology>(std::move(shape));
}

SoftGrains made_rigid(std::vector<GrainPlacement> placed) {
  return {std::move(placed), {GrainMaterial{.law = {}, .density = rho, .rigid = true}}};
}

struct Whole {
  double mass, inertia;
};
Whole whole(const Topology& shape) {
  const SoftGrains grains = made_rigid({test::placed(shape_of(shape), R, {R, R})});
  const RigidMass all = rigid_mass(grains, grains.batches[0]);
  return {all.mass[0] / rho, all.inertia[0] / rho};
}

/// Squares with sides along the axes, half as long as R sqrt(2).
constexpr double half_side = R / std::numbers::sqrt2;
GrainPlacement square_at(const Vec<2>& centre, const Vec<2>& velocity = {}) {
  return test::placed(shape_of(rigid_polygon(4, 32)), R, centre, velocity, pi / 4);
}

double least_gap(const SoftGrains& grains) {
  double least = 1;
  for (const OutlineContact& contact : OutlineNeighbours().detect(grains, test::state_of(grains)))
    least = std::min(least, contact.gap);
  return least;
}

}  // namespace

TEST_CASE("rigid ellipses and polygons weigh and turn as their bodies do") {
  const double b = R / 3;
  const Whole ellipse = whole(rigid_ellipse(3, 40));
  CHECK(ellipse.mass / (pi * R * b) == doctest::Approx(1).epsilon(1e-12));
  CHECK(ellipse.inertia / (pi * R * b * (R * R + b * b) / 4) == doctest::Approx(1).epsilon(1e-12));
  const Whole square = whole(rigid_polygon(4, 32)), triangle = whole(rigid_polygon(3, 20));
  const double side = 2 * half_side;
  CHECK(square.mass / (side * side) == doctest::Approx(1).epsilon(1e-12));
  CHECK(square.inertia / (std::pow(side, 4) / 6) == doctest::Approx(1).epsilon(1e-12));
  const double edge = R * std::sqrt(3.0), area = std::sqrt(3.0) / 4 * edge * edge;
  CHECK(triangle.mass / area == doctest::Approx(1).epsilon(1e-12));
  CHECK(triangle.inertia / (area * edge * edge / 12) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("sides of rigid polygons are straight and their corners sharp") {
  for (const double beside : {0.0, 0.3, 0.8}) {  // side faces side, also shifted
    const SoftGrains pair =
        made_rigid({square_at({0, 0}), square_at({2 * half_side + 0.02 * R, beside * half_side})});
    CHECK(least_gap(pair) / (0.02 * R) == doctest::Approx(1).epsilon(1e-9));
  }
  // corner faces corner
  const SoftGrains pair =
      made_rigid({square_at({0, 0}), square_at({2 * half_side + 0.03 * R, 2 * half_side + 0.01 * R})});
  CHECK(least_gap(pair) / (std::hypot(0.03, 0.01) * R) == doctest::Approx(1).epsilon(1e-9));
  // a corner over the middle of a side
  const SoftGrains on_side = made_rigid(
      {square_at({0, 0}), test::placed(shape_of(rigid_polygon(4, 32)), R, {0.1 * R, half_side + 1.01 * R})});
  CHECK(least_gap(on_side) / (0.01 * R) == doctest::Approx(1).epsilon(1e-9));
}

TEST_CASE("a rigid disk beside the corner of a square is as far from it as the corner from its circle") {
  const double gap = 0.01 * R;
  const Vec<2> way{std::cos(0.6), std::sin(0.6)};
  const SoftGrains pair =
      made_rigid({square_at({0, 0}),
                  test::placed(shape_of(rigid_disk(32)), R, Vec<2>{half_side, half_side} + (R + gap) * way)});
  CHECK(std::abs(least_gap(pair) - gap) < 1e-3 * gap);
}

TEST_CASE("two rigid disks touch where their circles do, however their vertices lie") {
  for (const double angle : {0.0, 0.03, 0.05, 0.1}) {
    CAPTURE(angle);
    const SoftGrains pair = made_rigid({test::placed(shape_of(rigid_disk(32)), R, {0, 0}, {}, angle),
                                        test::placed(shape_of(rigid_disk(24)), 0.5 * R,
                                                     {1.51 * R * std::cos(1.1), 1.51 * R * std::sin(1.1)})});
    CHECK(std::abs(least_gap(pair) - 0.01 * R) < 2e-4 * R);
  }
}

TEST_CASE_TEMPLATE(
    "a rigid block slides down a slope as Coulomb says, and sticks below the angle of friction", Dynamics,
    ImplicitDynamics, ExplicitDynamics) {
  const double mu = 0.4, dt = 2e-4;
  for (const double slope : {std::atan(mu) - 0.05, std::atan(mu) + 0.2}) {
    std::conditional_t<std::is_same_v<Dynamics, ImplicitDynamics>, ImplicitOptions, ExplicitOptions> options;
    options.wall_friction = mu;
    options.gravity = {g * std::sin(slope), -g * std::cos(slope)};
    options.solver.tolerance = 1e-9;
    if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>) options.tolerance = 1e-7;
    Dynamics dynamics(made_rigid({square_at({0, half_side})}), std::vector<Wall<2>>{test::floor_at(0)},
                      options);
    constexpr int steps = 100;
    for (int k = 0; k < steps; ++k) dynamics.step(dt);
    const double v = dynamics.grains.batches[0].velocity[0][0][0];
    const double expected = std::max(0.0, g * (std::sin(slope) - mu * std::cos(slope)) * steps * dt);
    CHECK(std::abs(v - expected) < 1e-3 * g * steps * dt);
    CHECK(std::abs(dynamics.grains.batches[0].position[0][1][0] - half_side) < 1e-4 * R);
  }
}

TEST_CASE_TEMPLATE("an ellipse that rocks on a floor lies as high as its support function", Dynamics,
                   ImplicitDynamics, ExplicitDynamics) {
  const double aspect = 2, dt = 2e-5, tilt = 0.5;
  const auto height = [&](double angle) { return R * std::hypot(std::sin(angle), std::cos(angle) / aspect); };
  std::conditional_t<std::is_same_v<Dynamics, ImplicitDynamics>, ImplicitOptions, ExplicitOptions> options;
  options.gravity = {0, -g};
  options.solver.tolerance = 1e-9;
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>) options.tolerance = 1e-8;
  Dynamics dynamics(
      made_rigid({test::placed(shape_of(rigid_ellipse(aspect, 64)), R, {0, height(tilt)}, {}, tilt)}),
      std::vector<Wall<2>>{test::floor_at(0)}, options);
  const double weight = dynamics.grains.mass(0) * g;
  double least = tilt;
  for (int k = 0; k < 1000; ++k) {  // 20 ms: past the lowest place
    dynamics.step(dt);
    const GrainBatch& batch = dynamics.grains.batches[0];
    const RigidPose pose = rigid_pose(batch, batch.position);
    const double angle = std::atan2(pose.along[1][0], pose.along[0][0]);
    least = std::min(least, angle);
    REQUIRE(std::abs(pose.centre[1][0] - height(angle)) < 2e-3 * R);
    // without friction the energy is that of the start
    const double energy = dynamics.grains.kinetic_energy() + weight * pose.centre[1][0];
    REQUIRE(std::abs(energy / (weight * height(tilt)) - 1) < 5e-3);
  }
  CHECK(least < -0.3);
}
