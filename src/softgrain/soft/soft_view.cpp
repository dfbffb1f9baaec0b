#include "softgrain/soft/soft_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/soft/elastic_contacts.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/history.hpp"
#include "softgrain/soft/point_states.hpp"
#include "softgrain/soft/solid_equilibrium.hpp"

namespace softgrain {

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
    Vec<2> place = contact.slave_at(x);
    if (wall)
      place +=
          0.5 * contact.share * (x[contact.master[2]] - x[contact.master[0]]) + contact.rise * contact.normal;
    points.push_back({.a = g,
                      .b = wall ? wall_index(contact.wall) : grains.grain_of_vertex(contact.master[0]),
                      .force = (-1 / view.impulse_time) * impulse_vector(contact, view.impulse[c]),
                      .normal = -contact.normal,
                      .position = place,
                      .length = (wall ? 0.5 : 0.25) * (norm(x[v] - before) + norm(x[v] - after)),
                      .image = contact.image});
  }
  return points;
}

Outlines outlines_of(const SoftGrains& grains) {
  Outlines all;
  grains.gather_outline(all.vertex);
  for (int g = 0; g < grains.size(); ++g) {
    const int begin = grains.outline_begin(g), end = grains.outline_end(g);
    all.begin.push_back(begin);
    all.area +=
        grains.topology(g).grid.fullness * polygon_area(std::span(all.vertex).subspan(begin, end - begin));
  }
  all.begin.push_back(grains.outline_size());
  return all;
}

template <int Dim>
BodiesOf<Dim> nodes_of(const GrainsOf<Dim>& grains) {
  BodiesOf<Dim> nodes;
  for (int g = 0; g < grains.size(); ++g) {
    const auto [batch, lane] = grains.batch_of(g);
    for (int i = 0; i < grains.topology(g).grid.nodes(); ++i) {
      nodes.mass.push_back(grains.node_mass(*batch, i)[lane]);
      nodes.velocity.push_back(lane_of(batch->velocity[i], lane));
      nodes.grain.push_back(g);
    }
  }
  return nodes;
}

template <int Dim>
std::vector<Vec<Dim>> centres_of(const GrainsOf<Dim>& grains) {
  std::vector<Vec<Dim>> centre(grains.size());
  for (const BatchOf<Dim>& batch : grains.batches) {
    const Vec<Dim, Wide> x = centre_of_mass(grains, batch, batch.position);
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      centre[batch.grain[lane]] = lane_of(x, lane);
  }
  return centre;
}

template <int Dim>
double stored_energy(const GrainsOf<Dim>& grains) {
  double energy = 0;
  for (const BatchOf<Dim>& batch : grains.batches) {
    const Wide elastic = elastic_energy(grains, batch);
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) energy += elastic[lane];
  }
  return energy;
}

template <int Dim>
double least_J(const GrainsOf<Dim>& grains) {
  double least = std::numeric_limits<double>::infinity();
  for (const BatchOf<Dim>& batch : grains.batches) {
    const Wide J = least_J(batch);
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) least = std::min(least, J[lane]);
  }
  return least;
}

namespace {

/// Of a rigid grain: four points about its centre, as those of a cell are, that share its area and the mean
/// stress of its contacts, A^-1 sum (x - x_c) (x) f. force: on the outline's vertices [N/m].
struct RigidPoints {
  std::array<Vec<2>, 4> position;
  double radius = 0;
  Mat<2> stress;
};
RigidPoints rigid_points(const SoftGrains& grains, int g, std::span<const Vec<2>> outline,
                         std::span<const Vec<2>> force) {
  const Topology& shape = grains.topology(g);
  const double R = grains.radius(g), area = shape.area * R * R;
  const Vec<2> centre = grains.node_position(g, 0);
  RigidPoints points{.position = {}, .radius = std::sqrt(area / 4 / std::numbers::pi), .stress = {}};
  double least = R;
  for (int v = grains.outline_begin(g); v < grains.outline_end(g); ++v) {
    const Vec<2> r = outline[v] - centre;
    least = std::min(least, norm(r));
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) points.stress(i, j) += r[i] * force[v][j] / area;
  }
  const double away = least / std::sqrt(6.0);  // of a square within: 1/sqrt(2), its Gauss points 1/sqrt(3)
  points.position = {centre + Vec<2>{-away, -away}, centre + Vec<2>{away, -away},
                     centre + Vec<2>{-away, away}, centre + Vec<2>{away, away}};
  return points;
}

}  // namespace

Scene soft_scene(const SoftView& view) {
  const SoftGrains& grains = view.grains;
  std::vector<Vec<2>> position;
  std::vector<double> radius, pressure, dilatation, stress, von_mises, plastic_strain;
  std::vector<std::int64_t> grain_of_point, grain_of_vertex;
  std::vector<Vec<2>> outline;
  grains.gather_outline(outline);
  const std::vector<Vec<2>> forces = contact_forces(grains, view.contacts, view.impulse, view.impulse_time);
  for (int g = 0; g < grains.size(); ++g) {
    const Topology& shape = grains.topology(g);
    grain_of_vertex.insert(grain_of_vertex.end(), grains.outline_end(g) - grains.outline_begin(g), g);
    if (shape.rigid()) {
      const RigidPoints points = rigid_points(grains, g, outline, forces);
      for (const Vec<2>& x : points.position) {
        position.push_back(x);
        radius.push_back(points.radius);
        pressure.push_back(-trace(points.stress) / 2);
        von_mises.push_back(0);
        plastic_strain.push_back(0);
        dilatation.push_back(1);
        stress.insert(stress.end(), points.stress.c.begin(), points.stress.c.end());
        grain_of_point.push_back(g);
      }
      continue;
    }
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
      von_mises.push_back(states[p].von_mises);
      plastic_strain.push_back(states[p].plastic_strain);
      dilatation.push_back(J);
      stress.insert(stress.end(), states[p].stress.c.begin(), states[p].stress.c.end());
      grain_of_point.push_back(g);
    }
  }
  Scene scene;
  scene.particles["position"] = to_array(position);
  scene.particles["radius"] = {1, std::move(radius)};
  scene.particles["pressure"] = {1, std::move(pressure)};
  scene.particles["J"] = {1, std::move(dilatation)};
  scene.particles["stress"] = {4, std::move(stress)};
  if (grains.has_history()) {
    scene.particles["von_mises_stress"] = {1, std::move(von_mises)};
    scene.particles["plastic_strain"] = {1, std::move(plastic_strain)};
  }
  if (grains.kinds() > 1) {
    std::vector<std::int64_t> kind;
    for (const std::int64_t g : grain_of_point) kind.push_back(grains.kind(static_cast<int>(g)));
    scene.particles["kind"] = {1, std::move(kind)};
  }
  scene.particles["grain"] = {1, std::move(grain_of_point)};
  scene.outlines["position"] = to_array(outline);
  scene.outlines["force"] = to_array(forces);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  scene.contacts = grain_contacts(contact_points(view), grains.size());
  return scene;
}

template <int Dim>
std::vector<GrainView> grain_views(const GrainsOf<Dim>& grains) {
  static_assert(sizeof(Vec<Dim, Wide>) == Dim * Wide::size * sizeof(double));
  const auto in_lane = [](const WidePlaces<Dim>& nodes, int first, int lane) {
    return VectorView{.begin = reinterpret_cast<const double*>(&nodes[first]) + lane,
                      .rows = nodes.size() - static_cast<std::size_t>(first),
                      .row = Dim * Wide::size,
                      .component = Wide::size};
  };
  std::vector<GrainView> views;
  for (int g = 0; g < grains.size(); ++g) {
    const auto [batch, lane] = grains.batch_of(g);
    views.push_back({.position = in_lane(batch->position, 0, lane),
                     .velocity = in_lane(batch->velocity, 0, lane),
                     .outline = in_lane(batch->position, grains.topology(g).grid.outline_begin, lane)});
  }
  return views;
}

template <int Dim>
void visit_nodes(GrainsOf<Dim>& grains, StateVisitor& visit) {
  using Batch = BatchOf<Dim>;
  const auto declare = [&](const Field& field, WidePlaces<Dim> Batch::*nodes) {
    std::vector<double> values;
    for (const Batch& batch : grains.batches)
      for (const Vec<Dim, Wide>& v : batch.*nodes)
        for (int d = 0; d < Dim; ++d)
          for (int lane = 0; lane < Wide::size; ++lane) values.push_back(v[d][lane]);
    visit.rows(field, values, Wide::size);
    const double* value = values.data();
    for (Batch& batch : grains.batches)
      for (Vec<Dim, Wide>& v : batch.*nodes)
        for (int d = 0; d < Dim; ++d, value += Wide::size) v[d] = load_wide(value);
  };
  declare({"position", "m", Owner::node, Role::state, "x, then y (and z) of each node of eight grains"},
          &Batch::position);
  declare({"velocity", "m/s", Owner::node, Role::state, "the same of their velocities"}, &Batch::velocity);
  if constexpr (Dim == 2) visit_history(grains, visit);
}

namespace {

constexpr std::size_t bodies_of_contact = 6;

void check_bodies(std::span<const std::int64_t> bodies, int vertices, int walls) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool is_wall = i % bodies_of_contact == 1;
    if (bodies[i] < (is_wall ? -1 : 0) || bodies[i] >= (is_wall ? walls : vertices))
      throw IoError(fmt::format("the snapshot's array 'contact_bodies' holds {}", bodies[i]));
  }
}

}  // namespace

void visit_contacts(const SoftGrains& grains, int walls, bool repeats, std::vector<OutlineContact>& contacts,
                    std::vector<Vec<2>>& impulse, StateVisitor& visit) {
  std::vector<std::int64_t> bodies;
  std::vector<Vec<5>> places;
  std::vector<Vec<2>> images, arcs;
  const bool rigid = grains.has_rigid();
  for (const OutlineContact& c : contacts) {
    if (rigid) arcs.push_back({c.along, c.inward});
    bodies.insert(bodies.end(), {c.vertex, c.wall});
    bodies.insert(bodies.end(), c.master.begin(), c.master.end());
    places.push_back({c.share, c.normal[0], c.normal[1], c.gap, c.slip});
    if (repeats) images.push_back(c.image);
  }
  visit.list(
      {"contact_bodies", "", Owner::contact, Role::start,
       "vertex, wall or -1, four master vertices; in space point, vertex, wall or -1, 16 of the patch"},
      bodies, bodies_of_contact);
  visit.list(
      {"contact_places", "", Owner::contact, Role::start,
       "share, normal (2), gap [m], slip [m]; in space normal (3), gap [m], weights of the patch (16)"},
      places);
  if (repeats)
    visit.list({"contact_image", "m", Owner::contact, Role::start, "from the master to where it is met"},
               images);
  if (rigid)
    visit.list({"contact_arc", "", Owner::contact, Role::start,
                "where on the arc of a rigid slave: along it, and inwards; 0 where it is the vertex"},
               arcs);
  visit.list({"contact_impulse", "N s/m", Owner::contact, Role::start, "(p_n, p_t)"}, impulse);
  if (!visit.reads()) return;
  check_bodies(bodies, grains.outline_size(), walls);
  if (places.size() != impulse.size() || (repeats && images.size() != impulse.size()) ||
      (rigid && arcs.size() != impulse.size()) || bodies.size() != bodies_of_contact * places.size())
    throw IoError("the snapshot's arrays of contacts have different lengths");
  contacts.clear();
  for (std::size_t c = 0; c < places.size(); ++c) {
    const auto body = [&](std::size_t k) { return static_cast<int>(bodies[bodies_of_contact * c + k]); };
    contacts.push_back({.vertex = body(0),
                        .wall = body(1),
                        .master = {body(2), body(3), body(4), body(5)},
                        .share = places[c][0],
                        .along = rigid ? arcs[c][0] : 0,
                        .inward = rigid ? arcs[c][1] : 0,
                        .beside = grains.beside(body(0)),
                        .normal = {places[c][1], places[c][2]},
                        .gap = places[c][3],
                        .slip = places[c][4],
                        .image = repeats ? images[c] : Vec<2>{}});
  }
}

template BodiesOf<2> nodes_of(const GrainsOf<2>&);
template std::vector<Vec<2>> centres_of(const GrainsOf<2>&);
template double stored_energy(const GrainsOf<2>&);
template double least_J(const GrainsOf<2>&);
template std::vector<GrainView> grain_views(const GrainsOf<2>&);
template void visit_nodes(GrainsOf<2>&, StateVisitor&);
template BodiesOf<3> nodes_of(const GrainsOf<3>&);
template std::vector<Vec<3>> centres_of(const GrainsOf<3>&);
template double stored_energy(const GrainsOf<3>&);
template double least_J(const GrainsOf<3>&);
template std::vector<GrainView> grain_views(const GrainsOf<3>&);
template void visit_nodes(GrainsOf<3>&, StateVisitor&);

}  // namespace softgrain
