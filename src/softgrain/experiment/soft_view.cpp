#include "softgrain/experiment/soft_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/experiment/arrays.hpp"
#include "softgrain/experiment/packing_row.hpp"
#include "softgrain/experiment/plate_path.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/mpm/elastic_contacts.hpp"
#include "softgrain/mpm/equilibrium.hpp"

namespace softgrain {

std::vector<int> outline_begins(const SoftGrains& grains) {
  std::vector<int> begin;
  for (int g = 0; g <= grains.size(); ++g)
    begin.push_back(g < grains.size() ? grains.outline_begin(g) : grains.outline_size());
  return begin;
}

std::vector<ContactPoint> contact_points(const SoftView& view) {
  const SoftGrains& grains = view.grains;
  std::vector<Vec<2>> x;
  grains.gather_outline(x);
  std::vector<ContactPoint> points;
  for (std::size_t c = 0; c < view.contacts.size(); ++c) {
    const OutlineContact& contact = view.contacts[c];
    if (!(view.impulse[c][0] > 0)) continue;
    const int v = contact.vertex, g = grains.grain_of_vertex(v), begin = grains.outline_begin(g),
              n = grains.outline_end(g) - begin;
    const Vec<2>&before = x[begin + (v - begin + n - 1) % n], &after = x[begin + (v - begin + 1) % n];
    const bool wall = contact.wall >= 0;
    Vec<2> place = x[v];
    if (wall)
      place +=
          0.5 * contact.share * (x[contact.master[2]] - x[contact.master[0]]) + contact.rise * contact.normal;
    points.push_back({.a = g,
                      .b = wall ? wall_index(contact.wall) : grains.grain_of_vertex(contact.master[0]),
                      .force = (-1 / view.impulse_time) * impulse_vector(contact, view.impulse[c]),
                      .normal = -contact.normal,
                      .position = place,
                      .length = (wall ? 0.5 : 0.25) * (norm(x[v] - before) + norm(x[v] - after))});
  }
  return points;
}

double grain_area(const SoftGrains& grains) {
  std::vector<Vec<2>> outline;
  grains.gather_outline(outline);
  double area = 0;
  for (int g = 0; g < grains.size(); ++g) {
    const int begin = grains.outline_begin(g), end = grains.outline_end(g);
    area += grains.topology(g).grid.fullness * polygon_area(std::span(outline).subspan(begin, end - begin));
  }
  return area;
}

std::vector<Quantity> soft_energies(const WorkBudget& work, double kinetic, double elastic) {
  const double by_integration = work.internal + work.inertia - elastic;
  return {
      {"kinetic_energy", "J/m", kinetic},
      {"elastic_energy", "J/m", elastic},
      {"wall_work", "J/m", work.walls},
      {"dissipation", "J/m", work.contacts + by_integration + work.damping},
      {"dissipation_contact", "J/m", work.contacts},
      {"dissipation_friction", "J/m", work.friction},
      {"dissipation_integration", "J/m", by_integration},
      {"dissipation_damping", "J/m", work.damping},
      {"energy_error", "J/m",
       work.walls + work.gravity - kinetic - work.internal - work.inertia - work.contacts - work.damping}};
}

std::vector<Quantity> soft_packing_row(const SoftView& view, double strain_rate) {
  const SoftGrains& grains = view.grains;
  std::vector<double> radius, mass;
  std::vector<Vec<2>> centre(grains.size()), velocity, outline;
  for (int g = 0; g < grains.size(); ++g) {
    radius.push_back(grains.radius(g));
    const auto [batch, lane] = grains.batch_of(g);
    for (int i = 0; i < grains.topology(g).grid.nodes(); ++i) {
      mass.push_back(grains.node_mass(*batch, i)[lane]);
      velocity.push_back({batch->velocity[i][0][lane], batch->velocity[i][1][lane]});
      centre[g] += (mass.back() / grains.mass(g)) * grains.node_position(g, i);
    }
  }
  grains.gather_outline(outline);
  const std::vector<int> begin = outline_begins(grains);
  const std::vector<ContactPoint> contacts = contact_points(view);
  return packing_row({.width = view.walls[right_wall].point[0] - view.walls[left_wall].point[0],
                      .height = view.walls[top_wall].point[1] - view.walls[bottom_wall].point[1],
                      .radius = radius,
                      .grain_area = grain_area(grains),
                      .centre = centre,
                      .outline = outline,
                      .outline_begin = begin,
                      .contacts = contacts,
                      .mass = mass,
                      .velocity = velocity,
                      .density = grains.density,
                      .strain_rate = strain_rate});
}

std::map<std::string, Array> grain_contacts(std::span<const ContactPoint> points, int grains) {
  const ContactNetwork network = contact_network(points, grains);
  std::vector<std::int64_t> pair;
  std::vector<double> force;
  std::vector<Vec<2>> total_force, normal, position;
  for (const auto* list : {&network.pairs, &network.walls})
    for (const GrainPair& p : *list) {
      pair.insert(pair.end(), {p.a, p.b >= 0 ? p.b : grains + wall_index(p.b)});  // its own inverse
      force.push_back(p.normal_force);
      total_force.push_back(p.force);
      normal.push_back(p.normal);
      position.push_back(p.position);
    }
  return {{"pair", {2, std::move(pair)}},
          {"force", {1, std::move(force)}},
          {"total_force", to_array<2>(total_force)},
          {"normal", to_array<2>(normal)},
          {"position", to_array<2>(position)}};
}

Scene soft_scene(const SoftView& view) {
  const SoftGrains& grains = view.grains;
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
      const double V = shape.grid.fullness * shape.points[p].volume;
      radius.push_back(grains.radius(g) * std::sqrt(J * V / std::numbers::pi));
      pressure.push_back(states[p].pressure);
      dilatation.push_back(J);
      stress.insert(stress.end(), states[p].stress.c.begin(), states[p].stress.c.end());
      grain_of_point.push_back(g);
    }
    grain_of_vertex.insert(grain_of_vertex.end(), grains.outline_end(g) - grains.outline_begin(g), g);
  }
  std::vector<Vec<2>> outline, forces;
  grains.gather_outline(outline);
  forces = contact_forces(grains, view.contacts, view.impulse, view.impulse_time);
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
  scene.contacts = grain_contacts(contact_points(view), grains.size());
  const auto& walls = view.walls;
  const double low = walls[bottom_wall].point[1], high = walls[top_wall].point[1];
  double begin = std::numeric_limits<double>::infinity(), end = -begin;
  for (const Vec<2>& x : outline) begin = std::min(begin, x[0]), end = std::max(end, x[0]);
  if (walls.size() > 2) {
    begin = walls[left_wall].point[0], end = walls[right_wall].point[0];
  } else {
    const double margin = 0.1 * (end - begin);
    begin -= margin, end += margin;
  }
  scene.wall_segments = {begin, low, end, low, begin, high, end, high};  // in the order of BoxWall
  if (walls.size() > 2)
    scene.wall_segments.insert(scene.wall_segments.end(), {begin, low, begin, high, end, low, end, high});
  return scene;
}

std::vector<GrainView> grain_views(const SoftGrains& grains) {
  static_assert(sizeof(Vec<2, Wide>) == 2 * Wide::size * sizeof(double));
  const auto lane_of = [](const WideVectors& nodes, int first, int lane) {
    return VectorView{.begin = reinterpret_cast<const double*>(&nodes[first]) + lane,
                      .rows = nodes.size() - static_cast<std::size_t>(first),
                      .row = 2 * Wide::size,
                      .component = Wide::size};
  };
  std::vector<GrainView> views;
  for (int g = 0; g < grains.size(); ++g) {
    const auto [batch, lane] = grains.batch_of(g);
    views.push_back({.position = lane_of(batch->position, 0, lane),
                     .velocity = lane_of(batch->velocity, 0, lane),
                     .outline = lane_of(batch->position, grains.topology(g).grid.outline_begin, lane)});
  }
  return views;
}

}  // namespace softgrain
