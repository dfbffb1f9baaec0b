#include "softgrain/bpm/aggregate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/math/random.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {
namespace {

// Units of the preparation: mean primary diameter 1, F0 = 1, mass of a disk of diameter 1 = 1. A pair then
// vibrates with the period 2 pi / sqrt(2 gamma) = 1.7 for gamma = 7.
constexpr double time_step = 0.05;
constexpr double bond_pressure = 1;  // F0 / <a0>
constexpr double dense_fraction = 0.82;
constexpr int fewest_contraction_steps = 3000;  // 5.2 times the fall to the centre for 1750 primaries
constexpr int relaxation_steps = 4000;

enum Stream : std::uint32_t { diameters, jitter };

/// Disks on a loose jittered hexagonal lattice, nearest to the origin first, at packing fraction 0.5.
RigidParticles<2> loose_disks(int count, const AggregateOptions& options) {
  const double smallest = 2 / (1 + options.size_ratio), largest = options.size_ratio * smallest;
  const double spacing = largest * 1.15;
  const int half = static_cast<int>(std::ceil(std::sqrt(count))) + 2;
  std::vector<Vec<2>> sites;
  for (int row = -half; row <= half; ++row)
    for (int column = -half; column <= half; ++column)
      sites.push_back({spacing * (column + 0.5 * (row & 1)), spacing * row * std::sqrt(0.75)});
  std::stable_sort(sites.begin(), sites.end(),
                   [](const Vec<2>& a, const Vec<2>& b) { return dot(a, a) < dot(b, b); });
  sites.resize(count);

  std::vector<double> radius, mass;
  for (int i = 0; i < count; ++i) {
    const double diameter =
        smallest + (largest - smallest) * random_uniform(options.seed, Stream::diameters, i);
    for (int k = 0; k < 2; ++k)
      sites[i][k] += (largest * 0.15) * (random_uniform(options.seed, Stream::jitter, 2 * i + k) - 0.5);
    radius.push_back(diameter / 2);
    mass.push_back(diameter * diameter);
  }
  return rigid_particles<2>(std::move(sites), std::move(radius), std::move(mass), {});
}

RigidDynamics<2> frictionless_dynamics(RigidParticles<2> particles) {
  const RigidStepOptions options{.solver = {.min_sweeps = 20, .max_sweeps = 20, .relaxation = 1.3},
                                 .law = {}};
  return RigidDynamics<2>(
      std::move(particles), [](int, int) { return 0.0; }, options, 0.25);
}

void damp(const RigidParticles<2>& particles, double rate, std::span<Vec<2>> force) {
  for (int i = 0; i < particles.size(); ++i) force[i] -= rate * particles.mass[i] * particles.velocity[i];
}

/// A central force, constant per mass, with the pressure of the bonds at the centre.
RigidParticles<2> contracted(RigidParticles<2> loose) {
  const double packed_radius = std::sqrt(loose.size() / (4 * dense_fraction));
  const double density = 4 / std::numbers::pi * dense_fraction;
  const double pull = bond_pressure / (density * packed_radius);
  const double fall_time = std::sqrt(packed_radius / pull);
  RigidDynamics<2> dynamics = frictionless_dynamics(std::move(loose));
  const ForceField<2> field = [&](const RigidParticles<2>& particles, std::span<Vec<2>> force) {
    for (int i = 0; i < particles.size(); ++i) {
      const Vec<2>& x = particles.position[i];
      force[i] -= pull * particles.mass[i] / std::max(norm(x), 1.0) * x;
    }
    damp(particles, 2 / fall_time, force);
  };
  const int steps = std::max(fewest_contraction_steps, static_cast<int>(5.2 * fall_time / time_step));
  for (int step = 0; step < steps; ++step) dynamics.step(field, time_step);
  return dynamics.particles;
}

/// The `count` disks that reach least far from the centre of mass.
RigidParticles<2> cut_out(const RigidParticles<2>& packing, int count) {
  Vec<2> centre;
  double total = 0;
  for (int i = 0; i < packing.size(); ++i)
    centre += packing.mass[i] * packing.position[i], total += packing.mass[i];
  centre *= 1 / total;
  const auto reach = [&](int i) { return norm(packing.position[i] - centre) + packing.radius[i]; };
  std::vector<int> order(packing.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return reach(i) < reach(j); });
  std::vector<Vec<2>> position;
  std::vector<double> radius, mass;
  for (int k = 0; k < count; ++k) {
    position.push_back(packing.position[order[k]] - centre);
    radius.push_back(packing.radius[order[k]]);
    mass.push_back(packing.mass[order[k]]);
  }
  return rigid_particles<2>(std::move(position), std::move(radius), std::move(mass), {});
}

Aggregate relaxed(RigidParticles<2> cut, double gamma) {
  AttractionForces attraction({.F0 = 1, .gamma = gamma});
  RigidDynamics<2> dynamics = frictionless_dynamics(std::move(cut));
  const ForceField<2> field = [&](const RigidParticles<2>& particles, std::span<Vec<2>> force) {
    attraction.update(particles, dynamics.reference);
    attraction.add_forces(particles, force);
    damp(particles, 0.3, force);
  };
  StepReport last;
  for (int step = 0; step < relaxation_steps; ++step) last = dynamics.step(field, time_step);

  Aggregate grain;
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

/// Puts the centre of area at the origin and the mean radius to 1.
void normalise(Aggregate& grain) {
  Vec<2> centre;
  double area = 0;
  for (std::size_t i = 0; i < grain.radius.size(); ++i) {
    const double a = grain.radius[i] * grain.radius[i];
    centre += a * grain.position[i];
    area += a;
  }
  centre *= 1 / area;
  const OutlineShape shape = outline_shape(grain.position, grain.radius, centre);
  for (Vec<2>& x : grain.position) x = (1 / shape.mean_radius) * (x - centre);
  for (double& r : grain.radius) r /= shape.mean_radius;
  grain.mean_distance /= shape.mean_radius;
  grain.roundness = shape.roundness;
}

}  // namespace

Aggregate prepare_aggregate(const AggregateOptions& options) {
  require(options.primaries >= fewest_primaries, "a grain needs at least {} primaries, got {}",
          fewest_primaries, options.primaries);
  require(options.size_ratio >= 1 && options.size_ratio <= largest_size_ratio,
          "size ratio of primaries must be in [1, {}], got {}", largest_size_ratio, options.size_ratio);
  const int count = static_cast<int>(std::ceil(1.5 * options.primaries));
  Aggregate grain =
      relaxed(cut_out(contracted(loose_disks(count, options)), options.primaries), options.gamma);
  normalise(grain);
  return grain;
}

}  // namespace softgrain
