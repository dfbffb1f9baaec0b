#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/diametral_path.hpp"

using namespace softgrain;

TEST_CASE("the strain of a grain is -ln(1 - d/R) with d half the plate's travel") {
  const double R = 5e-3;
  CHECK(grain_strain(R, R) == doctest::Approx(std::log(2.0)).epsilon(1e-15));  // d = R/2
  CHECK(grain_strain(2e-6 * R, R) == doctest::Approx(1e-6).epsilon(1e-6));
  for (const double strain : {0.0, 0.01, 0.1, 0.35, 1.0})
    CHECK(grain_strain(plate_travel(strain, R), R) == doctest::Approx(strain).epsilon(1e-13));
}

TEST_CASE("the plate goes down, turns back at each strain asked for by the strain asked for, and stops") {
  const double R = 5e-3, v = 0.2, dt = 0.25e-6;
  const DiametralPath path(
      {.wall_velocity = v, .max_strain = 0.35, .unload_at = {0.1, 0.3}, .unload_by = 0.012}, R, dt);
  const double turning_strain[] = {0.1, 0.088, 0.3, 0.288, 0.35};
  double travel = 0;
  int leg = 0;
  for (std::int64_t step = 0; step < path.steps(); ++step) {
    if (path.leg(step) != leg) {
      REQUIRE(path.leg(step) == leg + 1);
      // each leg is rounded to whole steps
      REQUIRE(std::abs(travel - plate_travel(turning_strain[leg], R)) < 0.501 * (leg + 1) * v * dt);
      leg = path.leg(step);
    }
    REQUIRE(path.plate_velocity(step) == (leg % 2 == 0 ? -v : v));
    travel -= path.plate_velocity(step) * dt;
  }
  CHECK(leg == 4);
  CHECK(std::abs(travel - plate_travel(0.35, R)) < 2.501 * v * dt);
  CHECK(path.leg(path.steps()) == 4);  // the path has ended, on its last leg
}

TEST_CASE("a path without turning is one leg") {
  const DiametralPath path({.wall_velocity = 1, .max_strain = std::log(2.0), .unload_at = {}}, 1, 1e-3);
  CHECK(path.steps() == 1000);  // travel R at 1 R/s
  CHECK(path.leg(0) == 0);
  CHECK(path.leg(999) == 0);
  CHECK(path.plate_velocity(999) == -1);
}

TEST_CASE("a path that cannot be followed is refused with the key and the value") {
  const auto make = [](const Case::Loading& loading) { DiametralPath(loading, 5e-3, 1e-6); };
  CHECK_THROWS_WITH_AS(make({.wall_velocity = -1}), "loading.wall_velocity must be > 0, got -1 m/s",
                       UsageError);
  CHECK_THROWS_WITH_AS(make({.max_strain = 0}), "loading.max_strain must be > 0, got 0", UsageError);
  CHECK_THROWS_AS(make({.max_strain = 0.2, .unload_at = {0.1, 0.2}}), UsageError);
  CHECK_THROWS_AS(make({.unload_at = {0.1, 0.05}}), UsageError);
  CHECK_THROWS_AS(make({.unload_at = {0.1}, .unload_by = 0.11}), UsageError);
  CHECK_THROWS_AS(make({.unload_at = {0.1}, .unload_by = 0}), UsageError);
  CHECK_THROWS_WITH_AS(make({.max_strain = 0.2, .unload_at = {0.1, 0.25}, .unload_by = 0.01}),
                       "loading.unload_at must rise and stay below loading.max_strain 0.2, with 0 < "
                       "loading.unload_by 0.01 < each; got 0.25",
                       UsageError);
}
