#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/given_path.hpp"
#include "softgrain/experiment/isotropic_path.hpp"

using namespace softgrain;

namespace {

GivenPath given(PlateMotion motion, double dt) {
  auto own = std::make_unique<IsotropicPath>(Case::Loading{}, 1.0, dt, 0.7);
  return {std::move(own), std::move(motion), dt};
}

}  // namespace

TEST_CASE("a given motion is asked once a step, at its beginning") {
  int asked = 0;
  const GivenPath path =
      given({.duration = 1, .velocity = [&](double time) { return ++asked, -2 * time; }}, 0.25);
  CHECK(path.steps() == 4);
  for (int step = 0; step < path.steps(); ++step)
    for (int wall = 0; wall < 4; ++wall) CHECK(path.plate_velocity(step, 0) == -0.5 * step);
  CHECK(asked == 4);
}

TEST_CASE("a given motion keeps the walls and the strain of the path that it replaces") {
  const GivenPath path = given({.duration = 1, .velocity = [](double) { return -1; }}, 0.5);
  CHECK(path.shares() == std::array<double, 4>{0.5, 0.5, 0.5, 0.5});
  CHECK(path.strain(2, 1) == doctest::Approx(std::log(2)));
}

TEST_CASE("a given motion without an end or without a speed is refused") {
  for (const double duration : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    CHECK_THROWS_AS(given({.duration = duration, .velocity = [](double) { return -1; }}, 0.5), UsageError);
  const GivenPath path = given({.duration = 1, .velocity = [](double) { return std::nan(""); }}, 0.5);
  CHECK_THROWS_AS(path.plate_velocity(0, 0), UsageError);
}
