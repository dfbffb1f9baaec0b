#include "softgrain/experiment/updated_lagrangian_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/arrays.hpp"
#include "softgrain/experiment/diametral_path.hpp"
#include "softgrain/experiment/given_path.hpp"
#include "softgrain/experiment/soft_view.hpp"
#include "softgrain/experiment/words.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {
namespace {

double cell_of(const Case& c) {
  return c.grain.radius * std::sqrt(std::numbers::pi / 3.5) / c.mpm.cells;  // 14 cells^2 points, 4 to a cell
}

UpdatedLagrangianDynamics dynamics_of(const Case& c) {
  require(c.experiment.loading == LoadingPath::diametral,
          "mpm.formulation 'updated_lagrangian' needs experiment.loading 'diametral', got '{}'",
          word_of(c.experiment.loading));
  const double R = c.grain.radius;
  const double cell = cell_of(c);
  PointGrain grain = disk_of_points(R, {}, cell, 8 * c.mpm.cells);
  double reach = 0;  // the outline is symmetric about both axes
  for (const Vec<2>& x : grain.outline) reach = std::max(reach, x[1]);
  return {{std::move(grain)},
          {{.point = {0, -reach}, .normal = {0, 1}, .velocity = {}},
           {.point = {0, reach}, .normal = {0, -1}, .velocity = {}}},
          make_law(c.mpm.law, c.mpm.young_modulus, c.mpm.poisson_ratio),
          c.grain.density,
          {.shape = c.mpm.shape_functions,
           .contact_on = c.mpm.contact_on,
           .cell = cell,
           .friction = c.contact.friction,
           .wall_friction = c.contact.wall_friction,
           .damping = c.mpm.damping}};
}

double time_step_of(const Case& c, const UpdatedLagrangianDynamics& dynamics) {
  if (c.time.step > 0) return c.time.step;
  return stable_time_step(dynamics.law, dynamics.density, dynamics.options.cell);
}

/// Smallest and largest x of an outline [m].
std::pair<double, double> extent(const PointGrain& grain) {
  const auto [left, right] = std::minmax_element(grain.outline.begin(), grain.outline.end(),
                                                 [](const auto& a, const auto& b) { return a[0] < b[0]; });
  return {(*left)[0], (*right)[0]};
}

std::vector<Vec<4>> components(std::span<const Mat<2>> tensors) {
  std::vector<Vec<4>> rows;
  for (const Mat<2>& tensor : tensors) rows.push_back({tensor.c});
  return rows;
}

}  // namespace

UpdatedLagrangianSimulation::UpdatedLagrangianSimulation(const Case& c)
    : dynamics_(dynamics_of(c)),
      dt_(time_step_of(c, dynamics_)),
      path_(std::make_unique<DiametralPath>(c.loading, c.grain.radius, dt_)),
      height_start_(plate_distance()) {}

double UpdatedLagrangianSimulation::longest_time_step(const Case& c) {
  return stable_time_step(make_law(c.mpm.law, c.mpm.young_modulus, c.mpm.poisson_ratio), c.grain.density,
                          cell_of(c), 0.2 * (1 + 1e-9));
}

double UpdatedLagrangianSimulation::plate_distance() const {
  return dynamics_.walls[top_wall].point[1] - dynamics_.walls[bottom_wall].point[1];
}

void UpdatedLagrangianSimulation::follow(PlateMotion motion) {
  path_ = std::make_unique<GivenPath>(std::move(path_), std::move(motion), dt_);
}

StepReport UpdatedLagrangianSimulation::step() {
  dynamics_.walls[top_wall].velocity = {0, path_->plate_velocity(step_, height_start_ - plate_distance())};
  const SoftStepReport soft = dynamics_.step(dt_);
  ++step_;
  sums_.force_bottom -= dynamics_.wall_impulse(bottom_wall)[1];
  sums_.force_top += dynamics_.wall_impulse(top_wall)[1];
  sums_.duration += dt_;
  return {.contacts = soft.contacts,
          .sweeps = soft.sweeps,
          .residual_mean = soft.residual_mean,
          .residual_max = soft.residual,
          .residual_limit = dynamics_.options.solver.worst_factor * dynamics_.options.solver.tolerance,
          .overlap_mean = 0,
          .overlap_max = soft.penetration_max,
          .converged = soft.converged};
}

std::vector<Quantity> UpdatedLagrangianSimulation::observe() {
  const auto [left, right] = extent(grain());
  double least_J = std::numeric_limits<double>::infinity();
  for (const Mat<2>& F : grain().F) least_J = std::min(least_J, determinant(F));
  const auto contacts = std::count_if(dynamics_.impulse.begin(), dynamics_.impulse.end(),
                                      [](const auto& p) { return p[0] > 0; });
  const double duration = sums_.duration > 0 ? sums_.duration : dt_;
  const double force_bottom = sums_.force_bottom / duration, force_top = sums_.force_top / duration;
  sums_.force_bottom = sums_.force_top = sums_.duration = 0;
  std::vector<Quantity> row{
      {"step", "", static_cast<double>(step_)},
      {"time", "s", time()},
      {"strain", "", strain()},
      {"leg", "", static_cast<double>(path_->leg(std::max<std::int64_t>(step_ - 1, 0)))},
      {"wall_height", "m", plate_distance()},
      {"width", "m", right - left},
      {"stress_bottom", "Pa", force_bottom / (right - left)},
      {"stress_top", "Pa", force_top / (right - left)},
      {"force_bottom", "N/m", force_bottom},
      {"force_top", "N/m", force_top},
      {"contacts", "", static_cast<double>(contacts)},
      {"area_ratio", "", polygon_area(grain().outline) / grain().area()},
      {"least_J", "", least_J},
  };
  const std::vector<Quantity> energies =
      soft_energies(dynamics_.work, grain().kinetic_energy(dynamics_.density), dynamics_.elastic_energy());
  row.insert(row.end(), energies.begin(), energies.end());
  return row;
}

Scene UpdatedLagrangianSimulation::scene() const {
  std::vector<double> radius, pressure, dilatation;
  std::vector<Mat<2>> stress;
  for (int p = 0; p < grain().points(); ++p) {
    dilatation.push_back(determinant(grain().F[p]));
    radius.push_back(std::sqrt(dilatation.back() * grain().volume[p] / std::numbers::pi));
    stress.push_back(dynamics_.stress(0, p));
    pressure.push_back(-trace(stress.back()) / 2);
  }
  std::vector<Vec<2>> force(grain().outline.size());  // zero for contact on nodes
  std::vector<ContactPoint> points;
  for (std::size_t c = 0; c < dynamics_.contacts.size(); ++c) {
    const LatticeContact& contact = dynamics_.contacts[c];
    const Vec<2>& n = contact.normal;
    const Vec<2>& p = dynamics_.impulse[c];
    if (contact.vertex < 0) continue;
    const Vec<2> F = 1 / dt_ * (p[0] * n + p[1] * perpendicular(n));
    force[contact.vertex] += F;
    points.push_back({.a = 0,
                      .b = wall_index(contact.wall),
                      .force = -F,
                      .normal = -n,
                      .position = grain().outline[contact.vertex]});
  }
  Scene scene;
  scene.particles["position"] = to_array<2>(grain().position);
  scene.particles["radius"] = {1, std::move(radius)};
  scene.particles["pressure"] = {1, std::move(pressure)};
  scene.particles["J"] = {1, std::move(dilatation)};
  scene.particles["stress"] = to_array<4>(components(stress));
  scene.particles["grain"] = {1, std::vector<std::int64_t>(grain().position.size(), 0)};
  scene.outlines["position"] = to_array<2>(grain().outline);
  scene.outlines["force"] = to_array<2>(force);
  scene.outlines["grain"] = {1, std::vector<std::int64_t>(grain().outline.size(), 0)};
  scene.contacts = grain_contacts(points, 1);
  const auto [left, right] = extent(grain());
  const double margin = 0.1 * (right - left);
  for (const BoxWall w : {bottom_wall, top_wall}) {
    const double y = dynamics_.walls[w].point[1];
    scene.wall_segments.insert(scene.wall_segments.end(), {left - margin, y, right + margin, y});
  }
  return scene;
}

std::vector<GrainView> UpdatedLagrangianSimulation::grains() const {
  const auto view = [](const std::vector<Vec<2>>& vectors) {
    return VectorView{.begin = vectors.front().c.data(), .rows = vectors.size()};
  };
  return {{.position = view(grain().position),
           .velocity = view(grain().velocity),
           .outline = view(grain().outline)}};
}

Checkpoint UpdatedLagrangianSimulation::checkpoint() const {
  Checkpoint state{.step = step_, .time = time(), .arrays = {}};
  state.arrays["position"] = to_array<2>(grain().position);
  state.arrays["velocity"] = to_array<2>(grain().velocity);
  state.arrays["deformation_gradient"] = to_array<4>(components(grain().F));
  state.arrays["outline"] = to_array<2>(grain().outline);
  const std::vector<Vec<2>> points{dynamics_.walls[bottom_wall].point, dynamics_.walls[top_wall].point};
  state.arrays["wall_point"] = to_array<2>(points);
  const WorkBudget& work = dynamics_.work;
  state.arrays["sums"] = {
      1, std::vector<double>{sums_.force_bottom, sums_.force_top, sums_.duration, work.walls, work.internal,
                             work.contacts, work.friction, work.damping}};
  return state;
}

void UpdatedLagrangianSimulation::restore(const Checkpoint& state) {
  PointGrain& grain = dynamics_.grains.front();
  std::vector<Vec<4>> F(grain.F.size());
  std::vector<Vec<2>> wall_point(2);
  std::vector<Vec<1>> sums(8);
  from_array<2>(state, "position", grain.position);
  from_array<2>(state, "velocity", grain.velocity);
  from_array<4>(state, "deformation_gradient", F);
  from_array<2>(state, "outline", grain.outline);
  from_array<2>(state, "wall_point", wall_point);
  from_array<1>(state, "sums", sums);
  for (std::size_t p = 0; p < F.size(); ++p) grain.F[p] = {F[p].c};
  for (const BoxWall w : {bottom_wall, top_wall}) dynamics_.walls[w].point = wall_point[w];
  sums_ = {sums[0][0], sums[1][0], sums[2][0]};
  dynamics_.work = {.walls = sums[3][0],
                    .internal = sums[4][0],
                    .contacts = sums[5][0],
                    .friction = sums[6][0],
                    .damping = sums[7][0]};
  step_ = state.step;
}

}  // namespace softgrain
