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
  CHECK_THROWS_AS(sample_box({.sizes = {.smallest = 0}}), UsageError);
  CHECK_THROWS_AS(sample_box({.sizes = {.smallest = 3e-3, .largest = 2e-3}}), UsageError);
  CHECK_THROWS_AS(sample_box({.packing_fraction = 0.8}), UsageError);
  CHECK_THROWS_AS(sample_box({.packing_fraction = 0}), UsageError);
  CHECK_THROWS_AS(sample_box({.aspect = 0}), UsageError);
  CHECK_THROWS_AS(sample_box({.grains = 3, .aspect = 20}), UsageError);
  // one grain fills pi/4 of the box that just holds it, and it wants clearance too
  CHECK_THROWS_AS(sample_box({.grains = 1, .packing_fraction = 0.79}), UsageError);
}

TEST_CASE("few grains find places at a packing fraction of 0.7, whatever the seed, wherever there are any") {
  for (const int grains : {1, 4, 5, 8, 10, 12, 15, 20})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(grains);
      CAPTURE(seed);
      const BoxSample sample = sample_box({.grains = grains, .packing_fraction = 0.7, .seed = seed});
      const Vec<2> size{sample.width, sample.height};
      double area = 0, least_gap = 1;
      for (std::size_t i = 0; i < sample.grains.size(); ++i) {
        const PlacedGrain& a = sample.grains[i];
        area += std::numbers::pi * a.radius * a.radius;
        CHECK(2 * a.radius >= 1.4e-3);
        CHECK(2 * a.radius <= 2.4e-3);
        for (int k = 0; k < 2; ++k)
          least_gap =
              std::min({least_gap, (a.centre[k]) / a.radius - 1, (size[k] - a.centre[k]) / a.radius - 1});
        for (std::size_t j = 0; j < i; ++j) {
          const PlacedGrain& b = sample.grains[j];
          least_gap = std::min(least_gap, norm(a.centre - b.centre) / (a.radius + b.radius) - 1);
        }
      }
      CHECK(area / (size[0] * size[1]) == doctest::Approx(0.7));
      CHECK(least_gap > 0.0049);  // a quarter of the clearance, but for the tolerance
    }
}

TEST_CASE("random grains find places up to 0.79, close to where disks of these sizes jam") {
  for (const int grains : {100, 300}) {
    CAPTURE(grains);
    const BoxSample sample = sample_box({.grains = grains, .packing_fraction = 0.79, .seed = 1});
    CHECK(misplaced_grains(sample).empty());
  }
}

// Densest packings of equal disks in a square (Graham and Lubachevsky 1996, Specht's table): their fractions,
// which a clearance of 0.005 R makes smaller by 1.005^2.
TEST_CASE(
    "equal disks are packed into a square to within 0.03 of the densest packings known, and no further") {
  for (const auto& [grains, densest] : {std::pair{1, 0.7854},
                                        {2, 0.5390},
                                        {3, 0.6096},
                                        {4, 0.7854},
                                        {5, 0.6737},
                                        {6, 0.6640},
                                        {10, 0.6900}}) {
    CAPTURE(grains);
    const double found = largest_packing_fraction(
        {.grains = grains, .sizes = {.smallest = 2e-3, .largest = 2e-3}, .packing_fraction = 0.79});
    CHECK(found <= densest / (1.005 * 1.005));
    CHECK(found > densest / (1.005 * 1.005) - 0.03);
  }
}

TEST_CASE("grains for which there are no places are refused with the fraction that they can have") {
  const BoxSampleOptions options{
      .grains = 2, .sizes = {.smallest = 2e-3, .largest = 2e-3}, .packing_fraction = 0.7};
  std::string message;
  try {
    sample_box(options);
  } catch (const UsageError& error) {
    message = error.what();
  }
  CAPTURE(message);
  CHECK(message.find("the largest fraction found for them is 0.53") != std::string::npos);
  BoxSampleOptions less = options;
  less.packing_fraction = largest_packing_fraction(options);
  CHECK(sample_box(less).grains.size() == 2);
}
