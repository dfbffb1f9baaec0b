#include <algorithm>
#include <numbers>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/bpm/bonded_sample.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/geometry/support.hpp"

namespace softgrain {
namespace {

/// Lists reach this share of the smallest <a0> further than the contacts: few rebuilds, few idle pairs. At
/// 5 m/s in a box, and slowly between two walls.
constexpr double skin_in_a_box = 0.25, skin_of_one_grain = 0.15;

RigidStepOptions rigid_step_options(const Case& c) {
  return {.solver = {.min_sweeps = c.solver.min_sweeps,
                     .max_sweeps = c.solver.max_sweeps,
                     .tolerance = c.solver.tolerance,
                     .relaxation = c.solver.relaxation,
                     .extrapolated = true},
          .law = {.restitution = c.contact.restitution,
                  .push_out = c.contact.push_out,
                  .activation = c.contact.activation},
          .precision = c.solver.precision};
}

/// A grain that touches the walls above and below it.
RigidParticles<2> single_grain(const Case& c, const Aggregate& aggregate) {
  std::vector<Vec<2>> position = aggregate.position;
  std::vector<double> radius = aggregate.radius, mass;
  double area = 0;  // of the disks over pi
  for (const double r : radius) area += r * r;
  const double grain_mass = c.grain.density * std::numbers::pi * c.grain.radius * c.grain.radius;
  for (const double r : radius) mass.push_back(grain_mass * r * r / area);
  for (Vec<2>& x : position) x *= c.grain.radius;
  for (double& r : radius) r *= c.grain.radius;
  const Box<2> box = walls_at(-support(position, radius, {0, -1}), support(position, radius, {0, 1}));
  return rigid_particles<2>(std::move(position), std::move(radius), std::move(mass), box.walls);
}

BondedGrainsSetup setup_between_walls(const Case& c) {
  const Aggregate aggregate = prepare_aggregate({.primaries = c.bpm.primaries,
                                                 .size_ratio = c.bpm.size_ratio,
                                                 .gamma = c.bpm.exponent,
                                                 .seed = static_cast<std::uint64_t>(c.sample.seed)});
  const double mean_distance = aggregate.mean_distance * c.grain.radius;
  return {.particles = single_grain(c, aggregate),
          .grain_radius = {c.grain.radius},
          .laws = {{.F0 = c.bpm.attraction, .gamma = c.bpm.exponent}},
          .friction = {},
          .options = {},
          .skin = skin_of_one_grain * aggregate.mean_distance * c.grain.radius,
          .density = 0,
          .sigma_I = c.bpm.attraction / mean_distance};
}

/// sigma_I = F0/<a0> is the same in every grain.
BondedGrainsSetup setup_in_a_box(const Case& c) {
  const BoxSample box = sample_box(c);
  BpmSample sample = fill_box(box, prepare_library(library_of(c)), library_of(c));
  const double smallest = *std::min_element(sample.mean_distance.begin(), sample.mean_distance.end());
  BondedGrainsSetup setup{.particles = std::move(sample.particles),
                          .grain_radius = {},
                          .laws = {},
                          .friction = {},
                          .options = {},
                          .skin = skin_in_a_box * smallest,
                          .density = 0,
                          .sigma_I = c.bpm.cohesive_pressure};
  for (const PlacedGrain& grain : box.grains) setup.grain_radius.push_back(grain.radius);
  for (const double a0 : sample.mean_distance)
    setup.laws.push_back({.F0 = c.bpm.cohesive_pressure * a0, .gamma = c.bpm.exponent});
  return setup;
}

}  // namespace

PlacedModel bonded_grains_of(const Case& c) {
  const double dt = checked_bonded_time_step(c);
  BondedGrainsSetup setup = is_in_a_box(c) ? setup_in_a_box(c) : setup_between_walls(c);
  setup.friction = {
      .inside = c.bpm.inner_friction, .between = c.contact.friction, .wall = c.contact.wall_friction};
  setup.options = rigid_step_options(c);
  setup.density = c.grain.density;
  setup.gravity = gravity_of(c);
  Box<2> box(setup.particles.walls);
  box.cell = setup.particles.cell;
  return {std::make_unique<BondedGrains>(std::move(setup)), std::move(box), dt};
}

}  // namespace softgrain
