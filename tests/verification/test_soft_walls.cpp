#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "softgrain/experiment/sample.hpp"
#include "softgrain/mpm/explicit_step.hpp"
#include "softgrain/mpm/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, E = 1e7, nu = 0.45, density = 990, pi = 3.141592653589793;

/// Mass, centre, momentum and spin about the centre of a single grain.
struct Motion {
  double mass = 0, spin = 0, inertia = 0;
  Vec<2> centre, momentum;
};
Motion motion_of(const SoftGrains& grains) {
  Motion motion;
  const auto [batch, lane] = grains.batch_of(0);
  const int nodes = batch->topology->grid.nodes();
  for (int i = 0; i < nodes; ++i) {
    const double m = grains.node_mass(*batch, i)[lane];
    motion.mass += m;
    motion.centre += m * test::lane_of(batch->position[i], lane);
    motion.momentum += m * test::lane_of(batch->velocity[i], lane);
  }
  motion.centre = (1 / motion.mass) * motion.centre;
  for (int i = 0; i < nodes; ++i) {
    const Vec<2> x = test::lane_of(batch->position[i], lane) - motion.centre;
    motion.spin +=
        grains.node_mass(*batch, i)[lane] * dot(perpendicular(x), test::lane_of(batch->velocity[i], lane));
  }
  return motion;
}

SoftGrains grain_above_floor(int cells, double gap, double speed, double angle) {
  const auto shape = test::disk(cells);
  const double reach =
      norm(shape->grid.node[shape->grid.outline_begin]);  // of the circle through the vertices
  return {{test::placed(shape, R, {0, (reach + gap) * R}, {0, -speed}, angle)},
          make_law(MaterialLaw::neo_hookean, E, nu),
          density};
}

/// Change of spin over impulse of a bounce on the floor: by how much the impulse misses the centre, over R.
template <class Dynamics>
double missed_centre(Dynamics dynamics, double dt) {
  const double start = motion_of(dynamics.grains).spin;
  double impulse = 0;
  bool left = false;
  while (!left) {
    dynamics.step(dt);
    impulse -= dynamics.wall_impulse(0)[1];
    left = impulse > 0 && dynamics.wall_impulse(0)[1] == 0;
  }
  return (motion_of(dynamics.grains).spin - start) / (impulse * R);
}
ImplicitDynamics implicit_bounce(int cells, double speed, double angle) {
  return {grain_above_floor(cells, 1e-3, speed, angle), {test::floor_at(0)}, {}};
}
ExplicitDynamics explicit_bounce(int cells, double speed, double angle) {
  return {grain_above_floor(cells, 1e-3, speed, angle), {test::floor_at(0)}, {}};
}

}  // namespace

TEST_CASE("a frictionless wall pushes through the centre of a round grain, at any angle") {
  for (const int cells : {4, 8, 16})
    for (const double share : {0.15, 0.4}) {  // of a segment
      CAPTURE(cells);
      CAPTURE(share);
      const double angle = share * 2 * pi / (4 * cells);
      // the polygon of the vertices: 0.11, 0.05, 0.02 in the mean
      CHECK(std::abs(missed_centre(implicit_bounce(cells, 0.05, angle), 1e-5)) < 0.005);
      if (cells == 8) {
        const double dt = stable_time_step(grain_above_floor(cells, 0, 0, 0), 0.5);
        CHECK(std::abs(missed_centre(explicit_bounce(cells, 0.05, angle), dt)) < 0.005);
      }
    }
}

TEST_CASE("a soft disk rolls down a plane as a rigid one, with 2/3 g sin(slope)") {
  constexpr double slope = 0.1, g = 9.81, dt = 1e-4;
  for (const int cells : {4, 8, 16}) {
    const int steps = cells == 16 ? 300 : 600, settled = steps / 10;
    ImplicitDynamics dynamics(grain_above_floor(cells, 1e-6, 0, 0.01), {test::floor_at(0)},
                              {.wall_friction = 0.5, .gravity = {g * std::sin(slope), -g * std::cos(slope)}});
    double begin = 0;
    for (int k = 0; k < steps; ++k) {
      if (k == settled) begin = motion_of(dynamics.grains).momentum[0];
      dynamics.step(dt);
    }
    const Motion motion = motion_of(dynamics.grains);
    CHECK(motion.centre[0] > (cells == 16 ? 0.28 : 1.1) * R);  // across three segments at least
    const double acceleration = (motion.momentum[0] - begin) / (motion.mass * (steps - settled) * dt);
    const double most = cells == 4 ? 0.02 : cells == 8 ? 0.013 : 0.005;  // the polygon: 0.07, 0.03, 0.013
    CAPTURE(cells);
    CHECK(acceleration == doctest::Approx(2.0 / 3 * g * std::sin(slope)).epsilon(most));
  }
}

TEST_CASE("without friction contact gives no energy to a packing") {
  constexpr double speed = 1, strain = 0.4, dt = 7e-6;
  const BoxSample sample = sample_box({.grains = 12, .packing_fraction = 0.6});
  std::vector<GrainPlacement> placed;
  for (const PlacedGrain& grain : sample.grains)
    placed.push_back(test::placed(test::disk(6), grain.radius, grain.centre, {}, grain.angle));
  ImplicitDynamics dynamics({std::move(placed), make_law(MaterialLaw::neo_hookean, E, nu), density},
                            test::box_walls(sample.width, speed), {});
  double least = 0;
  while (dynamics.walls[1].point[1] > sample.width * std::exp(-strain)) {
    dynamics.step(dt);
    least = std::min(least, dynamics.work.contacts);
  }
  CHECK(dynamics.work.walls > 2);
  CHECK(least > -0.01 * dynamics.work.walls);  // with the normal of the end: -0.12
}
