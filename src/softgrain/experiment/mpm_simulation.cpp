#include "softgrain/experiment/mpm_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/arrays.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/mpm/equilibrium.hpp"
#include "softgrain/observe/outlines.hpp"

namespace softgrain {
namespace {

enum WallIndex : int { bottom, top };

std::vector<int> outline_begins(const SoftGrains& grains) {
  std::vector<int> begin;
  for (int g = 0; g <= grains.size(); ++g)
    begin.push_back(g < grains.size() ? grains.outline_begin(g) : grains.outline_size());
  return begin;
}

}  // namespace

template <class Dynamics>
MpmSimulation<Dynamics>::MpmSimulation(Dynamics dynamics, std::unique_ptr<PlatePath> path, double dt)
    : dynamics_(std::move(dynamics)), path_(std::move(path)), dt_(dt), height_start_(plate_distance()) {}

template <class Dynamics>
double MpmSimulation<Dynamics>::plate_distance() const {
  return dynamics_.walls[top].point[1] - dynamics_.walls[bottom].point[1];
}

template <class Dynamics>
StepReport MpmSimulation<Dynamics>::step() {
  dynamics_.walls[top].velocity = {0, path_->plate_velocity(step_)};
  const SoftStepReport soft = dynamics_.step(dt_);
  ++step_;
  sums_.force_bottom -= dynamics_.wall_impulse(bottom)[1];
  sums_.force_top += dynamics_.wall_impulse(top)[1];
  sums_.duration += dt_;
  sums_.wall_work -= dot(dynamics_.wall_impulse(top), dynamics_.walls[top].velocity);
  sums_.iterations += soft.iterations;
  sums_.rejected += soft.rejected;
  return {.contacts = soft.contacts,
          .sweeps = soft.sweeps,
          .residual_mean = soft.residual,
          .residual_max = soft.residual,
          .overlap_mean = 0,
          .overlap_max = soft.penetration_max,
          .converged = soft.converged};
}

template <class Dynamics>
double MpmSimulation<Dynamics>::stored_energy() const {
  double energy = 0;
  for (const GrainBatch& batch : dynamics_.grains.batches) {
    const Wide elastic = elastic_energy(dynamics_.grains, batch);
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) energy += elastic[lane];
  }
  return energy;
}

template <class Dynamics>
std::vector<Quantity> MpmSimulation<Dynamics>::observe() {
  const SoftGrains& grains = dynamics_.grains;
  std::vector<Vec<2>> outline;
  grains.gather_outline(outline);
  double left = std::numeric_limits<double>::infinity(), right = -left, least_J = left;
  for (const Vec<2>& x : outline) left = std::min(left, x[0]), right = std::max(right, x[0]);
  double start_area = 0;
  for (int g = 0; g < grains.size(); ++g) {
    start_area += grains.mass(g) / grains.density;
    for (const PointState& point : point_states(grains, g)) least_J = std::min(least_J, determinant(point.F));
  }
  const bool box = dynamics_.walls.size() > 2;
  const double width = box ? dynamics_.walls[3].point[0] - dynamics_.walls[2].point[0] : right - left;
  const double height = plate_distance(), area = total_area(outline, outline_begins(grains));
  std::vector<std::pair<int, int>> pairs;
  int contacts = 0;
  for (std::size_t c = 0; c < dynamics_.contacts.size(); ++c) {
    const OutlineContact& contact = dynamics_.contacts[c];
    if (!(dynamics_.impulse[c][0] > 0)) continue;
    ++contacts;
    if (contact.wall < 0)
      pairs.emplace_back(grains.grain_of_vertex(contact.vertex), grains.grain_of_vertex(contact.master[0]));
  }
  const double duration = sums_.duration > 0 ? sums_.duration : dt_;
  const double force_bottom = sums_.force_bottom / duration, force_top = sums_.force_top / duration;
  const double kinetic = grains.kinetic_energy(), elastic = stored_energy();
  std::vector<Quantity> row{
      {"step", "", static_cast<double>(step_)},
      {"time", "s", time()},
      {"strain", "", path_->strain(height_start_, height)},
      {"leg", "", static_cast<double>(path_->leg(std::max<std::int64_t>(step_ - 1, 0)))},
      {"wall_height", "m", height},
      {"width", "m", width},
      {"stress_bottom", "Pa", force_bottom / width},
      {"stress_top", "Pa", force_top / width},
      {"force_bottom", "N/m", force_bottom},
      {"force_top", "N/m", force_top},
      {"contacts", "", static_cast<double>(contacts)},
      {"area_ratio", "", area / start_area},
      {"least_J", "", least_J},
      {"kinetic_energy", "J/m", kinetic},
      {"elastic_energy", "J/m", elastic},
      {"wall_work", "J/m", sums_.wall_work},
      {"dissipation", "J/m", sums_.wall_work - kinetic - elastic},
      {"iterations", "", sums_.iterations * dt_ / duration},
      {"rejected_steps", "", sums_.rejected},
  };
  if (box) {
    row.push_back({"phi_0", "", start_area / (width * height)});
    row.push_back({"phi", "", area / (width * height)});
    row.push_back({"z", "", coordination_number(std::move(pairs), grains.size())});
  }
  sums_.force_bottom = sums_.force_top = sums_.duration = sums_.iterations = 0;
  return row;
}

/// Material points as disks of their present area, and the outlines.
template <class Dynamics>
Scene MpmSimulation<Dynamics>::scene() const {
  const SoftGrains& grains = dynamics_.grains;
  std::vector<Vec<2>> position;
  std::vector<double> radius, pressure, dilatation, stress;
  std::vector<std::int64_t> grain_of_point, grain_of_vertex;
  for (int g = 0; g < grains.size(); ++g) {
    const Topology& shape = grains.topology(g);
    const std::vector<PointState> states = point_states(grains, g);
    for (std::size_t p = 0; p < states.size(); ++p) {
      Vec<2> x;
      for (int a = 0; a < 4; ++a)
        x += shape.points[p].shape[a] * grains.node_position(g, shape.grid.cell[p / 4][a]);
      const double J = determinant(states[p].F);
      position.push_back(x);
      radius.push_back(grains.radius(g) * std::sqrt(J * shape.points[p].volume / std::numbers::pi));
      pressure.push_back(states[p].pressure);
      dilatation.push_back(J);
      stress.insert(stress.end(), states[p].stress.c.begin(), states[p].stress.c.end());
      grain_of_point.push_back(g);
    }
    grain_of_vertex.insert(grain_of_vertex.end(), grains.outline_end(g) - grains.outline_begin(g), g);
  }
  std::vector<Vec<2>> outline, forces;
  grains.gather_outline(outline);
  forces = contact_forces(grains, dynamics_.contacts, dynamics_.impulse, dt_);
  Scene scene;
  scene.particles["position"] = to_array<2>(position);
  scene.particles["radius"] = {1, std::move(radius)};
  scene.particles["pressure"] = {1, std::move(pressure)};
  scene.particles["J"] = {1, std::move(dilatation)};
  scene.particles["stress"] = {4, std::move(stress)};
  scene.particles["grain"] = {1, std::move(grain_of_point)};
  scene.outlines["position"] = to_array<2>(outline);
  scene.outlines["force"] = to_array<2>(forces);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  const auto& walls = dynamics_.walls;
  const double low = walls[bottom].point[1], high = walls[top].point[1];
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (const Vec<2>& x : outline) left = std::min(left, x[0]), right = std::max(right, x[0]);
  if (walls.size() > 2) {
    left = walls[2].point[0], right = walls[3].point[0];
    scene.wall_segments = {left, low, left, high, right, low, right, high};
  } else {
    const double margin = 0.1 * (right - left);
    left -= margin, right += margin;
  }
  scene.wall_segments.insert(scene.wall_segments.end(), {left, low, right, low, left, high, right, high});
  return scene;
}

template <class Dynamics>
Checkpoint MpmSimulation<Dynamics>::checkpoint() const {
  Checkpoint state{.step = step_, .time = time(), .arrays = {}};
  std::vector<double> position, velocity;
  for (const GrainBatch& batch : dynamics_.grains.batches)
    for (std::size_t i = 0; i < batch.position.size(); ++i)
      for (int d = 0; d < 2; ++d)
        for (int lane = 0; lane < Wide::size; ++lane) {
          position.push_back(batch.position[i][d][lane]);
          velocity.push_back(batch.velocity[i][d][lane]);
        }
  state.arrays["position"] = {Wide::size, std::move(position)};
  state.arrays["velocity"] = {Wide::size, std::move(velocity)};
  std::vector<std::int64_t> bodies;
  std::vector<double> places;
  for (const OutlineContact& c : dynamics_.contacts) {
    bodies.insert(bodies.end(), {c.vertex, c.wall});
    bodies.insert(bodies.end(), c.master.begin(), c.master.end());
    places.insert(places.end(), {c.share, c.normal[0], c.normal[1], c.gap, c.slip});
  }
  state.arrays["contact_bodies"] = {6, std::move(bodies)};
  state.arrays["contact_places"] = {5, std::move(places)};
  state.arrays["contact_impulse"] = to_array<2>(dynamics_.impulse);
  std::vector<Vec<2>> wall_point;
  for (const Wall<2>& wall : dynamics_.walls) wall_point.push_back(wall.point);
  state.arrays["wall_point"] = to_array<2>(wall_point);
  state.arrays["sums"] = {1, std::vector<double>{sums_.force_bottom, sums_.force_top, sums_.duration,
                                                 sums_.wall_work, sums_.iterations, sums_.rejected}};
  return state;
}

template <class Dynamics>
void MpmSimulation<Dynamics>::restore(const Checkpoint& state) {
  std::size_t nodes = 0;
  for (const GrainBatch& batch : dynamics_.grains.batches) nodes += batch.position.size();
  std::vector<Vec<2 * Wide::size>> position(nodes), velocity(nodes);
  from_array<2 * Wide::size>(state, "position", position);
  from_array<2 * Wide::size>(state, "velocity", velocity);
  std::size_t node = 0;
  for (GrainBatch& batch : dynamics_.grains.batches)
    for (std::size_t i = 0; i < batch.position.size(); ++i, ++node)
      for (int d = 0; d < 2; ++d)
        for (int lane = 0; lane < Wide::size; ++lane) {
          batch.position[i][d].set(lane, position[node][Wide::size * d + lane]);
          batch.velocity[i][d].set(lane, velocity[node][Wide::size * d + lane]);
        }
  const auto bodies = state.arrays.find("contact_bodies");
  const auto* numbers =
      bodies == state.arrays.end() ? nullptr : std::get_if<std::vector<std::int64_t>>(&bodies->second.values);
  if (numbers == nullptr)
    throw IoError("the checkpoint has no array 'contact_bodies': it belongs to another case");
  const std::size_t count = numbers->size() / 6;
  std::vector<Vec<5>> places(count);
  from_array<5>(state, "contact_places", places);
  dynamics_.contacts.clear();
  for (std::size_t c = 0; c < count; ++c) {
    const auto body = [&](std::size_t k) { return static_cast<int>((*numbers)[6 * c + k]); };
    dynamics_.contacts.push_back({.vertex = body(0),
                                  .wall = body(1),
                                  .master = {body(2), body(3), body(4), body(5)},
                                  .share = places[c][0],
                                  .normal = {places[c][1], places[c][2]},
                                  .gap = places[c][3],
                                  .slip = places[c][4]});
  }
  dynamics_.impulse.resize(count);
  from_array<2>(state, "contact_impulse", dynamics_.impulse);
  std::vector<Vec<2>> wall_point(dynamics_.walls.size());
  from_array<2>(state, "wall_point", wall_point);
  for (std::size_t w = 0; w < wall_point.size(); ++w) dynamics_.walls[w].point = wall_point[w];
  std::vector<Vec<1>> sums(6);
  from_array<1>(state, "sums", sums);
  sums_ = {sums[0][0], sums[1][0], sums[2][0], sums[3][0], sums[4][0], sums[5][0]};
  step_ = state.step;
}

template class MpmSimulation<ImplicitDynamics>;
template class MpmSimulation<ExplicitDynamics>;

}  // namespace softgrain
