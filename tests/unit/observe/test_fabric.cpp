#include "softgrain/observe/fabric.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace softgrain;

namespace {

GrainPair pair_along(double angle, double force = 1) {
  GrainPair pair;
  pair.normal = {std::cos(angle), std::sin(angle)};
  pair.normal_force = force;
  return pair;
}

}  // namespace

TEST_CASE("normals spread evenly, as in square and hexagonal packings, have no anisotropy") {
  for (const int n : {2, 3, 7}) {
    std::vector<GrainPair> pairs;
    for (int k = 0; k < n; ++k) pairs.push_back(pair_along(0.3 + std::numbers::pi * k / n));
    const Fabric f = fabric(pairs);
    CHECK(f.tensor(0, 0) == doctest::Approx(0.5));
    CHECK(f.tensor(1, 1) == doctest::Approx(0.5));
    CHECK(f.tensor(0, 1) == doctest::Approx(0));
    CHECK(f.anisotropy == doctest::Approx(0));
  }
}

TEST_CASE("normals all along one direction have anisotropy 2 in that direction") {
  const Fabric f = fabric(std::vector{pair_along(0.6), pair_along(0.6 + std::numbers::pi)});
  CHECK(f.anisotropy == doctest::Approx(2));
  CHECK(f.direction == doctest::Approx(0.6));
  CHECK(f.tensor(0, 0) + f.tensor(1, 1) == doctest::Approx(1));
}

TEST_CASE("normals drawn from (1 + a cos 2(theta - theta_c))/(2 pi) give a and theta_c back") {
  constexpr double a = 0.4, direction = 1.1;
  constexpr int n = 20000;
  std::vector<GrainPair> pairs;
  // equal shares of the distribution: theta + a/2 sin 2(theta - theta_c) rises evenly; by bisection
  for (int k = 0; k < n; ++k) {
    double low = 0, high = 2 * std::numbers::pi;
    const auto share = [&](double t) {
      return t + a / 2 * (std::sin(2 * (t - direction)) + std::sin(2 * direction));
    };
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = (low + high) / 2;
      (share(middle) < 2 * std::numbers::pi * (k + 0.5) / n ? low : high) = middle;
    }
    pairs.push_back(pair_along(low));
  }
  CHECK(fabric(pairs).anisotropy == doctest::Approx(a).epsilon(1e-4));
  CHECK(fabric(pairs).direction == doctest::Approx(direction).epsilon(1e-4));
}

TEST_CASE("forces are counted over their mean in bins whose density integrates to one") {
  // <f> = 2, so the forces are 0.1, 0.6, 0.8, 2.5 of the mean
  const std::vector<GrainPair> pairs{pair_along(0, 0.2), pair_along(0, 1.2), pair_along(0, 1.6),
                                     pair_along(0, 5)};
  const ForceDistribution f = force_distribution(pairs, 8, 4);
  CHECK(f.mean == doctest::Approx(2));
  CHECK(f.width == 0.5);
  CHECK(f.density == std::vector<double>{0.5, 1, 0, 0, 0, 0.5, 0, 0});
  // with a smaller range the largest force has no bin
  CHECK(force_distribution(pairs, 2, 2).density == std::vector<double>{0.75, 0});
  CHECK(force_distribution({}, 2, 2).mean == 0);
}
