#include "softgrain/experiment/pour.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/images.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {
namespace {

/// Of the column from which they fall: loose enough that random places are found at once.
constexpr double loose = 0.4;
/// Steps in which the smallest grain falls by its radius at full speed.
constexpr double steps_a_radius = 25;
/// At rest: the mean speed, over that of falling.
constexpr double at_rest = 1e-3;
/// Times the fall of the whole column, after which whatever has not come to rest never will.
constexpr std::int64_t most_falls = 20;
/// Of lists of pairs, over the smallest radius.
constexpr double skin = 0.3;

double mean_radius(const BoxSample& sample) {
  double sum = 0;
  for (const PlacedGrain& grain : sample.grains) sum += grain.radius;
  return sum / static_cast<double>(sample.grains.size());
}

double least_radius(const BoxSample& sample) {
  return std::min_element(sample.grains.begin(), sample.grains.end(),
                          [](const auto& a, const auto& b) { return a.radius < b.radius; })
      ->radius;
}

/// A column of the width that the options mean, wide enough for the loose packing fraction.
BoxSample column_of(BoxSampleOptions options) {
  const double height_over_width = options.packing_fraction / (options.aspect * loose);
  options.aspect = 1 / height_over_width;
  options.packing_fraction = loose;
  return sample_box(options);
}

RigidDynamics<2> disks_of(const BoxSample& column, const PourOptions& options) {
  std::vector<Vec<2>> centre;
  std::vector<double> radius, mass;
  for (const PlacedGrain& grain : column.grains) {
    centre.push_back(grain.centre);
    radius.push_back(grain.radius);
    mass.push_back(grain.radius * grain.radius);
  }
  const Box<2> box = box_of(column);
  RigidParticles<2> disks =
      rigid_particles<2>(std::move(centre), std::move(radius), std::move(mass), box.walls);
  for (int i = 0; i < disks.size(); ++i) disks.grain[static_cast<std::size_t>(i)] = i;
  disks.cell = box.cell;
  const int n = disks.size();
  const RigidStepOptions step{
      .solver = {.min_sweeps = 10, .max_sweeps = 500, .tolerance = 5e-6, .extrapolated = true},
      .law = {.push_out = 0.2}};
  RigidDynamics<2> dynamics(
      std::move(disks),
      [n, &options](int, int b) { return b < n ? options.friction : options.wall_friction; }, step,
      skin * least_radius(column));
  set_reference(dynamics.reference, dynamics.particles);
  dynamics.rebuild_contacts();
  return dynamics;
}

void let_fall(RigidDynamics<2>& dynamics, double fall, double mean_radius, double least_radius) {
  const double g = 1, v = std::sqrt(g * mean_radius), dt = least_radius / (steps_a_radius * v);
  const auto field = [&](const RigidParticles<2>& disks, std::span<Vec<2>> force) {
    for (int i = 0; i < disks.size(); ++i)
      force[i] += disks.mass[i] * (Vec<2>{0, -g} - (g / v) * disks.velocity[i]);
  };
  double mass = 0;
  for (const double m : dynamics.particles.mass) mass += m;
  const auto steps_of_fall = static_cast<std::int64_t>(fall / (v * dt)) + 1;
  for (std::int64_t step = 0; step < most_falls * steps_of_fall; ++step) {
    dynamics.step(field, dt);
    if (step > steps_of_fall / 10 &&
        kinetic_energy(dynamics.particles) < 0.5 * mass * v * v * at_rest * at_rest)
      return;
  }
}

/// The largest overlap over the distance of the two centres, or that of a centre from its wall.
double worst_overlap(const BoxSample& sample, const PeriodicCell<2>& cell) {
  double worst = 0, widest = 0;
  std::vector<Vec<2>> centres;
  for (const PlacedGrain& grain : sample.grains) {
    const auto [x, y] = std::pair(grain.centre[0], grain.centre[1]);
    worst = std::max(worst, grain.radius / y - 1);
    if (!cell.any()) worst = std::max(worst, grain.radius / std::min(x, sample.width - x) - 1);
    widest = std::max(widest, grain.radius);
    centres.push_back(grain.centre);
  }
  for_each_close_pair<2>(centres, cell, 2 * widest, [&](int i, int j, const Vec<2>& apart, const auto&) {
    worst = std::max(worst, (sample.grains[i].radius + sample.grains[j].radius) / norm(apart) - 1);
  });
  return worst;
}

}  // namespace

BoxSample pour(const PourOptions& options) {
  require(!options.grains.repeats[1], "grains are poured onto a bottom wall: box.y must be \"walls\"");
  BoxSample sample = column_of(options.grains);
  RigidDynamics<2> dynamics = disks_of(sample, options);
  let_fall(dynamics, sample.height, mean_radius(sample), least_radius(sample));
  for (std::size_t i = 0; i < sample.grains.size(); ++i)
    sample.grains[i].centre = dynamics.particles.position[i];
  const double apart = 1 + worst_overlap(sample, dynamics.particles.cell);  // what the solver leaves
  sample.width *= apart;
  sample.height = 0;
  for (PlacedGrain& grain : sample.grains) {
    grain.centre *= apart;
    sample.height = std::max(sample.height, grain.centre[1] + grain.radius);
  }
  return sample;
}

}  // namespace softgrain
