#include <doctest/doctest.h>

#include "softgrain/core/error.hpp"
#include "softgrain/rigid/particles.hpp"

using namespace softgrain;

TEST_CASE("a rolling disk has 3/4 m v^2 and a rolling sphere 7/10 m v^2") {
  const double m = 3, v = 2;
  auto disk = rigid_particles<2>({{0, 0}}, {0.5}, {m}, {});
  disk.velocity[0] = {v, 0};
  disk.spin[0] = {-v};
  CHECK(kinetic_energy(disk) == doctest::Approx(0.75 * m * v * v).epsilon(1e-15));
  auto sphere = rigid_particles<3>({{0, 0, 0}}, {0.5}, {m}, {});
  sphere.velocity[0] = {0, v, 0};
  sphere.spin[0] = {v, 0, 0};
  CHECK(kinetic_energy(sphere) == doctest::Approx(0.7 * m * v * v).epsilon(1e-15));
}

TEST_CASE("walls follow the particles in the array of bodies, with their velocity and infinite mass") {
  const Wall<2> wall{.point = {0, -1}, .normal = {0, 1}, .velocity = {0.5, 2}};
  auto bodies = rigid_particles<2>({{0, 0}, {3, 0}}, {1, 1}, {4, 5}, {wall});
  REQUIRE(bodies.size() == 2);
  REQUIRE(bodies.wall_body(0) == 2);
  CHECK(bodies.inverse_mass == std::vector<double>{1 / 4.0, 1 / 5.0, 0});
  CHECK(bodies.velocity[2] == wall.velocity);
  set_wall_velocity<2>(bodies, 0, {7, 8});
  CHECK(bodies.velocity[2] == Vec<2>{7, 8});
  CHECK(bodies.walls[0].velocity == Vec<2>{7, 8});
  CHECK(kinetic_energy(bodies) == 0);  // a wall has none
}

TEST_CASE("particles and walls drift along their velocities") {
  auto bodies =
      rigid_particles<2>({{1, 2}}, {1}, {1}, {{.point = {0, -1}, .normal = {0, 1}, .velocity = {0, 4}}});
  bodies.velocity[0] = {-2, 8};
  drift(bodies, 0.25);
  CHECK(bodies.position[0] == Vec<2>{0.5, 4});
  CHECK(bodies.walls[0].point == Vec<2>{0, 0});
}

TEST_CASE("particles need as many radii and masses as positions, all positive") {
  CHECK_THROWS_WITH_AS(rigid_particles<2>({{0, 0}}, {1, 1}, {1}, {}),
                       "1 positions need as many radii (2) and masses (1)", UsageError);
  CHECK_THROWS_WITH_AS(rigid_particles<2>({{0, 0}, {1, 1}}, {1, 0}, {1, 1}, {}),
                       "particle 1: radius 0 m and mass 1 kg must be positive", UsageError);
  CHECK_THROWS_AS(rigid_particles<2>({{0, 0}}, {1}, {-1}, {}), UsageError);
}
