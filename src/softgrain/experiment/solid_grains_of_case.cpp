#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/solid_case.hpp"
#include "softgrain/material/any_law.hpp"
#include "softgrain/soft/elastic_grains.hpp"
#include "softgrain/soft/rigid_surface.hpp"

namespace softgrain {
namespace {

/// Of an explicit step: the mesh's own vibrations are damped.
constexpr double solid_damping_share = 0.5;

/// Of the longest stable step: cells that flatten leave less of it.
constexpr double step_share = 0.6;

/// Sweeps go on until the worst contact is off by 16 times this in a step, over the mean radius: what they
/// leave is the start of the next step, so that ten times less changes pressures by 0.4 %
/// (docs/decisions/0051).
constexpr double solid_tolerance = 2e-5;

/// From this Poisson's ratio on U' is taken at the mean J of a cell: full integration is 7 % too stiff at
/// 0.49, while at 0.45 it is nearer to the truth than the mean (docs/decisions/0050).
constexpr double locking_poisson_ratio = 0.475;

/// What flows does so at constant volume, and would lock too.
GrainMaterial solid_material(const Case& kind) {
  if (is_rigid(kind)) return {.law = {}, .density = kind.grain.density, .rigid = true};
  const LawChoice& choice = law_choice(kind.mpm.law);
  const bool flows = choice.flows() || choice.takes(&MaterialParameters::creep_rate);
  return {.law = make_law(kind.mpm.law, kind.mpm.material),
          .density = kind.grain.density,
          .mean_dilatation = flows || kind.mpm.material.poisson_ratio >= locking_poisson_ratio};
}

SolidGrains solid_grains(const Case& c, std::vector<PlacementOf<3>> placed) {
  std::vector<GrainMaterial> materials;
  for (int k = 0; k < kinds_of(c); ++k) materials.push_back(solid_material(case_of_kind(c, k)));
  return {std::move(placed), std::move(materials)};
}

/// The grid of each kind; spheres of one resolution share it, rigid ones among themselves.
std::vector<std::shared_ptr<const SolidTopology>> solid_shapes(const Case& c) {
  std::map<std::pair<bool, int>, std::shared_ptr<const SolidTopology>> known;
  std::vector<std::shared_ptr<const SolidTopology>> shapes;
  for (int k = 0; k < kinds_of(c); ++k) {
    const Case kind = case_of_kind(c, k);
    const int cells = kind.mpm.cells;
    if (kind.grain.shape == ShapeOfGrain::surface) {
      shapes.push_back(
          std::make_shared<const SolidTopology>(rigid_surface(StarSurface(kind.grain.surface), cells)));
      continue;
    }
    std::shared_ptr<const SolidTopology>& shape = known[{is_rigid(kind), cells}];
    if (!shape)
      shape = std::make_shared<const SolidTopology>(is_rigid(kind) ? rigid_ball(cells)
                                                                   : SolidTopology(ball_grid(cells)));
    shapes.push_back(shape);
  }
  return shapes;
}

double least_radius(const Case& kind) {
  if (!is_in_a_box(kind)) return kind.grain.radius;
  return (kind.sample.placed.empty() ? diameter_law(kind.sample).least() : kind.sample.smallest_diameter) / 2;
}

}  // namespace

double longest_solid_step(const Case& c) {
  return least_of_kinds(c, [](const Case& kind) {
    if (is_rigid(kind)) return std::numeric_limits<double>::infinity();
    const auto shape = std::make_shared<const SolidTopology>(ball_grid(kind.mpm.cells));
    return longest_stable_step(
        SolidGrains({{.topology = shape, .radius = least_radius(kind), .centre = {}, .velocity = {}}},
                    {solid_material(kind)}),
        solid_damping_share);
  });
}

PlacedModelOf<3> solid_grains_of(const Case& c) {
  check_time_step(c);
  const auto shapes = solid_shapes(c);
  std::vector<PlacementOf<3>> placed;
  Box<3> box;
  if (is_in_a_box(c)) {
    const BoxSampleOf<3> sample = sample_solid_box(c);
    for (const PlacedGrainOf<3>& grain : sample.grains)
      placed.push_back({.topology = shapes[static_cast<std::size_t>(grain.kind)],
                        .radius = grain.radius,
                        .centre = grain.centre,
                        .angle = grain.angle,
                        .velocity = {},
                        .kind = grain.kind});
    box = box_of(sample);
  } else {
    placed.push_back({.topology = shapes[0], .radius = c.grain.radius, .centre = {}, .velocity = {}});
    box = solid_walls_at(-c.grain.radius, c.grain.radius);
  }
  double smallest = placed.front().radius;
  for (const PlacementOf<3>& grain : placed) smallest = std::min(smallest, grain.radius);
  SolidGrains grains = solid_grains(c, std::move(placed));
  for (int k = 0; k < grains.kinds(); ++k) require_solid(grains.material(k));
  const double dt = c.time.step > 0 ? c.time.step
                    : grains.fastest_wave() > 0
                        ? step_share * longest_stable_step(grains, solid_damping_share)
                        : implicit_time_step(c, smallest);
  const SolverOptions solver{.max_sweeps = 200, .tolerance = solid_tolerance, .extrapolated = true};
  const ExplicitOptionsOf<3> options{.damping_share = solid_damping_share,
                                     .solver = solver,
                                     .friction = c.contact.friction,
                                     .wall_friction = c.contact.wall_friction,
                                     .pair_friction = pair_friction_of(c),
                                     .gravity = gravity_of<3>(c),
                                     .damping = c.mpm.damping};
  ExplicitStep<3> dynamics(std::move(grains), box, options);
  return {std::make_unique<ElasticGrains<ExplicitStep<3>>>(std::move(dynamics)), std::move(box), dt};
}

}  // namespace softgrain
