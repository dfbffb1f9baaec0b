#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/experiment/estimate.hpp"

using namespace softgrain;

TEST_CASE("a loading without unloading takes travel over wall velocity over time step") {
  Case c;
  c.loading.unload_at = {};
  c.loading.max_strain = std::log(2.0);  // the plate crosses half the grain: R
  c.loading.wall_velocity = 0.5;
  c.grain.radius = 5e-3;
  c.time.step = 1e-6;
  CHECK(estimate(c).steps == 10000);
}

TEST_CASE("half the time step doubles the steps and the hours") {
  Case c;
  const Estimate whole = estimate(c);
  c.time.step /= 2;
  const Estimate half = estimate(c);
  CHECK(std::abs(half.steps - 2 * whole.steps) <= 10);  // each leg is a whole number of steps
  CHECK(half.hours == doctest::Approx(2 * whole.hours).epsilon(1e-3));
  CHECK(half.memory == whole.memory);
}
