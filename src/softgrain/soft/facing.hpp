#pragma once
#include <algorithm>
#include <cmath>
#include <span>

#include "softgrain/soft/outline_contacts.hpp"
#include "softgrain/soft/span_curve.hpp"

// Where a vertex, or the arc of a rigid one, faces another outline.

namespace softgrain {

/// The vertices of one outline, in a ring.
struct Ring {
  int begin, end;
  const char* corner;  ///< (its vertices) or nullptr
  bool is_corner(int vertex) const { return corner != nullptr && corner[vertex - begin] != 0; }
  int next(int vertex) const { return vertex + 1 < end ? vertex + 1 : begin; }
  int previous(int vertex) const { return vertex > begin ? vertex - 1 : end - 1; }
};
inline Ring ring_of(const SoftGrains& grains, int vertex) {
  const int grain = grains.grain_of_vertex(vertex);
  const std::vector<char>& corner = grains.topology(grain).corner;
  return {grains.outline_begin(grain), grains.outline_end(grain), corner.empty() ? nullptr : corner.data()};
}

/// The vertex of a master's outline where the segment starts that x faces, next to the vertex nearest to x.
inline int facing_segment(const Ring& ring, std::span<const Vec<2>> position, const Vec<2>& x, int nearest) {
  const int before = ring.previous(nearest);
  const Vec<2> tangent = position[ring.next(nearest)] - position[before];
  return dot(x - position[nearest], tangent) < 0 ? before : nearest;
}

/// True if x is surely more than `margin` outside the curve from the vertex `start` to the next. Over its
/// chord the curve bulges by less than a quarter of the steeper of its slopes at the ends (Bezier's control
/// points); an eighth more than the margin covers what the normal at an end is inclined.
inline bool surely_outside(std::span<const Vec<2>> position, const Ring& ring, int start, const Vec<2>& x,
                           double margin) {
  const int end = ring.next(start);
  const Vec<2> chord = position[end] - position[start], inward = perpendicular(chord);
  const double slope = std::max(-dot(position[end] - position[ring.previous(start)], inward),
                                dot(position[ring.next(end)] - position[start], inward)) /
                       2;  // times |chord|
  const double beyond = -dot(x - position[start], inward) - std::max(slope, 0.0) / 4;
  const double least = 1.125 * margin;
  return beyond > 0 && beyond * beyond > least * least * dot(chord, chord);
}

/// The place that a slave at x faces on the curve from the vertex `start` to the next. At a corner the curve
/// ends as one whose next vertex is the corner itself: sides between corners are straight.
[[gnu::always_inline]] inline OutlineContact curve_contact(std::span<const Vec<2>> position, const Ring& ring,
                                                           int slave, const Vec<2>& x, int start) {
  const int end = ring.next(start);
  OutlineContact contact{.vertex = slave,
                         .master = {ring.is_corner(start) ? start : ring.previous(start), start, end,
                                    ring.is_corner(end) ? end : ring.next(end)}};
  const SpanCurve curve(position, contact.master);
  contact.share = curve.closest_to(x);
  const Vec<2> t = curve.tangent(contact.share);
  contact.normal = (-1 / norm(t)) * perpendicular(t);  // outward of a counter-clockwise outline
  const Vec<2> d = x - curve.place(contact.share);
  contact.gap = dot(d, contact.normal);
  constexpr double at_end = 1e-9;
  const bool beside_corner = (contact.share < at_end && ring.is_corner(start)) ||
                             (contact.share > 1 - at_end && ring.is_corner(end));
  if (beside_corner && contact.gap > 0) {  // from the corner to x
    contact.gap = norm(d);
    contact.normal = (1 / contact.gap) * d;
  }
  return contact;
}

/// The vertex of a master's outline nearest to x, walking downhill from `start`.
inline int nearest_vertex(const Ring& ring, std::span<const Vec<2>> position, const Vec<2>& x, int start) {
  const auto distance_squared = [&](int w) {
    const Vec<2> d = position[w] - x;
    return dot(d, d);
  };
  int nearest = start;
  double least = distance_squared(start);
  for (;;) {
    const int before = ring.previous(nearest), after = ring.next(nearest);
    const double d_before = distance_squared(before), d_after = distance_squared(after);
    if (least <= d_before && least <= d_after) return nearest;
    nearest = d_before < d_after ? before : after;
    least = std::min(d_before, d_after);
  }
}

/// Where the slave v at x faces a master at the outlines `position`, near the vertex `nearest`.
inline OutlineContact facing_contact(std::span<const Vec<2>> position, const Ring& ring, int v,
                                     const Vec<2>& x, int nearest) {
  nearest = nearest_vertex(ring, position, x, nearest);
  return curve_contact(position, ring, v, x, facing_segment(ring, position, x, nearest));
}

/// The arc of a vertex, if its grain is rigid and has one there.
const OutlineArc* rigid_arc(const SoftGrains& grains, int v);
/// The arc of a rigid vertex v against a wall. on_the_way: where place and normal are taken.
OutlineContact rigid_wall_contact(const SoftGrains& grains, const OutlineState& state,
                                  std::span<const Vec<2>> on_the_way, int wall_index, int v,
                                  const OutlineArc& arc);
/// The same of the arc of a rigid slave, seen from a master whose image is `shift` away.
OutlineContact facing_arc(const SoftGrains& grains, std::span<const Vec<2>> position, const Ring& ring, int v,
                          const OutlineArc& arc, const Vec<2>& shift, int nearest);

}  // namespace softgrain
