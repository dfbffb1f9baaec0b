#include "softgrain/soft/carried_impulses.hpp"
#include "softgrain/soft/surface_contacts.hpp"
#include "softgrain/soft/surface_lists.hpp"
#include "softgrain/soft/surface_sum.hpp"

// What a contact in space that was found says once its bodies have moved.

namespace softgrain {
namespace {

/// A value of vertices at the point of a contact, less that at the patch that it faces.
template <class Value>
[[gnu::always_inline]] inline Lanes at_point(const Value& value, const SurfaceContact& contact) {
  return point_less_patch(contact.own, contact.own == nullptr ? contact.vertex : contact.own_begin,
                          contact.patch, contact.facing_begin, contact.weight, value);
}

}  // namespace

Vec<3> place_of(const SurfaceContact& contact, std::span<const PaddedVec> x) {
  if (contact.own == nullptr) return x[contact.vertex];
  Lanes place{};
  contact.for_each_own_vertex([&](int v, double weight) { place += weight * load_lanes(x[v]); });
  return first_three(place);
}

double gap_now(const SurfaceContact& contact, const OutlineStateOf<3>& state) {
  Lanes apart =
      at_point([&](int v) { return load_lanes(state.position[v]); }, contact) - load_lanes(contact.image);
  if (contact.wall >= 0) apart -= load_lanes(state.walls[contact.wall].point);
  return dot(first_three(apart), contact.normal) - contact.offset;
}

double offset_of(const SurfaceContact& contact, const SolidGrains& grains) {
  double sum = 0;
  const auto add = [&](int vertex) {
    const int grain = grains.grain_of_vertex(vertex);
    if (grains.topology(grain).ball) sum += grains.radius(grain);
  };
  add(contact.vertex);
  if (contact.wall < 0) add(contact.facing_vertex());
  return sum;
}

void update_image(SurfaceContact& contact, const OutlineStateOf<3>& state) {
  if (contact.wall < 0) set_image(contact, contact.facing_vertex(), state);
}

Vec<3> relative_displacement(const SurfaceContact& contact, const OutlineStateOf<3>& state) {
  Lanes sum =
      at_point([&](int v) { return load_lanes(state.position[v]) - load_lanes(state.start[v]); }, contact) -
      load_lanes(contact.image_motion);
  if (contact.wall >= 0) sum -= load_lanes(state.dt * state.walls[contact.wall].velocity);
  Vec<3> displacement = first_three(sum);
  if (contact.offset > 0) {  // omega x (-R n) of either side
    displacement -= cross(state.rolled[contact.vertex], contact.normal);
    if (contact.wall < 0) displacement -= cross(state.rolled[contact.facing_vertex()], contact.normal);
  }
  return displacement;
}

std::vector<Vec<3>> carried_impulses(const SolidGrains& /*grains*/, std::span<const SurfaceContact> old,
                                     std::span<const Vec<3>> old_impulse,
                                     std::span<const SurfaceContact> contacts) {
  return carry_impulses(
      old, old_impulse, contacts, [](const SurfaceContact& c) { return c.point; },
      [](const SurfaceContact& c) { return c.facing; },
      [](const SurfaceContact& was, const Vec<3>& impulse, const SurfaceContact& now) {
        return to_local(now.normal, impulse_vector(was, impulse));
      });
}

}  // namespace softgrain
