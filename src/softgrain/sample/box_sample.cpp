#include "softgrain/sample/box_sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/images.hpp"
#include "softgrain/math/random.hpp"

namespace softgrain {
namespace {

enum Stream : std::uint32_t { diameters, places, angles };

/// Shares of the clearance that are tried, one after the other.
constexpr std::array clearance_shares{1.0, 0.5, 0.25};

/// A periodic cell is at least so many times as wide as its largest grain.
constexpr double cell_over_grain = 2.5;

/// Diameters are drawn anew up to so often: few grains of some sizes find no places where others do.
constexpr int most_draws = 60;

PeriodicCell<2> cell_of(const BoxSample& sample) {
  PeriodicCell<2> cell{.repeats = sample.repeats};
  if (sample.repeats[0]) cell.edges(0, 0) = sample.width;
  if (sample.repeats[1]) cell.edges(1, 1) = sample.height;
  return cell;
}

/// Pushes grains out of the walls and out of each other once; returns the largest overlap met [m].
double push_apart(BoxSample& sample, double clearance, double widest) {
  double worst = 0;
  std::vector<Vec<2>> centres;
  const Vec<2> size{sample.width, sample.height};
  for (PlacedGrain& grain : sample.grains) {
    const double reach = (1 + clearance) * grain.radius;
    for (int k = 0; k < 2; ++k) {
      if (sample.repeats[k]) continue;
      const double inside = std::clamp(grain.centre[k], reach, size[k] - reach);
      worst = std::max(worst, std::abs(inside - grain.centre[k]));
      grain.centre[k] = inside;
    }
    centres.push_back(grain.centre);
  }
  const double reach = 2 * (1 + clearance) * widest;
  for_each_close_pair<2>(
      centres, cell_of(sample), reach, [&](int i, int j, const Vec<2>& apart, const auto&) {
        PlacedGrain &a = sample.grains[i], &b = sample.grains[j];
        const bool repeats = sample.repeats[0] || sample.repeats[1];  // others have moved on since
        const Vec<2> d = repeats ? apart : b.centre - a.centre;
        const double distance = norm(d), overlap = (1 + clearance) * (a.radius + b.radius) - distance;
        if (!(overlap > 0)) return;
        worst = std::max(worst, overlap);
        // two in one corner: apart in any direction
        const Vec<2> push = distance > 0 ? (0.3 * overlap / distance) * d : Vec<2>{0.3 * overlap, 0};
        a.centre -= push;
        b.centre += push;
      });
  return worst;
}

/// With a list of kinds, if only of one, and the number of all grains.
BoxSampleOptions with_kinds(BoxSampleOptions options) {
  if (options.kinds.empty()) options.kinds = {{options.grains, options.sizes}};
  options.grains = 0;
  for (const GrainsOfKind& kind : options.kinds) options.grains += kind.grains;
  return options;
}

double least_diameter(const BoxSampleOptions& options) {
  double least = options.kinds.front().sizes.least();
  for (const GrainsOfKind& kind : options.kinds) least = std::min(least, kind.sizes.least());
  return least;
}

double greatest_diameter(const BoxSampleOptions& options) {
  double greatest = 0;
  for (const GrainsOfKind& kind : options.kinds) greatest = std::max(greatest, kind.sizes.greatest());
  return greatest;
}

/// The box and its grains without their places: the draw-th diameters.
BoxSample drawn(const BoxSampleOptions& options, int draw) {
  BoxSample sample;
  double area = 0;
  const std::uint64_t first = static_cast<std::uint64_t>(draw) * options.grains;
  for (int kind = 0; kind < static_cast<int>(options.kinds.size()); ++kind) {
    const auto& [grains, sizes] = options.kinds[kind];
    const std::uint64_t begin = sample.grains.size();
    for (const double diameter :
         draw_diameters(sizes, grains, options.seed, Stream::diameters, first + begin)) {
      const std::uint64_t i = sample.grains.size();
      sample.grains.push_back(
          {.centre = {},
           .radius = diameter / 2,
           .angle = 2 * std::numbers::pi * random_uniform(options.seed, Stream::angles, i),
           .kind = kind});
      area += std::numbers::pi * diameter * diameter / 4;
    }
  }
  const double side = std::sqrt(area / options.packing_fraction);
  sample.repeats = options.repeats;
  sample.width = side * std::sqrt(options.aspect);
  sample.height = side / std::sqrt(options.aspect);
  return sample;
}

bool has_room(const BoxSample& sample, double clearance) {
  const double least = std::min(sample.width, sample.height);
  return std::all_of(sample.grains.begin(), sample.grains.end(),
                     [&](const PlacedGrain& grain) { return 2 * (1 + clearance) * grain.radius <= least; });
}

/// Uniform places, the start-th ones, from which overlaps are pushed out. True if none is left.
bool place(BoxSample& sample, const BoxSampleOptions& options, double clearance, int start, int most_passes) {
  for (int i = 0; i < options.grains; ++i) {
    const std::uint64_t number = 2 * (i + static_cast<std::uint64_t>(start) * options.grains);
    sample.grains[i].centre = {sample.width * random_uniform(options.seed, Stream::places, number),
                               sample.height * random_uniform(options.seed, Stream::places, number + 1)};
  }
  const double tolerance = 1e-3 * clearance * least_diameter(options);
  for (int pass = 0; pass < most_passes; ++pass)
    if (push_apart(sample, clearance, greatest_diameter(options) / 2) < tolerance) return true;
  return false;
}

/// Other places, less clearance, other diameters, until no grain overlaps; nothing if that does not come.
std::optional<BoxSample> search(const BoxSampleOptions& options, std::span<const double> shares,
                                int most_starts) {
  const int starts = std::clamp(4000 / options.grains, 2, most_starts);
  const int passes = std::min(200 * options.grains, 5000);
  const int draws = std::clamp(300 / options.grains, 1, most_draws);
  for (int draw = 0; draw < draws; ++draw) {
    BoxSample sample = drawn(options, draw);
    for (const double share : shares) {
      const double clearance = share * options.clearance;
      if (!has_room(sample, clearance)) continue;
      for (int start = 1; start <= starts; ++start)
        if (place(sample, options, clearance, start, passes)) return sample;
    }
  }
  return std::nullopt;
}

void check(const BoxSampleOptions& options) {
  require(options.grains >= 1, "a sample needs at least one grain, got {}", options.grains);
  for (const GrainsOfKind& kind : options.kinds) check(kind.sizes);
  require(options.packing_fraction > 0 && options.packing_fraction < 0.8,
          "the packing fraction of a random sample must be in (0, 0.8), got {}", options.packing_fraction);
  require(options.aspect > 0, "the aspect of a box must be positive, got {}", options.aspect);
}

}  // namespace

BoxSample sample_box(const BoxSampleOptions& given) {
  const BoxSampleOptions options = with_kinds(given);
  check(options);
  BoxSample sample = drawn(options, 0);
  constexpr int most_passes = 100000;
  if (has_room(sample, options.clearance) && place(sample, options, options.clearance, 0, most_passes))
    return sample;
  if (std::optional<BoxSample> found = search(options, clearance_shares, 40)) return *found;
  throw UsageError(fmt::format(
      "sample.packing_fraction = {}: could not place sample.grains = {} without overlap in a box of "
      "aspect {}; the largest fraction found for them is {:.2f}: use that or less{}",
      options.packing_fraction, options.grains, options.aspect, largest_packing_fraction(options),
      options.grains < 50 ? ", or more grains" : ""));
}

double largest_packing_fraction(const BoxSampleOptions& given) {
  const BoxSampleOptions options = with_kinds(given);
  check(options);
  int low = 0, high = static_cast<int>(std::ceil(100 * options.packing_fraction));  // per cent
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    BoxSampleOptions some = options;
    some.packing_fraction = 0.01 * middle;
    (search(some, std::span(clearance_shares).last(1), 5) ? low : high) = middle;
  }
  return 0.01 * low;
}

Box<2> walls_at(double low, double high) {
  return Box<2>({{.point = {0, low}, .normal = {0, 1}, .velocity = {}},
                 {.point = {0, high}, .normal = {0, -1}, .velocity = {}}});
}

Box<2> box_of(const BoxSample& sample) {
  double widest = 0;
  for (const PlacedGrain& grain : sample.grains) widest = std::max(widest, 2 * grain.radius);
  for (int k = 0; k < 2; ++k)
    require(
        !sample.repeats[k] || (k == 0 ? sample.width : sample.height) >= cell_over_grain * widest,
        "box.{}: the periodic cell is {:.3g} m {}, less than {} times the largest grain: it would meet its "
        "own image; use more grains, or a larger box",
        k == 0 ? "x" : "y", k == 0 ? sample.width : sample.height, k == 0 ? "wide" : "high", cell_over_grain);
  require(sample.repeats[0] || !sample.repeats[1],
          "box.y = \"periodic\" with walls in x: turn the box, so that box.x is \"periodic\"");
  std::vector<Wall<2>> walls;
  if (!sample.repeats[1])
    walls = {{.point = {0, 0}, .normal = {0, 1}, .velocity = {}},
             {.point = {0, sample.height}, .normal = {0, -1}, .velocity = {}}};
  if (!sample.repeats[0])
    walls.insert(walls.end(), {{.point = {0, 0}, .normal = {1, 0}, .velocity = {}},
                               {.point = {sample.width, 0}, .normal = {-1, 0}, .velocity = {}}});
  Box<2> box(std::move(walls));
  box.cell = cell_of(sample);
  return box;
}

std::vector<Misplaced> misplaced_grains(const BoxSample& sample) {
  std::vector<Misplaced> faults;
  std::vector<Vec<2>> centres;
  double widest = 0;
  const Vec<2> size{sample.width, sample.height};
  for (const PlacedGrain& grain : sample.grains) {
    double outside = 0;
    for (int k = 0; k < 2; ++k)
      if (!sample.repeats[k])
        outside =
            std::max({outside, grain.radius - grain.centre[k], grain.centre[k] + grain.radius - size[k]});
    if (outside > largest_placed_overlap * grain.radius)
      faults.push_back({static_cast<int>(centres.size()), -1, outside});
    centres.push_back(grain.centre);
    widest = std::max(widest, grain.radius);
  }
  for_each_close_pair<2>(centres, cell_of(sample), 2 * widest,
                         [&](int i, int j, const Vec<2>& d, const auto&) {
                           const PlacedGrain &a = sample.grains[i], &b = sample.grains[j];
                           const double depth = a.radius + b.radius - norm(d);
                           if (depth > largest_placed_overlap * std::min(a.radius, b.radius))
                             faults.push_back({j, i, depth});
                         });
  std::sort(faults.begin(), faults.end(), [](const Misplaced& a, const Misplaced& b) {
    return std::pair(a.grain, a.other) < std::pair(b.grain, b.other);
  });
  return faults;
}

}  // namespace softgrain
