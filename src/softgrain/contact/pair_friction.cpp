#include "softgrain/contact/pair_friction.hpp"

namespace softgrain {

ByKinds<double> friction_by_kinds(int kinds, double between_grains, double at_walls,
                                  std::span<const PairFriction> named) {
  require(between_grains >= 0 && at_walls >= 0, "friction must be >= 0, got {} and {}", between_grains,
          at_walls);
  ByKinds<double> by_kinds(kinds, between_grains, at_walls);
  for (const auto& [kind, other, mu] : named) {
    require(mu >= 0, "friction must be >= 0, got {}", mu);
    by_kinds.set(kind, other, mu, "friction");
  }
  return by_kinds;
}

}  // namespace softgrain
