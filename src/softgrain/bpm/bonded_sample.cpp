#include "softgrain/bpm/bonded_sample.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/ball.hpp"
#include "softgrain/geometry/images.hpp"
#include "softgrain/rigid/close_pairs.hpp"

namespace softgrain {
namespace {

/// Radius over the smallest one for which the k-th aggregate of the library is made: the middles of equal
/// shares of the radii, or the diameters of a list in turn.
double size_of(const AggregateLibrary& c, int k) {
  if (!c.equal_size) return 1;
  const double ratio = c.largest / c.smallest;
  if (c.diameters.empty()) return 1 + (ratio - 1) * (k + 0.5) / c.count;
  return c.diameters[k % c.diameters.size()] / c.smallest;
}

/// The next of the aggregates that are nearest in size to a grain of this radius.
int nearest_in_size(const AggregateLibrary& c, int grain, double radius) {
  const auto distance = [&](int k) { return std::abs(size_of(c, k) - 2 * radius / c.smallest); };
  std::vector<int> nearest{0};
  for (int k = 1; k < c.count; ++k) {
    const double nearer = distance(nearest.front()) - distance(k);
    if (nearer > 0) nearest.clear();
    if (nearer >= 0) nearest.push_back(k);
  }
  return nearest[grain % nearest.size()];
}

/// Which aggregate a grain gets: the next one, or that whose number of primaries fits its radius.
int choice_of(const AggregateLibrary& c, int grain, double radius) {
  if (!c.equal_size) return grain % c.count;
  if (!c.diameters.empty()) return nearest_in_size(c, grain, radius);
  const double smallest = c.smallest / 2, largest = c.largest / 2;
  if (!(largest > smallest)) return 0;
  const double share = (radius - smallest) / (largest - smallest);
  return std::clamp(static_cast<int>(share * c.count), 0, c.count - 1);
}

/// visit(i, j, x_j - x_i) of all particles that may overlap. Each wide one looks at all others.
template <int Dim, class Visit>
void for_each_near_pair(const RigidParticles<Dim>& particles, const Visit& visit) {
  const std::vector<char> wide = wide_bodies(particles.radius);
  std::vector<int> others;
  std::vector<Vec<Dim>> position;
  double widest = 0;
  for (int i = 0; i < particles.size(); ++i) {
    if (wide[i] != 0) continue;
    others.push_back(i);
    position.push_back(particles.position[i]);
    widest = std::max(widest, particles.radius[i]);
  }
  for_each_close_pair<Dim>(
      position, particles.cell, 2 * widest,
      [&](int k, int l, const Vec<Dim>& d, const auto&) { visit(others[k], others[l], d); });
  for (int i = 0; i < particles.size(); ++i) {
    if (wide[i] == 0) continue;
    for (int j = 0; j < particles.size(); ++j) {
      if (wide[j] != 0 && j <= i) continue;
      const Vec<Dim> d = particles.position[j] - particles.position[i];
      visit(i, j, particles.cell.any() ? d + particles.cell.shift(particles.cell.nearest(d)) : d);
    }
  }
}

/// Moves grains as wholes out of the walls and out of each other once; returns the largest overlap met [m].
template <int Dim>
double push_apart(RigidParticles<Dim>& particles, std::span<Vec<Dim>> shift) {
  double worst = 0;
  std::vector<Vec<Dim>> push(shift.size());
  std::vector<double> deepest(shift.size(), 0);  // of a grain's overlaps: the one that moves it
  const auto meet = [&](int grain, double overlap, const Vec<Dim>& away) {
    worst = std::max(worst, overlap);
    if (overlap <= deepest[grain]) return;
    deepest[grain] = overlap;
    push[grain] = overlap * away;
  };
  const auto& x = particles.position;
  const auto& R = particles.radius;
  for (int i = 0; i < particles.size(); ++i)
    for (const Wall<Dim>& wall : particles.walls)
      meet(particles.grain[i], R[i] - dot(x[i] - wall.point, wall.normal), wall.normal);
  for_each_near_pair(particles, [&](int i, int j, const Vec<Dim>& d) {
    const int a = particles.grain[i], b = particles.grain[j];
    if (a == b) return;
    const double r = norm(d), overlap = R[i] + R[j] - r;
    if (!(overlap > 0) || r == 0) return;
    meet(a, overlap, (-0.6 / r) * d);
    meet(b, overlap, (0.6 / r) * d);
  });
  for (std::size_t g = 0; g < shift.size(); ++g) shift[g] += push[g];
  for (int i = 0; i < particles.size(); ++i) particles.position[i] += push[particles.grain[i]];
  return worst;
}

/// Until no overlap is worth a tenth of a per cent of a primary's radius.
template <int Dim>
double separate_grains(BpmSampleOf<Dim>& sample, const BoxSampleOf<Dim>& box) {
  std::vector<Vec<Dim>> shift(box.grains.size());
  const auto& radius = sample.particles.radius;
  const double tolerance = 1e-3 * *std::min_element(radius.begin(), radius.end());
  constexpr int most_passes = 5000;
  for (int pass = 0; push_apart<Dim>(sample.particles, shift) > tolerance; ++pass)
    require(pass < most_passes,
            "could not place {} grains of primaries without overlap; use a smaller sample.packing_fraction",
            box.grains.size());
  double furthest = 0;
  for (std::size_t g = 0; g < shift.size(); ++g)
    furthest = std::max(furthest, norm(shift[g]) / box.grains[g].radius);
  return furthest;
}

/// A grain as it is turned in its place.
auto turn_by(double angle) {
  const Vec<2> along{std::cos(angle), std::sin(angle)};
  return [along](const Vec<2>& X) { return X[0] * along + X[1] * perpendicular(along); };
}
auto turn_by(const Mat<3>& rotation) {
  return [rotation](const Vec<3>& X) { return rotation * X; };
}

}  // namespace

template <int Dim>
std::vector<AggregateOf<Dim>> prepare_library(const AggregateLibrary& c) {
  std::vector<AggregateOf<Dim>> library;
  if (c.primaries == 1) return {{.position = {{}}, .radius = {1}, .mean_distance = 2}};
  for (int k = 0; k < c.count; ++k) {
    const double size = size_of(c, k);
    library.push_back(prepare_aggregate<Dim>(
        {.primaries = static_cast<int>(std::lround(times_power<Dim>(c.primaries, size))),
         .size_ratio = c.size_ratio,
         .gamma = c.gamma,
         .seed = c.seed + (static_cast<std::uint64_t>(k) << 32)}));
  }
  return library;
}

template <int Dim>
BpmSampleOf<Dim> fill_box(const BoxSampleOf<Dim>& box,
                          const std::vector<std::vector<AggregateOf<Dim>>>& library,
                          const std::vector<AggregateLibrary>& options) {
  BpmSampleOf<Dim> sample;
  std::vector<Vec<Dim>> position;
  std::vector<double> radius, mass;
  std::vector<int> grain_of;
  for (int g = 0; g < static_cast<int>(box.grains.size()); ++g) {
    const PlacedGrainOf<Dim>& grain = box.grains[g];
    const auto kind = static_cast<std::size_t>(grain.kind);
    const AggregateLibrary& c = options[kind];
    const AggregateOf<Dim>& aggregate = library[kind][choice_of(c, g, grain.radius)];
    const auto turn = turn_by(grain.angle);
    double filled = 0;
    for (const double r : aggregate.radius) filled += times_power<Dim>(1, r);
    sample.begin.push_back(static_cast<int>(position.size()));
    sample.mean_distance.push_back(grain.radius * aggregate.mean_distance);
    for (std::size_t i = 0; i < aggregate.radius.size(); ++i) {
      position.push_back(grain.centre + grain.radius * turn(aggregate.position[i]));
      radius.push_back(grain.radius * aggregate.radius[i]);
      mass.push_back(times_power<Dim>(c.density * unit_ball<Dim>, radius.back()) / filled);
      grain_of.push_back(g);
    }
  }
  sample.begin.push_back(static_cast<int>(position.size()));
  const Box<Dim> bounds = box_of(box);
  sample.particles =
      rigid_particles<Dim>(std::move(position), std::move(radius), std::move(mass), bounds.walls);
  sample.particles.cell = bounds.cell;
  sample.particles.grain = std::move(grain_of);
  sample.displaced = separate_grains(sample, box);
  return sample;
}

template std::vector<Aggregate> prepare_library<2>(const AggregateLibrary&);
template std::vector<AggregateOf<3>> prepare_library<3>(const AggregateLibrary&);
template BpmSample fill_box<2>(const BoxSample&, const std::vector<std::vector<Aggregate>>&,
                               const std::vector<AggregateLibrary>&);
template BpmSampleOf<3> fill_box<3>(const BoxSampleOf<3>&, const std::vector<std::vector<AggregateOf<3>>>&,
                                    const std::vector<AggregateLibrary>&);

}  // namespace softgrain
