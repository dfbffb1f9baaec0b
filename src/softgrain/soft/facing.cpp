#include "softgrain/soft/facing.hpp"

#include "softgrain/soft/arc_place.hpp"

namespace softgrain {
namespace {

/// The outlines `position` round the vertex v of a grain.
std::array<Vec<2>, 3> beside(const SoftGrains& grains, std::span<const Vec<2>> position, int v) {
  const auto [before, after] = grains.beside(v);
  return {position[before], position[v], position[after]};
}

void set_place(OutlineContact& contact, const SoftGrains& grains, const ArcPlace& place) {
  contact.along = place.along;
  contact.inward = place.inward;
  contact.beside = grains.beside(contact.vertex);
}

}  // namespace

/// The arc of a vertex, if its grain is rigid and has one there.
const OutlineArc* rigid_arc(const SoftGrains& grains, int v) {
  const int grain = grains.grain_of_vertex(v);
  const Topology& shape = grains.topology(grain);
  const OutlineArc& arc = shape.arc[v - grains.outline_begin(grain)];
  return shape.rigid() && arc.end_sine > 0 ? &arc : nullptr;
}

/// The arc of a rigid vertex v against a wall.
OutlineContact rigid_wall_contact(const SoftGrains& grains, const OutlineState& state,
                                  std::span<const Vec<2>> on_the_way, int wall_index, int v,
                                  const OutlineArc& arc) {
  const Wall<2>& wall = state.walls[wall_index];
  const double size = grains.radius(grains.grain_of_vertex(v));
  const ArcPlace end = arc_place(beside(grains, state.position, v), arc, size, -wall.normal);
  OutlineContact contact{
      .vertex = v, .wall = wall_index, .normal = wall.normal, .gap = dot(end.x - wall.point, wall.normal)};
  const ArcPlace place = arc_place(beside(grains, on_the_way, v), arc, size, -wall.normal);
  set_place(contact, grains, place);
  contact.slip = dot(perpendicular(wall.normal), relative_displacement(contact, state));
  return contact;
}

/// The same of the arc of a rigid slave, seen from a master whose image is `shift` away.
OutlineContact facing_arc(const SoftGrains& grains, std::span<const Vec<2>> position, const Ring& ring, int v,
                          const OutlineArc& arc, const Vec<2>& shift, int nearest) {
  const double size = grains.radius(grains.grain_of_vertex(v));
  const std::array<Vec<2>, 3> x = beside(grains, position, v);
  OutlineContact contact = facing_contact(position, ring, v, arc_centre(x, arc, size) - shift, nearest);
  const ArcPlace place = arc_place(x, arc, size, -contact.normal);
  if (place.at_end)
    contact = facing_contact(position, ring, v, place.x - shift, nearest);
  else
    contact.gap -= size * arc.radius;
  set_place(contact, grains, place);
  return contact;
}

}  // namespace softgrain
