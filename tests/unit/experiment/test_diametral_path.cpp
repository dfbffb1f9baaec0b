#include <doctest/doctest.h>

#include <cmath>
#include <vector>

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

namespace {

/// Strains at which the legs of a path end, as its steps really go.
std::vector<double> leg_ends(const DiametralPath& path, double R, double v, double dt) {
  std::vector<double> strain;
  double height = 2 * R;
  for (std::int64_t step = 0; step < path.steps(); ++step) {
    if (path.leg(step) == static_cast<int>(strain.size())) strain.push_back(0);
    const double velocity = path.plate_velocity(step, 2 * R - height);
    REQUIRE(std::abs(velocity) <= v * (1 + 1e-8));
    REQUIRE(path.approaches(step) == (velocity < 0));
    height += velocity * dt;
    strain.back() = path.strain(2 * R, height);
  }
  return strain;
}

}  // namespace

TEST_CASE("the plate goes down, turns back at each strain asked for by the strain asked for, and stops") {
  const double R = 5e-3, v = 0.2, dt = 0.25e-6;
  const DiametralPath path(
      {.wall_velocity = v, .max_strain = 0.35, .unload_at = {0.1, 0.3}, .unload_by = 0.012}, R, dt);
  const double turning_strain[] = {0.1, 0.088, 0.3, 0.288, 0.35};
  const std::vector<double> ends = leg_ends(path, R, v, dt);
  REQUIRE(ends.size() == 5);
  for (int leg = 0; leg < 5; ++leg) CHECK(ends[leg] == doctest::Approx(turning_strain[leg]).epsilon(1e-9));
  CHECK(path.leg(path.steps()) == 4);  // the path has ended, on its last leg
}

TEST_CASE("a path of 60 turns ends where the case says, though a step is longer than its legs") {
  const double R = 5e-3, v = 0.2, dt = 2.5e-4;  // 50 um a step, 0.5 % of strain
  Case::Loading loading{.wall_velocity = v, .max_strain = 0.35, .unload_at = {}, .unload_by = 0.0005};
  for (int turn = 1; turn <= 60; ++turn) loading.unload_at.push_back(0.0051 * turn);
  const std::vector<double> ends = leg_ends(DiametralPath(loading, R, dt), R, v, dt);
  REQUIRE(ends.size() == 121);
  for (std::size_t turn = 0; turn < 60; ++turn) {
    REQUIRE(ends[2 * turn] == doctest::Approx(loading.unload_at[turn]).epsilon(1e-9));
    REQUIRE(ends[2 * turn + 1] == doctest::Approx(loading.unload_at[turn] - 0.0005).epsilon(1e-9));
  }
  CHECK(ends.back() == doctest::Approx(0.35).epsilon(1e-9));
  loading.unload_at = {};
  loading.max_strain = 1e-4;
  CHECK(leg_ends(DiametralPath(loading, R, dt), R, v, dt).back() == doctest::Approx(1e-4).epsilon(1e-9));
}

TEST_CASE("a leg counts from the travel really made, whatever came before") {
  const double R = 5e-3, v = 0.2, dt = 0.25e-6;
  const DiametralPath path({.wall_velocity = v, .max_strain = 0.1, .unload_at = {}}, R, dt);
  double height = 2 * R - 0.7 * v * dt;  // ahead of the path
  for (std::int64_t step = 0; step < path.steps(); ++step)
    height += dt * path.plate_velocity(step, 2 * R - height);
  CHECK(path.strain(2 * R, height) == doctest::Approx(0.1).epsilon(1e-9));
}

TEST_CASE("a path without turning is one leg") {
  const DiametralPath path({.wall_velocity = 1, .max_strain = std::log(2.0), .unload_at = {}}, 1, 1e-3);
  CHECK(path.steps() == 1000);  // travel R at 1 R/s
  CHECK(path.leg(0) == 0);
  CHECK(path.leg(999) == 0);
  CHECK(path.plate_velocity(998, 0.998) == -1);
  CHECK(path.plate_velocity(999, 0.999) == doctest::Approx(-1));
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
