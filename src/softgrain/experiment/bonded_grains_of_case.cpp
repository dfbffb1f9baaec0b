#include <algorithm>
#include <span>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/bpm/bonded_sample.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/adhesion_of_case.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/geometry/ball.hpp"
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

/// F0 [N/m], in space [N].
double attraction_of(const Case& c) { return is_in_space(c) ? c.bpm.force : c.bpm.attraction; }

template <int Dim>
BoxSampleOf<Dim> box_sample_of(const Case& c) {
  if constexpr (Dim == 3)
    return sample_solid_box(c);
  else
    return sample_box(c);
}

/// Walls that the grain touches, below and above it.
template <int Dim>
std::vector<Wall<Dim>> touching_walls(std::span<const Vec<Dim>> position, std::span<const double> radius) {
  Vec<Dim> up;
  up[Dim - 1] = 1;
  const double low = -support<Dim>(position, radius, Vec<Dim>{} - up),
               high = support<Dim>(position, radius, up);
  if constexpr (Dim == 3)
    return solid_walls_at(low, high).walls;
  else
    return walls_at(low, high).walls;
}

template <int Dim>
RigidParticles<Dim> single_grain(const Case& c, const AggregateOf<Dim>& aggregate) {
  std::vector<Vec<Dim>> position = aggregate.position;
  std::vector<double> radius = aggregate.radius, mass;
  double filled = 0;  // by the primaries, over unit_ball
  for (const double r : radius) filled += times_power<Dim>(1, r);
  const double grain_mass = times_power<Dim>(c.grain.density * unit_ball<Dim>, c.grain.radius);
  for (const double r : radius) mass.push_back(times_power<Dim>(grain_mass, r) / filled);
  for (Vec<Dim>& x : position) x *= c.grain.radius;
  for (double& r : radius) r *= c.grain.radius;
  std::vector<Wall<Dim>> walls = touching_walls<Dim>(position, radius);
  return rigid_particles<Dim>(std::move(position), std::move(radius), std::move(mass), std::move(walls));
}

template <int Dim>
BondedGrainsSetupOf<Dim> setup_between_walls(const Case& c) {
  const auto aggregate = prepare_aggregate<Dim>({.primaries = c.bpm.primaries,
                                                 .size_ratio = c.bpm.size_ratio,
                                                 .gamma = c.bpm.exponent,
                                                 .seed = static_cast<std::uint64_t>(c.sample.seed)});
  const double mean_distance = aggregate.mean_distance * c.grain.radius;
  return {.particles = single_grain(c, aggregate),
          .grain_radius = {c.grain.radius},
          .laws = {{.F0 = attraction_of(c), .gamma = c.bpm.exponent}},
          .kind = {0},
          .friction = {},
          .options = {},
          .skin = skin_of_one_grain * aggregate.mean_distance * c.grain.radius,
          .density = 0,
          .sigma_I = cohesive_pressure<Dim>(attraction_of(c), mean_distance)};
}

/// sigma_I is the same in every grain of a kind.
template <int Dim>
BondedGrainsSetupOf<Dim> setup_of_sample(const Case& c, BpmSampleOf<Dim> sample,
                                         const std::vector<PlacedGrainOf<Dim>>& grains) {
  std::vector<Case> kind;
  for (int k = 0; k < kinds_of(c); ++k) kind.push_back(case_of_kind(c, k));
  const double smallest = *std::min_element(sample.mean_distance.begin(), sample.mean_distance.end());
  BondedGrainsSetupOf<Dim> setup{.particles = std::move(sample.particles),
                                 .grain_radius = {},
                                 .laws = {},
                                 .kind = {},
                                 .friction = {},
                                 .options = {},
                                 .skin = skin_in_a_box * smallest,
                                 .density = 0,
                                 .sigma_I = least_of_kinds(with_bonded_kinds(c), [](const Case& of_kind) {
                                   return of_kind.bpm.cohesive_pressure;
                                 })};
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const Case::Bpm& bpm = kind[static_cast<std::size_t>(grains[g].kind)].bpm;
    setup.grain_radius.push_back(grains[g].radius);
    setup.kind.push_back(grains[g].kind);
    setup.laws.push_back(
        {.F0 = attraction_with<Dim>(bpm.cohesive_pressure, sample.mean_distance[g]), .gamma = bpm.exponent});
  }
  return setup;
}

/// The attraction of a primary is that of its share of an outline, which a rigid disk does not have.
void refuse_adhesion_of_rigid(const Case& c, const PairAdhesion& pair) {
  for (const int kind : {pair.kind, pair.other}) {
    if (kind == PairAdhesion::wall || c.kinds.empty()) continue;
    require(
        c.kinds[kind].model == GrainModel::bpm,
        "not yet: rigid grains among bonded ones that adhere (kind '{}'): give each [[pair]] of this kind "
        "surface_energy = 0",
        c.kinds[kind].name);
  }
}

/// What the case says of all grains.
template <int Dim>
void complete(const Case& c, BondedGrainsSetupOf<Dim>& setup) {
  setup.friction = {.inside = {},
                    .between = c.contact.friction,
                    .wall = c.contact.wall_friction,
                    .named = pair_friction_of(c)};
  for (int k = 0; k < kinds_of(c); ++k)
    setup.friction.inside.push_back(case_of_kind(c, k).bpm.inner_friction);
  setup.adhesion = adhesion_of(c);
  for (const PairAdhesion& pair : setup.adhesion) refuse_adhesion_of_rigid(c, pair);
  setup.options = rigid_step_options(c);
  setup.density = largest_of_kinds(c, [](const Case& kind) { return kind.grain.density; });
  setup.gravity = gravity_of<Dim>(c);
}

}  // namespace

template <int Dim>
BpmSampleOf<Dim> filled_box(const Case& c, const BoxSampleOf<Dim>& box) {
  std::vector<AggregateLibrary> options;
  std::vector<std::vector<AggregateOf<Dim>>> library;
  for (int k = 0; k < kinds_of(c); ++k) {
    options.push_back(library_of(case_of_kind(c, k)));
    library.push_back(prepare_library<Dim>(options.back()));
  }
  return fill_box(box, library, options);
}

BondedGrainsSetup bonded_setup(const Case& c, BpmSample sample, const std::vector<PlacedGrain>& grains) {
  BondedGrainsSetup setup = setup_of_sample<2>(c, std::move(sample), grains);
  complete(c, setup);
  return setup;
}

template <int Dim>
PlacedModelOf<Dim> bonded_grains_of(const Case& c) {
  const double dt = checked_bonded_time_step(c);
  BondedGrainsSetupOf<Dim> setup;
  if (is_in_a_box(c)) {
    const BoxSampleOf<Dim> box = box_sample_of<Dim>(c);
    setup = setup_of_sample<Dim>(c, filled_box(c, box), box.grains);
  } else {
    setup = setup_between_walls<Dim>(c);
  }
  complete(c, setup);
  Box<Dim> box(setup.particles.walls);
  box.cell = setup.particles.cell;
  return {std::make_unique<BondedGrainsOf<Dim>>(std::move(setup)), std::move(box), dt};
}

template PlacedModelOf<2> bonded_grains_of<2>(const Case&);
template PlacedModelOf<3> bonded_grains_of<3>(const Case&);
template BpmSample filled_box<2>(const Case&, const BoxSample&);
template BpmSampleOf<3> filled_box<3>(const Case&, const BoxSampleOf<3>&);

}  // namespace softgrain
