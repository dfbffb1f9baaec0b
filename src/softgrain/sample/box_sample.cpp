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
#include "softgrain/math/random_turn.hpp"

namespace softgrain {
namespace {

enum Stream : std::uint32_t { diameters, places, angles, turns };

/// Shares of the clearance that are tried, one after the other.
constexpr std::array clearance_shares{1.0, 0.5, 0.25};

/// A periodic cell is at least so many times as wide as its largest grain.
constexpr double cell_over_grain = 2.5;

/// Diameters are drawn anew up to so often: few grains of some sizes find no places where others do.
constexpr int most_draws = 60;

template <int Dim>
PeriodicCell<Dim> cell_of(const BoxSampleOf<Dim>& sample) {
  PeriodicCell<Dim> cell{.repeats = sample.repeats};
  for (int k = 0; k < Dim; ++k)
    if (sample.repeats[static_cast<std::size_t>(k)]) cell.edges(k, k) = sample.size()[k];
  return cell;
}

/// Pushes grains out of the walls and out of each other once; returns the largest overlap met [m].
template <int Dim>
double push_apart(BoxSampleOf<Dim>& sample, double clearance, double widest) {
  double worst = 0;
  std::vector<Vec<Dim>> centres;
  const Vec<Dim> size = sample.size();
  for (PlacedGrainOf<Dim>& grain : sample.grains) {
    const double reach = (1 + clearance) * grain.radius;
    for (int k = 0; k < Dim; ++k) {
      if (sample.repeats[k]) continue;
      const double inside = std::clamp(grain.centre[k], reach, size[k] - reach);
      worst = std::max(worst, std::abs(inside - grain.centre[k]));
      grain.centre[k] = inside;
    }
    centres.push_back(grain.centre);
  }
  const double reach = 2 * (1 + clearance) * widest;
  for_each_close_pair<Dim>(
      centres, cell_of(sample), reach, [&](int i, int j, const Vec<Dim>& apart, const auto&) {
        PlacedGrainOf<Dim>&a = sample.grains[i], &b = sample.grains[j];
        const bool repeats = sample.repeats[0] || sample.repeats[1];  // others have moved on since
        const Vec<Dim> d = repeats ? apart : b.centre - a.centre;
        const double distance = norm(d), overlap = (1 + clearance) * (a.radius + b.radius) - distance;
        if (!(overlap > 0)) return;
        worst = std::max(worst, overlap);
        // two in one corner: apart in any direction
        const Vec<Dim> push = distance > 0 ? (0.3 * overlap / distance) * d : Vec<Dim>{0.3 * overlap};
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
template <int Dim>
BoxSampleOf<Dim> drawn(const BoxSampleOptions& options, int draw) {
  BoxSampleOf<Dim> sample;
  double area = 0;  // volume in space
  const std::uint64_t first = static_cast<std::uint64_t>(draw) * options.grains;
  for (int kind = 0; kind < static_cast<int>(options.kinds.size()); ++kind) {
    const auto& [grains, sizes] = options.kinds[kind];
    const std::uint64_t begin = sample.grains.size();
    for (const double diameter :
         draw_diameters(sizes, grains, options.seed, Stream::diameters, first + begin)) {
      const std::uint64_t i = sample.grains.size();
      PlacedGrainOf<Dim> grain{.centre = {}, .radius = diameter / 2, .kind = kind};
      if constexpr (Dim == 2) {
        grain.angle = 2 * std::numbers::pi * random_uniform(options.seed, Stream::angles, i);
        area += std::numbers::pi * diameter * diameter / 4;
      } else {
        grain.angle = random_turn(options.seed, Stream::turns, i);
        area += std::numbers::pi * diameter * diameter * diameter / 6;
      }
      sample.grains.push_back(grain);
    }
  }
  if constexpr (Dim == 2) {
    const double side = std::sqrt(area / options.packing_fraction);
    sample.repeats = options.repeats;
    sample.width = side * std::sqrt(options.aspect);
    sample.height = side / std::sqrt(options.aspect);
  } else {
    sample.height = std::cbrt(area / options.packing_fraction / (options.aspect * options.aspect));
    sample.width = options.aspect * sample.height;
  }
  return sample;
}

template <int Dim>
bool has_room(const BoxSampleOf<Dim>& sample, double clearance) {
  const double least = std::min(sample.width, sample.height);
  return std::all_of(sample.grains.begin(), sample.grains.end(),
                     [&](const auto& grain) { return 2 * (1 + clearance) * grain.radius <= least; });
}

/// Uniform places, the start-th ones, from which overlaps are pushed out. True if none is left.
template <int Dim>
bool place(BoxSampleOf<Dim>& sample, const BoxSampleOptions& options, double clearance, int start,
           int most_passes) {
  const Vec<Dim> size = sample.size();
  for (int i = 0; i < options.grains; ++i) {
    const std::uint64_t number = Dim * (i + static_cast<std::uint64_t>(start) * options.grains);
    for (int k = 0; k < Dim; ++k)
      sample.grains[i].centre[k] =
          size[k] * random_uniform(options.seed, Stream::places, number + static_cast<std::uint64_t>(k));
  }
  const double tolerance = 1e-3 * clearance * least_diameter(options);
  for (int pass = 0; pass < most_passes; ++pass)
    if (push_apart(sample, clearance, greatest_diameter(options) / 2) < tolerance) return true;
  return false;
}

/// Other places, less clearance, other diameters, until no grain overlaps; nothing if that does not come.
template <int Dim>
std::optional<BoxSampleOf<Dim>> search(const BoxSampleOptions& options, std::span<const double> shares,
                                       int most_starts) {
  const int starts = std::clamp(4000 / options.grains, 2, most_starts);
  const int passes = std::min(200 * options.grains, 5000);
  const int draws = std::clamp(300 / options.grains, 1, most_draws);
  for (int draw = 0; draw < draws; ++draw) {
    BoxSampleOf<Dim> sample = drawn<Dim>(options, draw);
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

namespace {

template <int Dim>
double largest_fraction(const BoxSampleOptions& options) {
  int low = 0, high = static_cast<int>(std::ceil(100 * options.packing_fraction));  // per cent
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    BoxSampleOptions some = options;
    some.packing_fraction = 0.01 * middle;
    (search<Dim>(some, std::span(clearance_shares).last(1), 5) ? low : high) = middle;
  }
  return 0.01 * low;
}

template <int Dim>
BoxSampleOf<Dim> sampled(const BoxSampleOptions& given) {
  const BoxSampleOptions options = with_kinds(given);
  check(options);
  BoxSampleOf<Dim> sample = drawn<Dim>(options, 0);
  constexpr int most_passes = 100000;
  if (has_room(sample, options.clearance) && place(sample, options, options.clearance, 0, most_passes))
    return sample;
  if (auto found = search<Dim>(options, clearance_shares, 40)) return *found;
  throw UsageError(fmt::format(
      "sample.packing_fraction = {}: could not place sample.grains = {} without overlap in a box of "
      "aspect {}; the largest fraction found for them is {:.2f}: use that or less{}",
      options.packing_fraction, options.grains, options.aspect, largest_fraction<Dim>(options),
      options.grains < 50 ? ", or more grains" : ""));
}

}  // namespace

BoxSample sample_box(const BoxSampleOptions& given) { return sampled<2>(given); }
BoxSampleOf<3> sample_solid_box(const BoxSampleOptions& given) { return sampled<3>(given); }

double largest_packing_fraction(const BoxSampleOptions& given) {
  const BoxSampleOptions options = with_kinds(given);
  check(options);
  return largest_fraction<2>(options);
}

Box<2> walls_at(double low, double high) {
  return Box<2>({{.point = {0, low}, .normal = {0, 1}, .velocity = {}},
                 {.point = {0, high}, .normal = {0, -1}, .velocity = {}}});
}

Box<3> solid_walls_at(double low, double high) {
  return Box<3>({{.point = {0, 0, low}, .normal = {0, 0, 1}, .velocity = {}},
                 {.point = {0, 0, high}, .normal = {0, 0, -1}, .velocity = {}}});
}

Box<3> box_of(const BoxSampleOf<3>& sample) {
  std::vector<Wall<3>> walls;
  for (int axis = 2; axis >= 0; --axis) {
    Vec<3> normal, far;
    normal[axis] = 1;
    far[axis] = sample.size()[axis];
    walls.push_back({.point = {}, .normal = normal, .velocity = {}});
    walls.push_back({.point = far, .normal = Vec<3>{} - normal, .velocity = {}});
  }
  return Box<3>(std::move(walls));
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
