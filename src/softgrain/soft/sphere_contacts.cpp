#include "softgrain/soft/sphere_contacts.hpp"

#include <algorithm>
#include <tuple>

#include "softgrain/soft/surface_lists.hpp"

namespace softgrain {
namespace {

/// Spheres that a thread takes at once.
constexpr int spheres_at_once = 32;

/// What a sphere may meet, and the spheres themselves.
struct Points {
  std::vector<Vec<3>> position;
  /// The contact of each with nothing yet: a vertex of a soft grain, a middle, or a sphere
  std::vector<SurfaceContact> contact;
  std::vector<int> sphere;  ///< of each sphere its number here
  double largest = 0;       ///< of their radii [m]
};

Points points_of(const SolidGrains& grains, const OutlineStateOf<3>& state) {
  Points points;
  for (int g = 0; g < grains.size(); ++g) {
    const SolidTopology& shape = grains.topology(g);
    const int begin = grains.outline_begin(g), end = grains.outline_end(g);
    if (shape.rigid_shape()) continue;  // it is looked for among the patches
    for (int v = shape.rigid() ? end - 1 : begin; v < end; ++v) {
      if (shape.rigid()) points.sphere.push_back(static_cast<int>(points.position.size()));
      points.position.push_back(state.position[v]);
      points.contact.push_back({.point = v, .vertex = v, .grain = g});
    }
    if (shape.rigid()) points.largest = std::max(points.largest, grains.radius(g));
  }
  const Middles middles(grains);
  for (int i = 0; i < middles.size(); ++i) {
    const SurfaceContact middle = middles.point(i);
    if (grains.topology(middle.grain).rigid()) continue;
    points.position.push_back(place_of(middle, state.position));
    points.contact.push_back(middle);
  }
  return points;
}

/// Normal and gap along the line from the master to the point.
void add_if_near(const SolidGrains& grains, const OutlineStateOf<3>& state, double margin,
                 SurfaceContact contact, std::vector<SurfaceContact>& contacts) {
  contact.offset = offset_of(contact, grains);
  set_image(contact, contact.facing_vertex(), state);
  Vec<3> d = Vec<3>{} - contact.image;
  contact.for_each_vertex([&](int v, double weight) { d += weight * state.position[v]; });
  const double distance = norm(d);
  contact.gap = distance - contact.offset;
  if (!(contact.gap < margin) || distance == 0) return;
  contact.normal = (1 / distance) * d;
  contacts.push_back(contact);
}

/// Those of one sphere with a point beside it.
void add_contact(const SolidGrains& grains, const OutlineStateOf<3>& state, double margin,
                 const SurfaceContact& sphere, SurfaceContact other, std::vector<SurfaceContact>& contacts) {
  const bool both = grains.topology(other.grain).rigid();
  if (both && other.vertex >= sphere.vertex) return;
  other.facing = sphere.grain;
  other.patch = &net_of_one_vertex;
  other.facing_begin = sphere.vertex;
  other.weight[0] = 1;
  add_if_near(grains, state, margin, other, contacts);
}

}  // namespace

void add_sphere_contacts(const SolidGrains& grains, const OutlineStateOf<3>& state, double margin,
                         std::vector<SurfaceContact>& contacts) {
  const Points points = points_of(grains, state);
  if (points.sphere.empty()) return;
  const double reach = 2 * points.largest + margin;
  const ImagedGrid grid(points.position, state.cell, reach);
  const auto add = [&](int s, std::vector<SurfaceContact>& list) {
    const int i = points.sphere[s];
    SurfaceContact sphere = points.contact[i];
    sphere.offset = grains.radius(sphere.grain);
    add_wall_contacts(state, sphere, margin, list);
    grid.for_each_neighbour(i, [&](int j, const Vec<3>&) {
      if (j != i) add_contact(grains, state, margin, sphere, points.contact[j], list);
    });
  };
  append_in_parallel(static_cast<int>(points.sphere.size()), spheres_at_once, contacts, add);
  const auto order = [](const SurfaceContact& c) { return std::tuple(c.point, c.wall, c.facing); };
  const auto before = [&](const auto& a, const auto& b) { return order(a) < order(b); };
  std::sort(contacts.begin(), contacts.end(), before);
  const auto same = [&](const auto& a, const auto& b) { return order(a) == order(b); };
  contacts.erase(std::unique(contacts.begin(), contacts.end(), same), contacts.end());
}

}  // namespace softgrain
