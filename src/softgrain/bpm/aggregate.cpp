#include "softgrain/bpm/aggregate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/geometry/ball.hpp"
#include "softgrain/math/random.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {
namespace {

// Units of the preparation: mean primary diameter 1, F0 = 1, mass of a disk (sphere) of diameter 1 = 1. A
// pair then vibrates with the period 2 pi / sqrt(2 gamma) = 1.7 for gamma = 7.
constexpr double time_step = 0.05;
constexpr double bond_pressure = 1;  // F0 / <a0>, F0 / <a0>^2 in space
template <int Dim>
constexpr double dense_fraction = Dim == 2 ? 0.82 : 0.64;
/// How much larger the packing is that a grain is cut out of: the surface of a ball takes a larger share.
template <int Dim>
constexpr double cut_from = Dim == 2 ? 1.5 : 1.9;
constexpr int fewest_contraction_steps = 3000;  // 5.2 times the fall to the centre for 1750 primaries
constexpr int relaxation_steps = 4000;

enum Stream : std::uint32_t { diameters, jitter };

/// Sites of a hexagonal lattice, or of a simple cubic one, round the origin: `count` of them and more.
template <int Dim>
std::vector<Vec<Dim>> lattice_sites(int count, double spacing) {
  std::vector<Vec<Dim>> sites;
  if constexpr (Dim == 2) {
    const int half = static_cast<int>(std::ceil(std::sqrt(count))) + 2;
    for (int row = -half; row <= half; ++row)
      for (int column = -half; column <= half; ++column)
        sites.push_back({spacing * (column + 0.5 * (row & 1)), spacing * row * std::sqrt(0.75)});
  } else {
    const int half = static_cast<int>(std::ceil(std::cbrt(count))) + 1;
    for (int z = -half; z <= half; ++z)
      for (int y = -half; y <= half; ++y)
        for (int x = -half; x <= half; ++x) sites.push_back({spacing * x, spacing * y, spacing * z});
  }
  return sites;
}

/// Disks (spheres) on a loose jittered lattice, nearest to the origin first.
template <int Dim>
RigidParticles<Dim> loose_primaries(int count, const AggregateOptions& options) {
  const double smallest = 2 / (1 + options.size_ratio), largest = options.size_ratio * smallest;
  std::vector<Vec<Dim>> sites = lattice_sites<Dim>(count, largest * 1.15);
  std::stable_sort(sites.begin(), sites.end(),
                   [](const Vec<Dim>& a, const Vec<Dim>& b) { return dot(a, a) < dot(b, b); });
  sites.resize(count);

  std::vector<double> radius, mass;
  for (int i = 0; i < count; ++i) {
    const double diameter =
        smallest + (largest - smallest) * random_uniform(options.seed, Stream::diameters, i);
    for (int k = 0; k < Dim; ++k)
      sites[i][k] += (largest * 0.15) * (random_uniform(options.seed, Stream::jitter, Dim * i + k) - 0.5);
    radius.push_back(diameter / 2);
    mass.push_back(times_power<Dim>(1, diameter));
  }
  return rigid_particles<Dim>(std::move(sites), std::move(radius), std::move(mass), {});
}

template <int Dim>
RigidDynamics<Dim> frictionless_dynamics(RigidParticles<Dim> particles) {
  const RigidStepOptions options{.solver = {.min_sweeps = 20, .max_sweeps = 20, .relaxation = 1.3},
                                 .law = {},
                                 .precision = Dim == 2 ? Precision::full : Precision::single};
  return RigidDynamics<Dim>(
      std::move(particles), [](int, int) { return 0.0; }, options, 0.25);
}

template <int Dim>
void damp(const RigidParticles<Dim>& particles, double rate, std::span<Vec<Dim>> force) {
  for (int i = 0; i < particles.size(); ++i) force[i] -= rate * particles.mass[i] * particles.velocity[i];
}

/// A central force, constant per mass, with the pressure of the bonds at the centre.
template <int Dim>
RigidParticles<Dim> contracted(RigidParticles<Dim> loose) {
  constexpr double dense = dense_fraction<Dim>;
  const double packed_radius =
      Dim == 2 ? std::sqrt(loose.size() / (4 * dense)) : std::cbrt(loose.size() / (8 * dense));
  const double density = (Dim == 2 ? 4 : 6) / std::numbers::pi * dense;
  const double pull = bond_pressure / (density * packed_radius);
  const double fall_time = std::sqrt(packed_radius / pull);
  RigidDynamics<Dim> dynamics = frictionless_dynamics(std::move(loose));
  const ForceField<Dim> field = [&](const RigidParticles<Dim>& particles, std::span<Vec<Dim>> force) {
    for (int i = 0; i < particles.size(); ++i) {
      const Vec<Dim>& x = particles.position[i];
      force[i] -= pull * particles.mass[i] / std::max(norm(x), 1.0) * x;
    }
    damp(particles, 2 / fall_time, force);
  };
  const int steps = std::max(fewest_contraction_steps, static_cast<int>(5.2 * fall_time / time_step));
  for (int step = 0; step < steps; ++step) dynamics.step(field, time_step);
  return dynamics.particles;
}

/// The `count` primaries that reach least far from the centre of mass.
template <int Dim>
RigidParticles<Dim> cut_out(const RigidParticles<Dim>& packing, int count) {
  Vec<Dim> centre;
  double total = 0;
  for (int i = 0; i < packing.size(); ++i)
    centre += packing.mass[i] * packing.position[i], total += packing.mass[i];
  centre *= 1 / total;
  const auto reach = [&](int i) { return norm(packing.position[i] - centre) + packing.radius[i]; };
  std::vector<int> order(packing.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return reach(i) < reach(j); });
  std::vector<Vec<Dim>> position;
  std::vector<double> radius, mass;
  for (int k = 0; k < count; ++k) {
    position.push_back(packing.position[order[k]] - centre);
    radius.push_back(packing.radius[order[k]]);
    mass.push_back(packing.mass[order[k]]);
  }
  return rigid_particles<Dim>(std::move(position), std::move(radius), std::move(mass), {});
}

template <int Dim>
AggregateOf<Dim> relaxed(RigidParticles<Dim> cut, double gamma) {
  AttractionForcesOf<Dim> attraction({.F0 = 1, .gamma = gamma});
  RigidDynamics<Dim> dynamics = frictionless_dynamics(std::move(cut));
  const ForceField<Dim> field = [&](const RigidParticles<Dim>& particles, std::span<Vec<Dim>> force) {
    attraction.update(particles, dynamics.reference);
    attraction.add_forces(particles, force);
    damp(particles, 0.3, force);
  };
  StepReport last;
  for (int step = 0; step < relaxation_steps; ++step) last = dynamics.step(field, time_step);

  AggregateOf<Dim> grain;
  grain.position = dynamics.particles.position;
  grain.radius = dynamics.particles.radius;
  grain.coordination = 2.0 * last.contacts / dynamics.particles.size();
  for (int c = 0; c < dynamics.contacts.size(); ++c)
    if (dynamics.contacts.impulse[c][0] > 0)
      grain.mean_distance +=
          (grain.radius[dynamics.contacts.body_a[c]] + grain.radius[dynamics.contacts.body_b[c]]) /
          last.contacts;
  return grain;
}

/// Puts the centre of area (volume) at the origin and the mean radius to 1.
template <int Dim>
void normalise(AggregateOf<Dim>& grain) {
  Vec<Dim> centre;
  double area = 0;
  for (std::size_t i = 0; i < grain.radius.size(); ++i) {
    const double a = times_power<Dim>(1, grain.radius[i]);
    centre += a * grain.position[i];
    area += a;
  }
  centre *= 1 / area;
  const OutlineShape shape = outline_shape<Dim>(grain.position, grain.radius, centre);
  for (Vec<Dim>& x : grain.position) x = (1 / shape.mean_radius) * (x - centre);
  for (double& r : grain.radius) r /= shape.mean_radius;
  grain.mean_distance /= shape.mean_radius;
  grain.roundness = shape.roundness;
}

}  // namespace

template <int Dim>
AggregateOf<Dim> prepare_aggregate(const AggregateOptions& options) {
  require(options.primaries >= fewest_primaries, "a grain needs at least {} primaries, got {}",
          fewest_primaries, options.primaries);
  require(options.size_ratio >= 1 && options.size_ratio <= largest_size_ratio,
          "size ratio of primaries must be in [1, {}], got {}", largest_size_ratio, options.size_ratio);
  const int count = static_cast<int>(std::ceil(cut_from<Dim> * options.primaries));
  AggregateOf<Dim> grain = relaxed<Dim>(
      cut_out(contracted(loose_primaries<Dim>(count, options)), options.primaries), options.gamma);
  normalise(grain);
  return grain;
}

template AggregateOf<2> prepare_aggregate<2>(const AggregateOptions&);
template AggregateOf<3> prepare_aggregate<3>(const AggregateOptions&);

}  // namespace softgrain
