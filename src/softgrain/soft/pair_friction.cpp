#include "softgrain/soft/pair_friction.hpp"

#include "softgrain/core/error.hpp"

namespace softgrain {

FrictionByKind::FrictionByKind(int kinds, double between_grains, double at_walls,
                               std::span<const PairFriction> named)
    : mu_(kinds, between_grains, at_walls) {
  require(between_grains >= 0 && at_walls >= 0, "friction must be >= 0, got {} and {}", between_grains,
          at_walls);
  for (const auto& [kind, other, mu] : named) {
    require(mu >= 0, "friction must be >= 0, got {}", mu);
    mu_.set(kind, other, mu, "friction");
  }
}

template <int Dim>
std::vector<double> FrictionByKind::of(const GrainsOf<Dim>& grains, Contacts<Dim> contacts) const {
  std::vector<double> friction;
  for (const auto& contact : contacts) friction.push_back(mu_.of(grains, contact));
  return friction;
}

template std::vector<double> FrictionByKind::of(const GrainsOf<2>&, Contacts<2>) const;
template std::vector<double> FrictionByKind::of(const GrainsOf<3>&, Contacts<3>) const;

}  // namespace softgrain
