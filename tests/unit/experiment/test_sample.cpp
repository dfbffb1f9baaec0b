#include "softgrain/experiment/sample.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "softgrain/core/error.hpp"

using namespace softgrain;

TEST_CASE("grains of a sample overlap neither each other nor the box, and fill the fraction asked for") {
  const BoxSampleOptions options{.grains = 60, .packing_fraction = 0.72, .aspect = 1.5, .seed = 5};
  const BoxSample sample = sample_box(options);
  REQUIRE(sample.grains.size() == 60);
  const Vec<2> size{sample.width, sample.height};
  CHECK(size[0] / size[1] == doctest::Approx(1.5));
  double area = 0, smallest = 1, largest = 0, least_gap = 1;
  for (std::size_t i = 0; i < sample.grains.size(); ++i) {
    const PlacedGrain& a = sample.grains[i];
    area += std::numbers::pi * a.radius * a.radius;
    smallest = std::min(smallest, a.radius);
    largest = std::max(largest, a.radius);
    for (int k = 0; k < 2; ++k)
      least_gap = std::min({least_gap, a.centre[k] - a.radius, size[k] - a.centre[k] - a.radius});
    for (std::size_t j = 0; j < i; ++j)
      least_gap =
          std::min(least_gap, norm(a.centre - sample.grains[j].centre) - a.radius - sample.grains[j].radius);
  }
  CHECK(area / (size[0] * size[1]) == doctest::Approx(0.72));
  CHECK(least_gap > 0);
  CHECK(smallest >= 0.7e-3);
  CHECK(largest <= 1.2e-3);
  CHECK(largest - smallest > 0.4e-3);
}

TEST_CASE("the same seed gives the same sample bit for bit, another seed another one") {
  const auto sample = [](std::uint64_t seed) { return sample_box({.grains = 25, .seed = seed}); };
  const BoxSample a = sample(3), b = sample(3), c = sample(4);
  CHECK(a.width == b.width);
  for (std::size_t i = 0; i < a.grains.size(); ++i) {
    CHECK(a.grains[i].centre == b.grains[i].centre);
    CHECK(a.grains[i].radius == b.grains[i].radius);
    CHECK(a.grains[i].angle == b.grains[i].angle);
    CHECK(a.grains[i].centre != c.grains[i].centre);
  }
}

TEST_CASE("a sample that cannot be is refused") {
  CHECK_THROWS_AS(sample_box({.grains = 0}), UsageError);
  CHECK_THROWS_AS(sample_box({.smallest = 0}), UsageError);
  CHECK_THROWS_AS(sample_box({.smallest = 3e-3, .largest = 2e-3}), UsageError);
  CHECK_THROWS_AS(sample_box({.packing_fraction = 0.8}), UsageError);
  CHECK_THROWS_AS(sample_box({.packing_fraction = 0}), UsageError);
  CHECK_THROWS_AS(sample_box({.aspect = 0}), UsageError);
  CHECK_THROWS_AS(sample_box({.grains = 3, .aspect = 20}), UsageError);
  // one grain fills pi/4 of the box that just holds it, and it wants clearance too
  CHECK_THROWS_AS(sample_box({.grains = 1, .packing_fraction = 0.79}), UsageError);
}
