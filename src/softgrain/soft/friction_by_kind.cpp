#include "softgrain/soft/friction_by_kind.hpp"

namespace softgrain {

FrictionByKind::FrictionByKind(int kinds, double between_grains, double at_walls,
                               std::span<const PairFriction> named)
    : mu_(friction_by_kinds(kinds, between_grains, at_walls, named)) {}

template <int Dim>
std::vector<double> FrictionByKind::of(const GrainsOf<Dim>& grains, Contacts<Dim> contacts) const {
  std::vector<double> friction;
  for (const auto& contact : contacts) friction.push_back(value_of(mu_, grains, contact));
  return friction;
}

template std::vector<double> FrictionByKind::of(const GrainsOf<2>&, Contacts<2>) const;
template std::vector<double> FrictionByKind::of(const GrainsOf<3>&, Contacts<3>) const;

}  // namespace softgrain
