#include "softgrain/experiment/sample.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/pour.hpp"

namespace softgrain {
namespace {

BoxSampleOptions options_of(const Case& c) {
  std::vector<GrainsOfKind> kinds;
  for (const Case::Kind& kind : c.kinds)
    kinds.push_back({kind.grains, diameter_law(kind.sizes, c.experiment.dimension)});
  return {.grains = c.sample.grains,
          .sizes = kinds.empty() ? diameter_law(c.sample, c.experiment.dimension) : DiameterLaw{},
          .kinds = std::move(kinds),
          .packing_fraction = c.sample.packing_fraction,
          .aspect = c.sample.aspect,
          .repeats = repeats_of(c),
          .seed = static_cast<std::uint64_t>(c.sample.seed)};
}

/// Number, sizes, box and packing fraction of placed grains.
Case with_box_of_placed(Case c) {
  Case::Sample& sample = c.sample;
  const bool solid = is_in_space(c);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto n = sample.placed.size();
  const auto place = [&](std::size_t i, int k) -> double& {
    return k == 2 ? sample.placed_z[i] : sample.placed[i].centre[k];
  };
  Vec<3> low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};
  double filled = 0;
  sample.smallest_diameter = infinite;
  sample.largest_diameter = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double R = sample.placed[i].radius;
    for (int k = 0; k < c.experiment.dimension; ++k) {
      low[k] = std::min(low[k], place(i, k) - R);
      high[k] = std::max(high[k], place(i, k) + R);
    }
    filled += solid ? 4 * std::numbers::pi / 3 * R * R * R : std::numbers::pi * R * R;
    sample.smallest_diameter = std::min(sample.smallest_diameter, 2 * R);
    sample.largest_diameter = std::max(sample.largest_diameter, 2 * R);
  }
  double* const sides[] = {&c.box.width, solid ? &c.box.depth : &c.box.height, &c.box.height};
  for (int k = 0; k < c.experiment.dimension; ++k) {
    if (*sides[k] > 0) continue;
    *sides[k] = high[k] - low[k];
    for (std::size_t i = 0; i < n; ++i) place(i, k) -= low[k];
  }
  sample.grains = static_cast<int>(n);
  sample.packing_fraction = filled / (c.box.width * c.box.height * (solid ? c.box.depth : 1));
  sample.aspect = c.box.width / c.box.height;
  return c;
}

}  // namespace

BoxSample sample_box(const Case& c) {
  const auto repeats = repeats_of(c);
  if (!c.sample.placed.empty()) return {c.box.width, c.box.height, {repeats[0], repeats[1]}, c.sample.placed};
  return sample_box(options_of(c));
}

BoxSampleOf<3> sample_solid_box(const Case& c) {
  if (c.sample.placed.empty()) return sample_solid_box(options_of(c));
  BoxSampleOf<3> sample{
      .width = c.box.width, .height = c.box.height, .repeats = repeats_of(c), .depth = c.box.depth};
  const auto seed = static_cast<std::uint64_t>(c.sample.seed);
  for (std::size_t i = 0; i < c.sample.placed.size(); ++i) {
    const PlacedGrain& grain = c.sample.placed[i];
    sample.grains.push_back({.centre = {grain.centre[0], grain.centre[1], c.sample.placed_z[i]},
                             .radius = grain.radius,
                             .angle = turn_of_sphere(seed, i),
                             .kind = grain.kind});
  }
  return sample;
}

bool is_to_pour(const Case& c) {
  return is_in_a_box(c) && c.sample.places == Places::pour && c.sample.placed.empty();
}

Case with_poured_grains(Case c) {
  require(!is_in_space(c), "not yet: grains are poured in the plane only");
  BoxSample sample = pour(
      {.grains = options_of(c), .friction = c.contact.friction, .wall_friction = c.contact.wall_friction});
  c.sample.placed = std::move(sample.grains);
  c.box.width = sample.width;
  c.box.height = sample.height;
  return complete_sample(std::move(c));
}

DiameterLaw diameter_law(const Case::Sizes& sample, int dimension) {
  DiameterLaw law{.law = sample.sizes,
                  .smallest = sample.smallest_diameter,
                  .largest = sample.largest_diameter,
                  .median = sample.median_diameter,
                  .deviation = sample.deviation,
                  .diameters = sample.diameters,
                  .numbers = sample.numbers};
  if (law.law != SizeLaw::list) return law;
  if (!sample.shares.empty()) {
    law.numbers.clear();
    for (std::size_t k = 0; k < std::min(sample.shares.size(), sample.diameters.size()); ++k)
      law.numbers.push_back(sample.shares[k] / (sample.diameters[k] * sample.diameters[k]) /
                            (dimension == 3 ? sample.diameters[k] : 1));
  } else if (sample.numbers.empty()) {
    law.numbers.assign(sample.diameters.size(), 1.0);
  }
  return law;
}

Case complete_sample(Case c) {
  Case::Sample& sample = c.sample;
  if (sample.sizes == SizeLaw::list && !sample.diameters.empty()) {
    const auto [smallest, largest] = std::minmax_element(sample.diameters.begin(), sample.diameters.end());
    sample.smallest_diameter = *smallest;
    sample.largest_diameter = *largest;
  }
  if (!c.kinds.empty()) {
    sample.grains = 0;
    sample.smallest_diameter = std::numeric_limits<double>::infinity();
    sample.largest_diameter = 0;
    for (const Case::Kind& kind : c.kinds) {
      const DiameterLaw law = diameter_law(kind.sizes);
      sample.grains += kind.grains;
      sample.smallest_diameter = std::min(sample.smallest_diameter, law.least());
      sample.largest_diameter = std::max(sample.largest_diameter, law.greatest());
    }
  }
  return sample.placed.empty() ? c : with_box_of_placed(std::move(c));
}

AggregateLibrary library_of(const Case& c) {
  if (!is_bonded(c)) return {.count = 1, .primaries = 1, .density = c.grain.density};
  return {.count = c.bpm.library,
          .primaries = c.bpm.primaries,
          .size_ratio = c.bpm.size_ratio,
          .gamma = c.bpm.exponent,
          .equal_size = c.bpm.equal == EqualPrimaries::size,
          .smallest = c.sample.smallest_diameter,
          .largest = c.sample.largest_diameter,
          .diameters = c.sample.sizes == SizeLaw::list ? c.sample.diameters : std::vector<double>{},
          .density = c.grain.density,
          .seed = static_cast<std::uint64_t>(c.sample.seed)};
}

}  // namespace softgrain
