#include "softgrain/soft/carried_impulses.hpp"
#include "softgrain/soft/outline_contacts.hpp"
#include "softgrain/soft/span_curve.hpp"

// What a contact that was found says once its bodies have moved.

namespace softgrain {

Vec<2> relative_displacement(const OutlineContact& contact, const OutlineState& state) {
  Vec<2> displacement;
  if (contact.wall >= 0) displacement -= state.dt * state.walls[contact.wall].velocity;
  contact.for_each_vertex([&](int vertex, double weight) {
    displacement += weight * (state.position[vertex] - state.start[vertex]);
  });
  return displacement -= contact.image_motion;
}

double gap_now(const OutlineContact& contact, const OutlineState& state) {
  if (contact.wall >= 0) {
    Vec<2> apart = -state.walls[contact.wall].point;
    contact.for_each_vertex([&](int vertex, double weight) { apart += weight * state.position[vertex]; });
    return dot(apart, contact.normal) + contact.rise;
  }
  const Vec<2> x = contact.slave_at(state.position) - contact.image;
  const SpanCurve curve(state.position, contact.master);
  const double xi = curve.closest_to(x);
  const Vec<2> t = curve.tangent(xi);
  return -dot(x - curve.place(xi), perpendicular(t)) / norm(t);
}

std::vector<Vec<2>> carried_impulses(const SoftGrains& grains, std::span<const OutlineContact> old,
                                     std::span<const Vec<2>> old_impulse,
                                     std::span<const OutlineContact> contacts) {
  return carry_impulses(
      old, old_impulse, contacts, [](const OutlineContact& c) { return c.vertex; },
      [&](const OutlineContact& c) { return grains.grain_of_vertex(c.master[0]); },
      [](const OutlineContact&, const Vec<2>& impulse, const OutlineContact&) { return impulse; });
}

}  // namespace softgrain
