#include "softgrain/soft/surface_contacts.hpp"

#include <algorithm>

#include "softgrain/soft/near_vertices.hpp"
#include "softgrain/soft/sphere_contacts.hpp"

namespace softgrain {
namespace {

/// Those of a rigid sphere, by its centre, with rigid grains of other shapes.
void add_contacts_of_sphere(const Surfaces& surfaces, double margin, int centre,
                            std::vector<SurfaceContact>& contacts) {
  const SolidGrains& grains = surfaces.grains;
  const double R = grains.radius(grains.grain_of_vertex(centre));
  const OutlineStateOf<3>& state = surfaces.state;
  const auto way = [&](int vertex) {
    const Vec<3> d = state.position[vertex] - state.position[centre];
    return state.cell.any() ? d + state.cell.shift(state.cell.nearest(d)) : d;
  };
  for (int g = 0; g < grains.size(); ++g) {
    if (!grains.topology(g).rigid_shape()) continue;
    const int end = grains.outline_end(g) - 1;  // its centre
    if (norm(way(end)) > R + grains.radius(g) + margin) continue;
    int nearest = grains.outline_begin(g);
    for (int v = nearest; v < end; ++v)
      if (norm(way(v)) < norm(way(nearest))) nearest = v;
    SurfaceContact contact = contact_with_patch(
        surfaces, {.point = centre, .vertex = centre, .grain = grains.grain_of_vertex(centre)},
        state.position[centre], g, nearest, R + margin);
    contact.offset = R;
    contact.gap -= R;
    if (contact.gap < margin) contacts.push_back(contact);
  }
}

/// Those of one point at x, with walls and with the grains near it.
void add_contacts_of_point(const Surfaces& surfaces, double margin, const SurfaceContact& point,
                           const Vec<3>& x, std::span<const NearestVertex> near,
                           std::vector<SurfaceContact>& contacts) {
  add_wall_contacts(surfaces.state, point, margin, contacts);
  for (const NearestVertex& nearest : near) {
    const SurfaceContact contact =
        contact_with_patch(surfaces, point, x, nearest.grain, nearest.vertex, margin + surfaces.reach / 2);
    if (!(contact.gap < margin)) continue;
    contacts.push_back(contact);
    if (!surfaces.grains.topology(nearest.grain).rigid_shape())
      contacts.back().gap = gap_now(contact, surfaces.state);  // with the weights that it keeps
  }
}

void add_contacts_of_vertex(const Surfaces& surfaces, const NearVertices& near, double margin, int v,
                            std::vector<SurfaceContact>& contacts) {
  const SolidGrains& grains = surfaces.grains;
  const int own = grains.grain_of_vertex(v);
  if (grains.topology(own).ball && v + 1 == grains.outline_end(own))
    return add_contacts_of_sphere(surfaces, margin, v, contacts);
  if (is_of_surface(grains, v))
    add_contacts_of_point(surfaces, margin, {.point = v, .vertex = v, .grain = own},
                          surfaces.state.position[v], near.of(v), contacts);
}

void add_contacts_of_middle(const Surfaces& surfaces, const NearVertices& near, double margin,
                            const SurfaceContact& middle, std::vector<SurfaceContact>& contacts) {
  const bool rigid = surfaces.grains.topology(middle.grain).rigid();
  if (!is_of_surface(surfaces.grains, middle.vertex) || (rigid && middle.own->of_edge())) return;
  thread_local std::vector<NearestVertex> of_middle;
  const Vec<3> x = place_of(middle, surfaces.state.position);
  near.find_for_middle(*middle.own, middle.own_begin, x, of_middle);
  add_contacts_of_point(surfaces, margin, middle, x, of_middle, contacts);
}

}  // namespace

Middles::Middles(const SolidGrains& grains) : grains_(grains) {
  const auto add = [&](std::size_t count) { begin_.push_back(begin_.back() + static_cast<int>(count)); };
  for (int g = 0; g < grains.size(); ++g) add(grains.topology(g).patches.size());
  for (int g = 0; g < grains.size(); ++g)
    add(grains.topology(g).middles.size() - grains.topology(g).patches.size());
}

SurfaceContact Middles::point(int i) const {
  const auto next = std::upper_bound(begin_.begin(), begin_.end(), i);
  const int block = static_cast<int>(next - begin_.begin()) - 1, grain = block % grains_.size();
  const SolidTopology& shape = grains_.topology(grain);
  const int first = block < grains_.size() ? 0 : static_cast<int>(shape.patches.size());
  const SurfacePoint& middle = shape.middles[first + i - begin_[block]];
  const int begin = grains_.outline_begin(grain);
  return {.point = grains_.outline_size() + i,
          .vertex = begin + middle.corner[0],
          .grain = grain,
          .own = &middle,
          .own_begin = begin};
}

std::vector<SurfaceContact> SurfaceNeighbours::detect(const SolidGrains& grains,
                                                      const OutlineStateOf<3>& state, double margin) const {
  const Surfaces surfaces(grains, state);
  const double gap = margin * surfaces.segment;
  const NearVertices near(surfaces, surfaces.reach + gap);
  const Middles middles(grains);
  std::vector<SurfaceContact> contacts;
  append_in_parallel(grains.outline_size(), points_at_once, contacts,
                     [&](int v, std::vector<SurfaceContact>& list) {
                       add_contacts_of_vertex(surfaces, near, gap, v, list);
                     });
  append_in_parallel(middles.size(), points_at_once, contacts, [&](int q, std::vector<SurfaceContact>& list) {
    add_contacts_of_middle(surfaces, near, gap, middles.point(q), list);
  });
  if (grains.has_rigid()) add_sphere_contacts(grains, state, gap, contacts);
  return contacts;
}

}  // namespace softgrain
