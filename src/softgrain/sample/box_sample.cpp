#include "softgrain/sample/box_sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/images.hpp"
#include "softgrain/math/random.hpp"
#include "softgrain/math/random_turn.hpp"
#include "softgrain/sample/relax.hpp"

namespace softgrain {
namespace {

enum Stream : std::uint32_t { diameters, places, angles, turns };

/// Shares of the clearance that are tried, one after the other.
constexpr std::array clearance_shares{1.0, 0.5, 0.25};
constexpr std::array clearance_shares_in_space{1.0, 0.5, 0.25, 0.05};
template <int Dim>
constexpr std::span<const double> shares_tried() {
  if constexpr (Dim == 2)
    return clearance_shares;
  else
    return clearance_shares_in_space;
}

/// A periodic cell is at least so many times as wide as its largest grain.
constexpr double cell_over_grain = 2.5;

/// Diameters are drawn anew up to so often: few grains of some sizes find no places where others do.
constexpr int most_draws = 60;

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
        grain.angle = turn_of_sphere(options.seed, i);
        area += std::numbers::pi * diameter * diameter * diameter / 6;
      }
      sample.grains.push_back(grain);
    }
  }
  if constexpr (Dim == 2) {
    const double side = std::sqrt(area / options.packing_fraction);
    sample.width = side * std::sqrt(options.aspect);
    sample.height = side / std::sqrt(options.aspect);
  } else {
    sample.height = std::cbrt(area / options.packing_fraction / (options.aspect * options.aspect));
    sample.width = options.aspect * sample.height;
  }
  std::copy_n(options.repeats.begin(), Dim, sample.repeats.begin());
  return sample;
}

template <int Dim>
bool has_room(const BoxSampleOf<Dim>& sample, double clearance) {
  const double least = std::min(sample.width, sample.height);
  return std::all_of(sample.grains.begin(), sample.grains.end(),
                     [&](const auto& grain) { return 2 * (1 + clearance) * grain.radius <= least; });
}

/// Uniform places, the start-th ones.
template <int Dim>
void scatter(BoxSampleOf<Dim>& sample, const BoxSampleOptions& options, int start) {
  const Vec<Dim> size = sample.size();
  for (int i = 0; i < options.grains; ++i) {
    const std::uint64_t number = Dim * (i + static_cast<std::uint64_t>(start) * options.grains);
    for (int k = 0; k < Dim; ++k)
      sample.grains[i].centre[k] =
          size[k] * random_uniform(options.seed, Stream::places, number + static_cast<std::uint64_t>(k));
  }
}

/// From the first ones overlaps are pushed out. True if none is left.
template <int Dim>
bool place(BoxSampleOf<Dim>& sample, const BoxSampleOptions& options, double clearance, int most_passes) {
  scatter(sample, options, 0);
  const double tolerance = 1e-3 * clearance * least_diameter(options);
  for (int pass = 0; pass < most_passes; ++pass)
    if (push_apart(sample, clearance, greatest_diameter(options) / 2) < tolerance) return true;
  return false;
}

/// The same by minimising the energy of all overlaps, which finds denser packings in less time.
template <int Dim>
bool settle(BoxSampleOf<Dim>& sample, const BoxSampleOptions& options, double clearance, int start) {
  scatter(sample, options, start);
  return relax(sample, clearance, (Dim == 3 ? 0.1 : 0.01) * clearance * least_diameter(options));
}

/// Other places, less clearance, other diameters, until no grain overlaps; nothing if that does not come.
template <int Dim>
std::optional<BoxSampleOf<Dim>> search(const BoxSampleOptions& options, std::span<const double> shares,
                                       int most_starts) {
  const int starts = std::clamp((Dim == 3 ? 1000 : 12000) / options.grains, 2, Dim == 3 ? 5 : most_starts);
  const int draws = std::clamp((Dim == 3 ? 100 : 300) / options.grains, 1, Dim == 3 ? 5 : most_draws);
  for (int draw = 0; draw < draws; ++draw) {
    BoxSampleOf<Dim> sample = drawn<Dim>(options, draw);
    for (const double share : shares) {
      const double clearance = share * options.clearance;
      if (!has_room(sample, clearance)) continue;
      for (int start = 1; start <= starts; ++start)
        if (settle(sample, options, clearance, start)) return sample;
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
    (search<Dim>(some, shares_tried<Dim>().last(1), 5) ? low : high) = middle;
  }
  return 0.01 * low;
}

template <int Dim>
BoxSampleOf<Dim> sampled(const BoxSampleOptions& given) {
  const BoxSampleOptions options = with_kinds(given);
  check(options);
  BoxSampleOf<Dim> sample = drawn<Dim>(options, 0);
  // `search` is faster: this finds the samples that it found before there was another way
  const int most_passes =
      std::clamp((Dim == 3 ? 200000 : 2000000) / options.grains, Dim == 3 ? 500 : 5000, 100000);
  if (has_room(sample, options.clearance) && place(sample, options, options.clearance, most_passes))
    return sample;
  if (auto found = search<Dim>(options, shares_tried<Dim>(), 120)) return *found;
  throw UsageError(fmt::format(
      "sample.packing_fraction = {}: could not place sample.grains = {} without overlap in a box of "
      "aspect {}; the largest fraction found for them is {:.2f}: use that or less{}",
      options.packing_fraction, options.grains, options.aspect, largest_fraction<Dim>(options),
      options.grains < 50 ? ", or more grains" : ""));
}

}  // namespace

BoxSample sample_box(const BoxSampleOptions& given) { return sampled<2>(given); }
BoxSampleOf<3> sample_solid_box(const BoxSampleOptions& given) { return sampled<3>(given); }
Mat<3> turn_of_sphere(std::uint64_t seed, std::uint64_t i) { return random_turn(seed, Stream::turns, i); }

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

template <int Dim>
Box<Dim> box_of(const BoxSampleOf<Dim>& sample) {
  constexpr std::array name{"x", "y", "z"};
  const std::array long_along =
      Dim == 2 ? std::array{"wide", "high", ""} : std::array{"wide", "deep", "high"};
  const Vec<Dim> size = sample.size();
  double widest = 0;
  for (const auto& grain : sample.grains) widest = std::max(widest, 2 * grain.radius);
  for (std::size_t k = 0; k < Dim; ++k) {
    const double length = size[static_cast<int>(k)];
    require(
        !sample.repeats[k] || length >= cell_over_grain * widest,
        "box.{}: the periodic cell is {:.3g} m {}, less than {} times the largest grain: it would meet its "
        "own image; use more grains, or a larger box",
        name[k], length, long_along[k], cell_over_grain);
    require(k == 0 || sample.repeats[k - 1] || !sample.repeats[k],
            "box.{0} = \"periodic\" with walls in {1}: turn the box, so that box.{1} is \"periodic\"",
            name[k], name[k > 0 ? k - 1 : 0]);
  }
  std::vector<Wall<Dim>> walls;
  for (int axis = Dim - 1; axis >= 0; --axis) {
    if (sample.repeats[static_cast<std::size_t>(axis)]) continue;
    Vec<Dim> normal, far;
    normal[axis] = 1;
    far[axis] = size[axis];
    walls.push_back({.point = {}, .normal = normal, .velocity = {}});
    walls.push_back({.point = far, .normal = Vec<Dim>{} - normal, .velocity = {}});
  }
  Box<Dim> box(std::move(walls));
  box.cell = cell_of(sample);
  return box;
}

template <int Dim>
std::vector<Misplaced> misplaced_grains(const BoxSampleOf<Dim>& sample) {
  std::vector<Misplaced> faults;
  std::vector<Vec<Dim>> centres;
  double widest = 0;
  const Vec<Dim> size = sample.size();
  for (const auto& grain : sample.grains) {
    double outside = 0;
    for (int k = 0; k < Dim; ++k)
      if (!sample.repeats[k])
        outside =
            std::max({outside, grain.radius - grain.centre[k], grain.centre[k] + grain.radius - size[k]});
    if (outside > largest_placed_overlap * grain.radius)
      faults.push_back({static_cast<int>(centres.size()), -1, outside});
    centres.push_back(grain.centre);
    widest = std::max(widest, grain.radius);
  }
  for_each_close_pair<Dim>(centres, cell_of(sample), 2 * widest,
                           [&](int i, int j, const Vec<Dim>& d, const auto&) {
                             const auto &a = sample.grains[i], &b = sample.grains[j];
                             const double depth = a.radius + b.radius - norm(d);
                             if (depth > largest_placed_overlap * std::min(a.radius, b.radius))
                               faults.push_back({j, i, depth});
                           });
  std::sort(faults.begin(), faults.end(), [](const Misplaced& a, const Misplaced& b) {
    return std::pair(a.grain, a.other) < std::pair(b.grain, b.other);
  });
  return faults;
}

template Box<2> box_of(const BoxSample&);
template Box<3> box_of(const BoxSampleOf<3>&);
template std::vector<Misplaced> misplaced_grains(const BoxSample&);
template std::vector<Misplaced> misplaced_grains(const BoxSampleOf<3>&);

}  // namespace softgrain
