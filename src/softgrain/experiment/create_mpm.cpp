#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/diametral_path.hpp"
#include "softgrain/experiment/isotropic_path.hpp"
#include "softgrain/experiment/mpm_simulation.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/experiment/updated_lagrangian_simulation.hpp"

namespace softgrain {
namespace {

/// Of an explicit step: the mesh's own vibrations are damped.
constexpr double damping_share = 0.5;

/// What both integrators need: grains and walls.
struct MpmSetup {
  std::vector<GrainPlacement> grains;
  std::vector<Wall<2>> walls;
};

MpmSetup setup_of(const Case& c) {
  const auto shape = std::make_shared<const Topology>(disk_grid(c.mpm.cells));
  MpmSetup setup;
  if (c.experiment.loading == LoadingPath::diametral) {
    setup.grains.push_back(
        {.topology = shape, .radius = c.grain.radius, .centre = {}, .angle = 0, .velocity = {}});
    double reach = 0;  // of the circle through the vertices, which plates meet
    for (const Vec<2>& X : shape->grid.outline()) reach = std::max(reach, norm(X) * c.grain.radius);
    setup.walls = {{.point = {0, -reach}, .normal = {0, 1}, .velocity = {}},
                   {.point = {0, reach}, .normal = {0, -1}, .velocity = {}}};
    return setup;
  }
  const BoxSample sample = sample_box(c);
  for (const PlacedGrain& grain : sample.grains)
    setup.grains.push_back({.topology = shape,
                            .radius = grain.radius,
                            .centre = grain.centre,
                            .angle = grain.angle,
                            .velocity = {}});
  setup.walls = {{.point = {0, 0}, .normal = {0, 1}, .velocity = {}},
                 {.point = {0, sample.height}, .normal = {0, -1}, .velocity = {}},
                 {.point = {0, 0}, .normal = {1, 0}, .velocity = {}},
                 {.point = {sample.width, 0}, .normal = {-1, 0}, .velocity = {}}};
  return setup;
}

SoftGrains grains_of(const Case& c, std::vector<GrainPlacement> placed) {
  return {std::move(placed), make_law(c.mpm.law, c.mpm.young_modulus, c.mpm.poisson_ratio), c.grain.density};
}

WallDrive drive_of(const Case& c, double height, double dt) {
  if (c.experiment.loading == LoadingPath::diametral)
    return {c.loading, std::make_unique<DiametralPath>(c.loading, c.grain.radius, dt), dt};
  return {c.loading, box_path(c, height, dt), dt};
}

/// Speed of pressure waves in a grain [m/s].
double wave_speed(const SoftGrains& grains) {
  return std::visit([&](const auto& law) { return law.wave_speed(grains.density); }, grains.law);
}

/// The damper takes up the waves that come to a plate, Z = rho c; as far as backward Euler's steps, longer
/// than a wave needs through the box, do not damp them anyway.
PlateBody implicit_plates(const SoftGrains& grains, double height, double dt) {
  const double c = wave_speed(grains);
  return {.damper = grains.density * c * std::max(0.0, 1 - c * dt / height)};
}

/// The mass is that of an eighth of a full box: less, and the stress of a step shakes the plate.
PlateBody explicit_plates(const SoftGrains& grains, double height) {
  const double c = wave_speed(grains);
  return {.mass = grains.density * height / 8, .damper = grains.density * c, .patience = height / c};
}

/// Of Newton's method, so that what it leaves of a stress that is kept is small.
double tolerance_of(const Case& c, const SoftGrains& grains, double height) {
  if (c.loading.hold_stress == 0) return c.mpm.tolerance;
  constexpr double share = 0.01;  // of the stress
  const double wave = wave_speed(grains), modulus = grains.density * wave * wave;
  return std::min(c.mpm.tolerance, share * c.loading.hold_stress / modulus * height / grains.radius(0));
}

}  // namespace

double longest_time_step(const Case& c) {
  constexpr double no_limit = std::numeric_limits<double>::infinity();
  if (c.experiment.model != GrainModel::mpm) return no_limit;
  if (c.mpm.formulation == Formulation::updated_lagrangian)
    return UpdatedLagrangianSimulation::longest_time_step(c);
  if (c.mpm.integrator != Integrator::symplectic_euler) return no_limit;
  const double radius =
      c.experiment.loading == LoadingPath::diametral ? c.grain.radius : c.sample.smallest_diameter / 2;
  const SoftGrains smallest =
      grains_of(c, {{.topology = std::make_shared<const Topology>(disk_grid(c.mpm.cells)),
                     .radius = radius,
                     .centre = {},
                     .angle = 0,
                     .velocity = {}}});
  return longest_stable_step(smallest, damping_share);
}

void check_time_step(const Case& c) {
  if (c.time.step == 0 || c.experiment.model != GrainModel::mpm) return;
  const double longest = longest_time_step(c);
  require(c.time.step <= longest,
          "time.step {:.4g} us is beyond the longest stable step of an explicit run of this case, "
          "{:.4g} us; give at most that, or \"auto\"",
          1e6 * c.time.step, 1e6 * longest);
}

std::unique_ptr<Simulation> create_mpm_simulation(const Case& c) {
  check_time_step(c);
  if (c.mpm.formulation == Formulation::updated_lagrangian)
    return std::make_unique<UpdatedLagrangianSimulation>(c);
  MpmSetup setup = setup_of(c);
  double smallest = setup.grains.front().radius;
  for (const GrainPlacement& grain : setup.grains) smallest = std::min(smallest, grain.radius);
  SoftGrains grains = grains_of(c, std::move(setup.grains));
  const double height = setup.walls[top_wall].point[1] - setup.walls[bottom_wall].point[1];
  if (c.mpm.integrator == Integrator::backward_euler) {
    // the lid goes down by 1 % of the smallest radius, at most, in a step
    const double dt = c.time.step > 0 ? c.time.step : 0.01 * smallest / c.loading.wall_velocity;
    ImplicitOptions options{.tolerance = tolerance_of(c, grains, height),
                            .friction = c.contact.friction,
                            .wall_friction = c.contact.wall_friction,
                            .damping = c.mpm.damping};
    WallDrive drive = drive_of(c, height, dt);
    drive.plates = implicit_plates(grains, height, dt);
    return std::make_unique<MpmSimulation<ImplicitDynamics>>(
        ImplicitDynamics(std::move(grains), std::move(setup.walls), options), std::move(drive), dt);
  }
  const double dt = c.time.step > 0 ? c.time.step : stable_time_step(grains);
  ExplicitOptions options{.damping_share = damping_share,
                          .friction = c.contact.friction,
                          .wall_friction = c.contact.wall_friction,
                          .damping = c.mpm.damping};
  WallDrive drive = drive_of(c, height, dt);
  drive.plates = explicit_plates(grains, height);
  return std::make_unique<MpmSimulation<ExplicitDynamics>>(
      ExplicitDynamics(std::move(grains), std::move(setup.walls), options), std::move(drive), dt);
}

}  // namespace softgrain
