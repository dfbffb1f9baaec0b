#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/core/error.hpp"

using namespace softgrain;

TEST_CASE("a grain is prepared with unit radius about its centre of area") {
  const Aggregate grain = prepare_aggregate({.primaries = 80});
  REQUIRE(grain.position.size() == 80);
  REQUIRE(grain.radius.size() == 80);
  Vec<2> moment;
  double widest_overlap = 0, touching = 0;
  for (std::size_t i = 0; i < 80; ++i) {
    moment += grain.radius[i] * grain.radius[i] * grain.position[i];
    for (std::size_t j = 0; j < i; ++j) {
      const double gap = norm(grain.position[i] - grain.position[j]) - grain.radius[i] - grain.radius[j];
      widest_overlap = std::max(widest_overlap, -gap);
      touching += gap < 1e-3 * grain.mean_distance ? 1 : 0;
    }
  }
  CHECK(norm(moment) < 1e-14);
  const OutlineShape shape = outline_shape<2>(grain.position, grain.radius, {0, 0});
  CHECK(shape.mean_radius == doctest::Approx(1).epsilon(1e-13));
  CHECK(grain.roundness == doctest::Approx(shape.roundness).epsilon(1e-10));
  const auto [smallest, largest] = std::minmax_element(grain.radius.begin(), grain.radius.end());
  CHECK(*largest / *smallest <= 1.625 * (1 + 1e-14));
  CHECK(*largest / *smallest > 1.5);
  CHECK(widest_overlap < 1e-3 * grain.mean_distance);
  CHECK(grain.mean_distance > 2 * *smallest);
  CHECK(grain.mean_distance < 2 * *largest);
  CHECK(2 * touching / 80 == doctest::Approx(grain.coordination).epsilon(0.03));
}

TEST_CASE("the same seed prepares the same grain bit for bit, another seed other sizes and places") {
  const Aggregate first = prepare_aggregate({.primaries = 30, .seed = 5});
  const Aggregate again = prepare_aggregate({.primaries = 30, .seed = 5});
  const Aggregate other = prepare_aggregate({.primaries = 30, .seed = 6});
  CHECK(first.position == again.position);
  CHECK(first.radius == again.radius);
  int equal_ratios = 0;  // of two primaries' sizes, which the scale of the grain does not change
  for (const double a : first.radius)
    for (const double b : first.radius)
      for (const double c : other.radius)
        for (const double d : other.radius)
          if (a != b && std::abs(a * d - b * c) < 1e-14) ++equal_ratios;
  CHECK(equal_ratios < 10);
}

TEST_CASE("grains that cannot be made are refused") {
  CHECK_THROWS_WITH_AS(prepare_aggregate({.primaries = 6}), "a grain needs at least 7 primaries, got 6",
                       UsageError);
  CHECK_THROWS_WITH_AS(prepare_aggregate({.size_ratio = 0.5}),
                       "size ratio of primaries must be in [1, 4], got 0.5", UsageError);
  CHECK_THROWS_AS(prepare_aggregate({.size_ratio = 4.1}), UsageError);
  CHECK_THROWS_WITH_AS(prepare_aggregate({.primaries = 7, .gamma = 0}),
                       "attraction exponent must be > 0, got 0", UsageError);
}
