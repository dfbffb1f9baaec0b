#include "softgrain/soft/pair_friction.hpp"

#include "softgrain/core/error.hpp"

namespace softgrain {

FrictionByKind::FrictionByKind(int kinds, double between_grains, double at_walls,
                               std::span<const PairFriction> named)
    : kinds_(kinds),
      between_(static_cast<std::size_t>(kinds) * kinds, between_grains),
      at_walls_(kinds, at_walls) {
  require(between_grains >= 0 && at_walls >= 0, "friction must be >= 0, got {} and {}", between_grains,
          at_walls);
  for (const auto& [kind, other, mu] : named) {
    require(mu >= 0, "friction must be >= 0, got {}", mu);
    require(kind >= 0 && kind < kinds && other >= PairFriction::wall && other < kinds,
            "friction of kinds {} and {}, but there are {}", kind, other, kinds);
    if (other == PairFriction::wall)
      at_walls_[kind] = mu;
    else
      between_[kind * kinds + other] = between_[other * kinds + kind] = mu;
  }
}

template <int Dim>
std::vector<double> FrictionByKind::of(const GrainsOf<Dim>& grains, Contacts<Dim> contacts) const {
  std::vector<double> friction;
  for (const auto& c : contacts) {
    const int kind = grains.kind(grains.grain_of_vertex(c.vertex));
    friction.push_back(c.wall >= 0 ? at_walls(kind)
                                   : between(kind, grains.kind(grains.grain_of_vertex(c.master[0]))));
  }
  return friction;
}

template std::vector<double> FrictionByKind::of(const GrainsOf<2>&, Contacts<2>) const;
template std::vector<double> FrictionByKind::of(const GrainsOf<3>&, Contacts<3>) const;

}  // namespace softgrain
