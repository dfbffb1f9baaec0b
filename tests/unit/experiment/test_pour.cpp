#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/pour.hpp"
#include "softgrain/experiment/sample.hpp"

using namespace softgrain;

namespace {

PourOptions some_grains(int grains, double friction) {
  return {.grains = {.grains = grains, .packing_fraction = 0.8, .aspect = 1, .seed = 3},
          .friction = friction,
          .wall_friction = friction};
}

/// The vector to the nearest image of the other centre.
Vec<2> way(const BoxSample& sample, const PlacedGrain& a, const PlacedGrain& b) {
  Vec<2> d = b.centre - a.centre;
  if (sample.repeats[0]) d[0] -= sample.width * std::round(d[0] / sample.width);
  return d;
}

/// Whether a grain can be at rest: it lies on the bottom, or touches others on both sides of its centre, or
/// friction holds it between one below and one above.
bool is_held(const BoxSample& sample, const PlacedGrain& grain) {
  const double near = 2e-3 * grain.radius;
  if (grain.centre[1] - grain.radius < near) return true;
  bool left = !sample.repeats[0] && grain.centre[0] - grain.radius < near;
  bool right = !sample.repeats[0] && sample.width - grain.centre[0] - grain.radius < near;
  bool below = false, above = false;
  for (const PlacedGrain& other : sample.grains) {
    const Vec<2> d = way(sample, grain, other);
    if (&other == &grain || norm(d) - grain.radius - other.radius > near) continue;
    (d[0] < 0 ? left : right) = true;
    (d[1] < 0 ? below : above) = true;
  }
  return below && (above || (left && right));
}

/// Area of grains over that of the box between two heights, by points.
double filled(const BoxSample& sample, double low, double high) {
  constexpr int n = 300;
  int inside = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const PlacedGrain point{.centre = {sample.width * (i + 0.5) / n, low + (high - low) * (j + 0.5) / n}};
      inside += std::any_of(sample.grains.begin(), sample.grains.end(), [&](const PlacedGrain& grain) {
        return norm(way(sample, grain, point)) < grain.radius;
      });
    }
  return static_cast<double>(inside) / (n * n);
}

}  // namespace

TEST_CASE("poured grains do not overlap, touch the bottom, and each lies on something") {
  for (const bool repeats : {false, true}) {
    CAPTURE(repeats);
    PourOptions options = some_grains(60, 0.3);
    options.grains.repeats = {repeats, false};
    const BoxSample sample = pour(options);
    REQUIRE(sample.grains.size() == 60);
    double area = 0, highest = 0, lowest = 1;
    int held = 0;
    for (const PlacedGrain& a : sample.grains) {
      area += std::numbers::pi * a.radius * a.radius;
      highest = std::max(highest, a.centre[1] + a.radius);
      lowest = std::min(lowest, a.centre[1] - a.radius);
      held += is_held(sample, a);
      for (const PlacedGrain& b : sample.grains)
        if (&a != &b) CHECK(norm(way(sample, a, b)) - a.radius - b.radius > -1e-12 * a.radius);
    }
    CHECK(held == 60);
    CHECK(highest == doctest::Approx(sample.height).epsilon(1e-12));
    CHECK(lowest >= -1e-15);
    CHECK(lowest < 1e-6);
    CHECK(sample.width == doctest::Approx(std::sqrt(area / 0.8)).epsilon(1e-3));  // what the options mean
  }
}

TEST_CASE("grains without friction lie denser than rough ones, between loose and close packing of disks") {
  const BoxSample smooth = pour(some_grains(120, 0)), rough = pour(some_grains(120, 1));
  const auto inner = [](const BoxSample& s) { return filled(s, 0.2 * s.height, 0.7 * s.height); };
  CHECK(inner(smooth) > inner(rough) + 0.01);
  CHECK(inner(smooth) > 0.8);
  CHECK(inner(smooth) < 0.87);
  CHECK(inner(rough) > 0.72);
}

TEST_CASE("the same seed pours the same bits, and a box that repeats along y cannot be poured into") {
  const BoxSample one = pour(some_grains(20, 0.3)), again = pour(some_grains(20, 0.3));
  CHECK(one.grains == again.grains);
  PourOptions options = some_grains(20, 0.3);
  options.grains.repeats = {true, true};
  CHECK_THROWS_AS(pour(options), UsageError);
}
