#include "softgrain/soft/friction_by_kind.hpp"

#include <algorithm>
#include <unordered_map>

namespace softgrain {
namespace {

int point_of(const OutlineContact& contact) { return contact.vertex; }
int point_of(const SurfaceContact& contact) { return contact.point; }

/// The axis of the walls that press a point, or `corner` where walls of two axes do.
constexpr int corner = -1;
template <int Dim>
std::unordered_map<int, int> axes_of_points(Contacts<Dim> contacts, Impulses<Dim> impulse) {
  std::unordered_map<int, int> axes;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].wall < 0 || impulse[c][0] <= 0) continue;
    const int axis = contacts[c].wall / 2;
    const auto [found, is_first] = axes.emplace(point_of(contacts[c]), axis);
    if (!is_first && found->second != axis) found->second = corner;
  }
  return axes;
}

}  // namespace

FrictionByKind::FrictionByKind(int kinds, double between_grains, double at_walls,
                               std::span<const PairFriction> named)
    : mu_(friction_by_kinds(kinds, between_grains, at_walls, named)) {}

bool FrictionByKind::follows_impulses() const {
  for (int kind = 0; kind < mu_.kinds(); ++kind)
    if (at_walls(kind) > most_in_corners) return true;
  return false;
}

template <int Dim>
std::vector<double> FrictionByKind::of(const GrainsOf<Dim>& grains, Contacts<Dim> contacts,
                                       Contacts<Dim> before, Impulses<Dim> impulse_before) const {
  std::vector<double> friction;
  for (const auto& contact : contacts) friction.push_back(value_of(mu_, grains, contact));
  if (!follows_impulses()) return friction;
  const auto axes = axes_of_points<Dim>(before, impulse_before);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].wall < 0) continue;
    const auto found = axes.find(point_of(contacts[c]));
    if (found != axes.end() && found->second == corner) friction[c] = std::min(friction[c], most_in_corners);
  }
  return friction;
}

template std::vector<double> FrictionByKind::of(const GrainsOf<2>&, Contacts<2>, Contacts<2>,
                                                Impulses<2>) const;
template std::vector<double> FrictionByKind::of(const GrainsOf<3>&, Contacts<3>, Contacts<3>,
                                                Impulses<3>) const;

}  // namespace softgrain
