#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/interaction/attraction.hpp"

using namespace softgrain;

namespace {

/// The paper's Eq. (1), F = F0 (1 + g/a0)^-gamma, in the gap g.
double paper_force(const Attraction& law, double gap, double a0) {
  return law.F0 * std::pow(1 + gap / a0, -law.gamma);
}

}  // namespace

TEST_CASE("the attraction follows the paper's formula outside of contact") {
  const double a0 = 0.2e-3;
  for (const double gamma : {7.0, 3.0, 1.0, 2.5}) {
    const Attraction law{.F0 = 80, .gamma = gamma};
    for (const double share : {0.0, 1e-6, 0.1, 0.37, 0.8, 0.999}) {
      const double gap = share * a0;
      CHECK(law.force(a0 + gap, a0) == doctest::Approx(paper_force(law, gap, a0)).epsilon(1e-12));
    }
  }
}

TEST_CASE("under overlap the attraction stays F0") {
  const Attraction law{.F0 = 80, .gamma = 7};
  for (const double r : {0.999999, 0.99, 0.5}) CHECK(law.force(r, 1) == 80);
}

TEST_CASE("the attraction is exactly zero beyond twice the contact distance") {
  for (const double gamma : {7.0, 3.0}) {
    const Attraction law{.F0 = 80, .gamma = gamma};
    const double a0 = 0.3, beyond = std::nextafter(2 * a0, 1.0);
    CHECK(law.force(beyond, a0) == 0);
    CHECK(law.energy(beyond, a0) == 0);
    CHECK(law.force(2 * a0, a0) == doctest::Approx(80 * std::pow(0.5, gamma)).epsilon(1e-14));
    CHECK(law.energy(2 * a0, a0) == doctest::Approx(0).epsilon(1e-14));
    const Lanes over_r = law.force_over_distance(Lanes{0.361, 0.37, 10, 1e6}, splat(a0));
    for (int lane = 0; lane < lane_count; ++lane) CHECK(over_r[lane] == 0);
  }
}

TEST_CASE("four lanes give the force of the formula over the distance") {
  const double a0 = 0.21e-3;
  for (const double gamma : {7.0, 3.0, 1.0, 2.5}) {
    CAPTURE(gamma);
    const Attraction law{.F0 = 100, .gamma = gamma};
    struct Range {
      double low, high, accuracy;  // of r/a0
    };
    for (const Range range : {Range{1, 1.999, 1e-14}, {0.9999, 1, 2e-15}, {0.99, 1, 1e-14}, {0.9, 1, 2e-7}}) {
      for (int k = 0; k < 100; ++k) {
        Lanes r;
        for (int lane = 0; lane < lane_count; ++lane)
          r[lane] = a0 * (range.low + (range.high - range.low) * (4 * k + lane) / 400);
        const Lanes over_r = law.force_over_distance(r * r, splat(a0));
        for (int lane = 0; lane < lane_count; ++lane) {
          const double gap = std::fmax(r[lane] - a0, 0);
          const double expected = paper_force(law, gap, a0) / r[lane];
          REQUIRE(std::abs(over_r[lane] - expected) <= range.accuracy * expected);
        }
      }
    }
  }
}

TEST_CASE("lanes may hold pairs of different sizes") {
  const Attraction law{.F0 = 100, .gamma = 7};
  const Lanes a0{1, 2, 3, 4}, r{0.995, 2.2, 4.5, 8.1};
  const Lanes over_r = law.force_over_distance(r * r, a0);
  CHECK(over_r[0] == doctest::Approx(100 / 0.995).epsilon(1e-13));
  CHECK(over_r[1] == doctest::Approx(100 * std::pow(1.1, -7) / 2.2).epsilon(1e-13));
  CHECK(over_r[2] == doctest::Approx(100 * std::pow(1.5, -7) / 4.5).epsilon(1e-13));
  CHECK(over_r[3] == 0);
}

TEST_CASE("the attraction is minus the slope of its potential") {
  const double a0 = 0.2, step = 1e-5 * a0;
  for (const double gamma : {7.0, 3.0, 1.0, 1.7}) {
    const Attraction law{.F0 = 100, .gamma = gamma};
    for (const double share : {0.9, 0.995, 1.01, 1.2, 1.5, 1.9}) {
      // the force is positive towards each other: F = dU/dr
      const double r = share * a0;
      const double slope = (law.energy(r + step, a0) - law.energy(r - step, a0)) / (2 * step);
      CHECK(law.force(r, a0) == doctest::Approx(slope).epsilon(1e-7));
    }
    CHECK(law.energy(a0 * (1 - 1e-13), a0) == doctest::Approx(law.energy(a0, a0)).epsilon(1e-10));
  }
}

TEST_CASE("a law that cannot hold a grain is refused") {
  CHECK_NOTHROW(require_valid({.F0 = 1e-3, .gamma = 0.5}));
  CHECK_THROWS_WITH_AS(require_valid({.F0 = 0, .gamma = 7}), "attraction F0 must be > 0, got 0", UsageError);
  CHECK_THROWS_AS(require_valid({.F0 = std::numeric_limits<double>::infinity(), .gamma = 7}), UsageError);
  CHECK_THROWS_WITH_AS(require_valid({.F0 = 1, .gamma = -2}), "attraction exponent must be > 0, got -2",
                       UsageError);
  CHECK_THROWS_AS(require_valid({.F0 = 1, .gamma = std::nan("")}), UsageError);
}
