#include "softgrain/experiment/sample.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/math/random.hpp"

namespace softgrain {
namespace {

enum Stream : std::uint32_t { diameters, places, angles };

/// Pushes grains out of the walls and out of each other once; returns the largest overlap met [m].
double push_apart(BoxSample& sample, double clearance, double widest) {
  double worst = 0;
  std::vector<Vec<2>> centres;
  const Vec<2> size{sample.width, sample.height};
  for (PlacedGrain& grain : sample.grains) {
    const double reach = (1 + clearance) * grain.radius;
    for (int k = 0; k < 2; ++k) {
      const double inside = std::clamp(grain.centre[k], reach, size[k] - reach);
      worst = std::max(worst, std::abs(inside - grain.centre[k]));
      grain.centre[k] = inside;
    }
    centres.push_back(grain.centre);
  }
  CellGrid<2>(centres, 2 * (1 + clearance) * widest).for_each_close_pair([&](int i, int j) {
    PlacedGrain &a = sample.grains[i], &b = sample.grains[j];
    const Vec<2> d = b.centre - a.centre;
    const double distance = norm(d), overlap = (1 + clearance) * (a.radius + b.radius) - distance;
    if (!(overlap > 0) || distance == 0) return;
    worst = std::max(worst, overlap);
    const Vec<2> push = (0.3 * overlap / distance) * d;
    a.centre -= push;
    b.centre += push;
  });
  return worst;
}

}  // namespace

BoxSample sample_box(const BoxSampleOptions& options) {
  require(options.grains >= 1, "a sample needs at least one grain, got {}", options.grains);
  require(options.smallest > 0 && options.largest >= options.smallest,
          "diameters must be positive and in order, got {} m and {} m", options.smallest, options.largest);
  require(options.packing_fraction > 0 && options.packing_fraction < 0.8,
          "the packing fraction of a random sample must be in (0, 0.8), got {}", options.packing_fraction);
  require(options.aspect > 0, "the aspect of a box must be positive, got {}", options.aspect);
  BoxSample sample;
  double area = 0;
  for (int i = 0; i < options.grains; ++i) {
    const double diameter = options.smallest + (options.largest - options.smallest) *
                                                   random_uniform(options.seed, Stream::diameters, i);
    sample.grains.push_back({.centre = {}, .radius = diameter / 2});
    area += std::numbers::pi * diameter * diameter / 4;
  }
  const double side = std::sqrt(area / options.packing_fraction);
  sample.width = side * std::sqrt(options.aspect);
  sample.height = side / std::sqrt(options.aspect);
  for (const PlacedGrain& grain : sample.grains)
    require(2 * (1 + options.clearance) * grain.radius <= std::min(sample.width, sample.height),
            "a grain of diameter {} m has no room in a box of {} m by {} m; use a smaller "
            "sample.packing_fraction or a sample.aspect nearer to 1",
            2 * grain.radius, sample.width, sample.height);
  for (int i = 0; i < options.grains; ++i) {
    sample.grains[i].angle = 2 * std::numbers::pi * random_uniform(options.seed, Stream::angles, i);
    sample.grains[i].centre = {sample.width * random_uniform(options.seed, Stream::places, 2 * i),
                               sample.height * random_uniform(options.seed, Stream::places, 2 * i + 1)};
  }
  constexpr int most_passes = 100000;
  const double tolerance = 1e-3 * options.clearance * options.smallest;
  for (int pass = 0; pass < most_passes; ++pass)
    if (push_apart(sample, options.clearance, options.largest / 2) < tolerance) return sample;
  throw UsageError(
      fmt::format("sample.packing_fraction = {}: no places without overlap for {} grains; use a smaller one",
                  options.packing_fraction, options.grains));
}

BoxSample sample_box(const Case& c) {
  return sample_box({.grains = c.sample.grains,
                     .smallest = c.sample.smallest_diameter,
                     .largest = c.sample.largest_diameter,
                     .packing_fraction = c.sample.packing_fraction,
                     .aspect = c.sample.aspect,
                     .seed = static_cast<std::uint64_t>(c.sample.seed)});
}

}  // namespace softgrain
