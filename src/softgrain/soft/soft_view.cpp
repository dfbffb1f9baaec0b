#include "softgrain/soft/soft_view.hpp"

#include <algorithm>
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/soft/contact_lists.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/history.hpp"
#include "softgrain/soft/solid_equilibrium.hpp"

namespace softgrain {

std::vector<ContactPoint> contact_points(const SoftView& view) {
  const SoftGrains& grains = view.grains;
  std::vector<Vec<2>> x;
  grains.gather_outline(x);
  std::vector<ContactPoint> points;
  for (std::size_t c = 0; c < view.contacts.size(); ++c) {
    const OutlineContact& contact = view.contacts[c];
    const bool touches = view.impulse[c][0] > 0,
               attracts = !view.attraction.empty() && view.attraction[c] > 0;
    if (!touches && !attracts) continue;
    const int v = contact.vertex, g = grains.grain_of_vertex(v), begin = grains.outline_begin(g),
              n = grains.outline_end(g) - begin;
    const Vec<2>&before = x[begin + (v - begin + n - 1) % n], &after = x[begin + (v - begin + 1) % n];
    const bool wall = contact.wall >= 0;
    Vec<2> place = contact.slave_at(x);
    if (wall)
      place +=
          0.5 * contact.share * (x[contact.master[2]] - x[contact.master[0]]) + contact.rise * contact.normal;
    Vec<2> felt = view.impulse[c];
    if (attracts) felt[0] -= view.attraction[c];
    const double share = !touches ? 0 : wall ? 0.5 : 0.25;
    points.push_back({.a = g,
                      .b = wall ? wall_index(contact.wall) : grains.grain_of_vertex(contact.master[0]),
                      .force = (-1 / view.impulse_time) * impulse_vector(contact, felt),
                      .normal = -contact.normal,
                      .position = place,
                      .length = share * (norm(x[v] - before) + norm(x[v] - after)),
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
  std::size_t count = 0;
  for (int g = 0; g < grains.size(); ++g) count += static_cast<std::size_t>(grains.topology(g).grid.nodes());
  nodes.mass.reserve(count), nodes.velocity.reserve(count), nodes.grain.reserve(count);
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
  std::vector<Wide> elastic(grains.batches.size());
  parallel_for(static_cast<int>(elastic.size()),
               [&](int b) { elastic[b] = elastic_energy(grains, grains.batches[b]); });
  double energy = 0;
  for (std::size_t b = 0; b < elastic.size(); ++b) {
    const BatchOf<Dim>& batch = grains.batches[b];
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) energy += elastic[b][lane];
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
  std::size_t numbers = 0;
  for (const Batch& batch : grains.batches) numbers += batch.position.size() * Dim * Wide::size;
  const auto declare = [&](const Field& field, WidePlaces<Dim> Batch::*nodes) {
    std::vector<double> values;
    values.reserve(numbers);
    for (const Batch& batch : grains.batches)
      for (const Vec<Dim, Wide>& v : batch.*nodes)
        for (int d = 0; d < Dim; ++d)
          for (int lane = 0; lane < Wide::size; ++lane) values.push_back(v[d][lane]);
    visit.rows(field, values, Wide::size);
    if (!visit.reads()) return;
    const double* value = values.data();
    for (Batch& batch : grains.batches)
      for (Vec<Dim, Wide>& v : batch.*nodes)
        for (int d = 0; d < Dim; ++d, value += Wide::size) v[d] = load_wide(value);
  };
  declare({"position", "m", Owner::node, Role::state, "x, then y (and z) of each node of eight grains"},
          &Batch::position);
  declare({"velocity", "m/s", Owner::node, Role::state, "the same of their velocities"}, &Batch::velocity);
  visit_history(grains, visit);
}

namespace {

constexpr std::size_t bodies_of_contact = 6;

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
  visit_contact_lists(visit, bodies, bodies_of_contact, places);
  if (repeats) visit_contact_images(visit, images);
  if (rigid)
    visit.list({"contact_arc", "", Owner::contact, Role::start,
                "where on the arc of a rigid slave: along it, and inwards; 0 where it is the vertex"},
               arcs);
  visit.list({"contact_impulse", "N s/m", Owner::contact, Role::start, "(p_n, p_t)"}, impulse);
  if (!visit.reads()) return;
  check_contact_bodies(bodies, bodies_of_contact, 1,
                       [&](std::size_t k) { return k == 1 ? walls : grains.outline_size(); });
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

void visit_attraction(std::size_t contacts, std::vector<double>& attraction, double& energy, double& gained,
                      StateVisitor& visit) {
  std::vector<Vec<1>> values;
  for (const double a : attraction) values.push_back({a});
  visit.list(
      {"contact_attraction", "N s/m", Owner::contact, Role::start, "what surfaces that adhere pull with"},
      values);
  visit({"adhesion_energy", "J/m", Owner::run, Role::state, "of surfaces that adhere"}, energy);
  visit({"work_of_adhesion", "J/m", Owner::run, Role::sum, "by which that grew"}, gained);
  if (!visit.reads()) return;
  if (values.size() != contacts) throw IoError("the snapshot's arrays of contacts have different lengths");
  attraction.clear();
  for (const Vec<1>& a : values) attraction.push_back(a[0]);
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
