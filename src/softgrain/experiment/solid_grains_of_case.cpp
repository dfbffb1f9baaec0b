#include <algorithm>

#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/solid_case.hpp"
#include "softgrain/soft/elastic_grains.hpp"

namespace softgrain {
namespace {

/// Of an explicit step: the mesh's own vibrations are damped.
constexpr double solid_damping_share = 0.5;

/// Of the longest stable step: cells that flatten leave less of it.
constexpr double step_share = 0.6;

/// From this Poisson's ratio on U' is taken at the mean J of a cell: full integration is 7 % too stiff at
/// 0.49, while at 0.45 it is nearer to the truth than the mean (docs/decisions/0050).
constexpr double locking_poisson_ratio = 0.475;

SolidGrains solid_grains(const Case& c, std::vector<PlacementOf<3>> placed) {
  const double nu = c.mpm.material.poisson_ratio;
  return {std::move(placed), std::vector<GrainMaterial>{{.law = make_law(c.mpm.law, c.mpm.material),
                                                         .density = c.grain.density,
                                                         .mean_dilatation = nu >= locking_poisson_ratio}}};
}

}  // namespace

double longest_solid_step(const Case& c) {
  const auto shape = std::make_shared<const SolidTopology>(ball_grid(c.mpm.cells));
  const double radius = is_in_a_box(c) ? diameter_law(c.sample).least() / 2 : c.grain.radius;
  return longest_stable_step(
      solid_grains(c, {{.topology = shape, .radius = radius, .centre = {}, .velocity = {}}}),
      solid_damping_share);
}

PlacedModelOf<3> solid_grains_of(const Case& c) {
  check_time_step(c);
  const auto shape = std::make_shared<const SolidTopology>(ball_grid(c.mpm.cells));
  std::vector<PlacementOf<3>> placed;
  Box<3> box;
  if (is_in_a_box(c)) {
    const BoxSampleOf<3> sample = sample_solid_box(c);
    for (const PlacedGrainOf<3>& grain : sample.grains)
      placed.push_back({.topology = shape,
                        .radius = grain.radius,
                        .centre = grain.centre,
                        .angle = grain.angle,
                        .velocity = {}});
    box = box_of(sample);
  } else {
    placed.push_back({.topology = shape, .radius = c.grain.radius, .centre = {}, .velocity = {}});
    box = solid_walls_at(-c.grain.radius, c.grain.radius);
  }
  SolidGrains grains = solid_grains(c, std::move(placed));
  for (int k = 0; k < grains.kinds(); ++k) require_solid(grains.material(k));
  const double dt =
      c.time.step > 0 ? c.time.step : step_share * longest_stable_step(grains, solid_damping_share);
  const ExplicitOptionsOf<3> options{.damping_share = solid_damping_share,
                                     .friction = c.contact.friction,
                                     .wall_friction = c.contact.wall_friction,
                                     .damping = c.mpm.damping};
  ExplicitStep<3> dynamics(std::move(grains), box, options);
  return {std::make_unique<ElasticGrains<ExplicitStep<3>>>(std::move(dynamics)), std::move(box), dt};
}

}  // namespace softgrain
