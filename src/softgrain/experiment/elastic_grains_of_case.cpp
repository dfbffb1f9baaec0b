#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/adhesion_of_case.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/lattice_case.hpp"
#include "softgrain/experiment/shape_of_case.hpp"
#include "softgrain/experiment/solid_case.hpp"
#include "softgrain/experiment/stages_of_case.hpp"
#include "softgrain/lattice/lattice_grains.hpp"
#include "softgrain/soft/elastic_grains.hpp"

namespace softgrain {
namespace {

/// Of an explicit step: the mesh's own vibrations are damped.
constexpr double damping_share = 0.5;

AnyLaw law_of(const Case& c) { return make_law(c.mpm.law, c.mpm.material); }

SoftGrains grains_of(const Case& c, std::vector<GrainPlacement> placed) {
  std::vector<GrainMaterial> materials;
  for (int k = 0; k < kinds_of(c); ++k) {
    const Case of_kind = case_of_kind(c, k);
    const double density = of_kind.grain.density;
    if (is_rigid(of_kind))
      materials.push_back({.law = {}, .density = density, .rigid = true});
    else
      materials.push_back({law_of(of_kind), density});
  }
  return {std::move(placed), std::move(materials)};
}

/// The grid of each kind; elastic disks of one resolution share it.
std::vector<std::shared_ptr<const Topology>> shapes_of(const Case& c) {
  std::map<int, std::shared_ptr<const Topology>> by_cells;
  std::vector<std::shared_ptr<const Topology>> shapes;
  for (int k = 0; k < kinds_of(c); ++k) {
    const Case of_kind = case_of_kind(c, k);
    const int cells = of_kind.mpm.cells;
    if (is_rigid(of_kind) || of_kind.grain.shape != ShapeOfGrain::disk) {
      shapes.push_back(grain_shape_of(of_kind));
      continue;
    }
    std::shared_ptr<const Topology>& shape = by_cells[cells];
    if (!shape) shape = grain_shape_of(of_kind);
    shapes.push_back(shape);
  }
  return shapes;
}

GrainPlacement placement(const std::shared_ptr<const Topology>& shape, const PlacedGrain& grain) {
  return {.topology = shape,
          .radius = grain.radius,
          .centre = grain.centre,
          .angle = grain.angle,
          .velocity = {},
          .kind = grain.kind};
}

/// Of Newton's method, so that what it leaves of a stress that is kept is small.
double tolerance_of(const Case& c, const SoftGrains& grains, double height) {
  const double kept = least_kept_stress(c);
  if (kept == 0) return c.mpm.tolerance;
  constexpr double share = 0.01;  // of the stress
  return std::min(c.mpm.tolerance, share * kept / grains.largest_wave_modulus() * height / grains.radius(0));
}

/// Of a lattice [m]: a grain, the smallest in a box, has as many points as with the other formulation.
double cell_of(const Case& c) {
  const double radius = !is_in_a_box(c)           ? c.grain.radius
                        : c.sample.placed.empty() ? diameter_law(c.sample).least() / 2
                                                  : c.sample.smallest_diameter / 2;
  return radius * std::sqrt(std::numbers::pi / 3.5) / c.mpm.cells;  // 14 cells^2 points, 4 to a cell
}

/// Grains of points on one lattice: that of the case between two walls, or a sample in a box.
PlacedModel lattice_grains_of(const Case& c) {
  const double cell = cell_of(c);
  std::vector<PointGrain> grains;
  Box<2> box;
  if (is_in_a_box(c)) {
    const BoxSample sample = sample_box(c);
    for (const PlacedGrain& grain : sample.grains)
      grains.push_back(disk_of_points(grain.radius, grain.centre, cell, 8 * c.mpm.cells));
    box = box_of(sample);
    const std::string cannot = lattice_cannot(c);
    require(cannot.empty(), "{}", cannot);
  } else {
    grains.push_back(disk_of_points(c.grain.radius, {}, cell, 8 * c.mpm.cells));
    double reach = 0;  // the outline is symmetric about both axes
    for (const Vec<2>& x : grains.front().outline) reach = std::max(reach, x[1]);
    box = walls_at(-reach, reach);
  }
  UpdatedLagrangianDynamics dynamics(std::move(grains), box, law_of(c), c.grain.density,
                                     {.shape = c.mpm.shape_functions,
                                      .contact_on = c.mpm.contact_on,
                                      .cell = cell,
                                      .friction = c.contact.friction,
                                      .wall_friction = c.contact.wall_friction,
                                      .gravity = gravity_of(c),
                                      .damping = c.mpm.damping,
                                      .implicit = c.mpm.lattice_integrator == Integrator::backward_euler,
                                      .tolerance = c.mpm.tolerance});
  const double dt = c.time.step > 0             ? c.time.step
                    : dynamics.options.implicit ? first_time_step(c)
                                                : stable_time_step(dynamics.law, dynamics.density, cell);
  return {std::make_unique<LatticeGrains>(std::move(dynamics)), std::move(box), dt};
}

PlacedModel implicit_grains(const Case& c, SoftGrains grains, Box<2> box, double smallest_radius) {
  const double dt = c.time.step > 0 ? c.time.step : implicit_time_step(c, smallest_radius);
  const ImplicitOptions options{.tolerance = tolerance_of(c, grains, box.height()),
                                .friction = c.contact.friction,
                                .wall_friction = c.contact.wall_friction,
                                .pair_friction = pair_friction_of(c),
                                .adhesion = adhesion_of(c),
                                .gravity = gravity_of(c),
                                .damping = c.mpm.damping};
  ImplicitDynamics dynamics(std::move(grains), box, options);
  return {std::make_unique<ElasticGrains<ImplicitDynamics>>(std::move(dynamics)), std::move(box), dt};
}

ExplicitOptions explicit_options_of(const Case& c) {
  return {.damping_share = damping_share,
          .friction = c.contact.friction,
          .wall_friction = c.contact.wall_friction,
          .pair_friction = pair_friction_of(c),
          .adhesion = adhesion_of(c),
          .gravity = gravity_of(c),
          .damping = c.mpm.damping};
}

PlacedModel explicit_grains(const Case& c, SoftGrains grains, Box<2> box, double smallest_radius) {
  const double dt = c.time.step > 0             ? c.time.step
                    : grains.fastest_wave() > 0 ? stable_time_step(grains)
                                                : implicit_time_step(c, smallest_radius);
  ExplicitDynamics dynamics(std::move(grains), box, explicit_options_of(c));
  return {std::make_unique<ElasticGrains<ExplicitDynamics>>(std::move(dynamics)), std::move(box), dt};
}

std::vector<GrainPlacement> placements(const Case& c, const std::vector<PlacedGrain>& grains) {
  const std::vector<std::shared_ptr<const Topology>> shapes = shapes_of(c);
  std::vector<GrainPlacement> placed;
  for (const PlacedGrain& grain : grains) placed.push_back(placement(shapes[grain.kind], grain));
  return placed;
}

}  // namespace

std::vector<PairFriction> pair_friction_of(const Case& c) {
  std::vector<PairFriction> friction;
  for (const Case::Pair& pair : c.pairs)
    if (pair.friction)
      friction.push_back(
          {pair.kind, pair.other == Case::Pair::wall ? PairFriction::wall : pair.other, *pair.friction});
  return friction;
}

double longest_time_step(const Case& c) {
  constexpr double no_limit = std::numeric_limits<double>::infinity();
  if (is_bonded(c)) return no_limit;
  if (is_in_space(c)) return longest_solid_step(c);
  if (is_lattice(c))
    return c.mpm.lattice_integrator == Integrator::backward_euler
               ? no_limit
               : stable_time_step(law_of(c), c.grain.density, cell_of(c), 0.2 * (1 + 1e-9));
  if (c.mpm.integrator != Integrator::symplectic_euler) return no_limit;
  const auto longest = [](const Case& of_kind) {
    if (is_rigid(of_kind)) return no_limit;
    if (is_bonded(of_kind)) return critical_bond_step(of_kind);
    const double radius = !is_in_a_box(of_kind)           ? of_kind.grain.radius
                          : of_kind.sample.placed.empty() ? diameter_law(of_kind.sample).least() / 2
                                                          : of_kind.sample.smallest_diameter / 2;
    return longest_stable_step(grains_of(of_kind, {placement(grain_shape_of(of_kind),
                                                             {.centre = {}, .radius = radius, .angle = 0})}),
                               damping_share);
  };
  return least_of_kinds(c, longest);
}

void check_time_step(const Case& c) {
  if (c.time.step == 0 || is_bonded(c)) return;
  const double longest = longest_time_step(c);
  require(c.time.step <= longest,
          "time.step {:.4g} us is beyond the longest stable step of an explicit run of this case, "
          "{:.4g} us; give at most that, or \"auto\"",
          1e6 * c.time.step, 1e6 * longest);
}

ExplicitDynamics explicit_dynamics_of(const Case& c, const std::vector<PlacedGrain>& grains,
                                      const Box<2>& box) {
  return {grains_of(c, placements(c, grains)), box, explicit_options_of(c)};
}

PlacedModel elastic_grains_of(const Case& c) {
  check_time_step(c);
  if (is_lattice(c)) return lattice_grains_of(c);
  std::vector<GrainPlacement> placed;
  Box<2> box;
  if (is_in_a_box(c)) {
    const BoxSample sample = sample_box(c);
    placed = placements(c, sample.grains);
    box = box_of(sample);
  } else {
    placed = placements(c, {{.centre = {}, .radius = c.grain.radius, .angle = angle_between_walls(c)}});
    const auto [low, high] = between_walls(c);
    box = walls_at(low, high);
  }
  double smallest = placed.front().radius;
  for (const GrainPlacement& grain : placed) smallest = std::min(smallest, grain.radius);
  SoftGrains grains = grains_of(c, std::move(placed));
  if (c.mpm.integrator == Integrator::symplectic_euler)
    return explicit_grains(c, std::move(grains), std::move(box), smallest);
  return implicit_grains(c, std::move(grains), std::move(box), smallest);
}

}  // namespace softgrain
