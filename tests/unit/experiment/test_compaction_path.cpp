#include "softgrain/experiment/compaction_path.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/core/error.hpp"

using namespace softgrain;

namespace {

constexpr double height = 36e-3, v = 5, dt = 0.1e-6;

struct Leg {
  double velocity = 0, strain = 0;  // strain where it ends
  std::int64_t steps = 0;
};

std::vector<Leg> legs_of(const CompactionPath& path) {
  std::vector<Leg> legs;
  double h = height;
  for (std::int64_t step = 0; step < path.steps(); ++step) {
    const double velocity = path.plate_velocity(step, height - h);
    if (path.leg(step) == static_cast<int>(legs.size())) legs.push_back({velocity, 0, 0});
    REQUIRE(std::abs(velocity) <= std::abs(legs.back().velocity) * (1 + 1e-6));
    REQUIRE(velocity * legs.back().velocity >= 0);
    h += dt * velocity;
    legs.back().strain = path.strain(height, h);
    ++legs.back().steps;
  }
  return legs;
}

}  // namespace

TEST_CASE("the lid comes down to eps = ln(h_start/h) at its speed") {
  const auto legs = legs_of(CompactionPath({.wall_velocity = v, .max_strain = 0.3}, height, dt, 0.7));
  REQUIRE(legs.size() == 1);
  CHECK(legs[0].velocity == -v);
  CHECK(legs[0].strain == doctest::Approx(0.3).epsilon(1e-9));
  CHECK(legs[0].steps == std::ceil(height * (1 - std::exp(-0.3)) / (v * dt)));
}

TEST_CASE("the lid goes back where the case says, rests at each turn and at the end") {
  const Case::Loading loading{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {0.1, 0.25}, .unload_by = 0.02, .hold = 50e-6};
  const auto legs = legs_of(CompactionPath(loading, height, dt, 0.7));
  const double strain[] = {0.1, 0.08, 0.25, 0.23, 0.3}, velocity[] = {-v, v, -v, v, -v};
  REQUIRE(legs.size() == 10);
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(legs[2 * k].velocity == velocity[k]);
    CHECK(legs[2 * k].strain == doctest::Approx(strain[k]).epsilon(1e-9));
    CHECK(legs[2 * k + 1].velocity == 0);
    CHECK(legs[2 * k + 1].steps == 500);
  }
}

TEST_CASE("a packing fraction ends the path where undeformed grains fill it, and leaves out later turns") {
  Case::Loading loading{.wall_velocity = v, .max_strain = 0.4, .unload_at = {0.1, 0.3}};
  loading.max_packing_fraction = 0.85;
  const auto legs = legs_of(CompactionPath(loading, height, dt, 0.7));
  REQUIRE(legs.size() == 3);
  CHECK(0.7 * std::exp(legs.back().strain) == doctest::Approx(0.85).epsilon(1e-9));
  loading.max_packing_fraction = 2;
  CHECK(legs_of(CompactionPath(loading, height, dt, 0.7)).back().strain ==
        doctest::Approx(0.4).epsilon(1e-9));
}
