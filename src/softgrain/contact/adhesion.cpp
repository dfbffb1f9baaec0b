#include "softgrain/contact/adhesion.hpp"

#include "softgrain/core/error.hpp"

namespace softgrain {

ByKinds<Adhesion> adhesion_by_kinds(int kinds, std::span<const PairAdhesion> named) {
  ByKinds<Adhesion> by_kinds(kinds, {}, {});
  for (const auto& [kind, other, law] : named) {
    require(law.surface_energy >= 0 && std::isfinite(law.surface_energy),
            "the surface energy must be >= 0 J/m^2, got {}", law.surface_energy);
    by_kinds.set(kind, other, law, "adhesion");
    require(!law.any() || (law.range > 0 && std::isfinite(law.range)),
            "the range of adhesion must be > 0 m, got {}", law.range);
  }
  return by_kinds;
}

double longest_range(std::span<const PairAdhesion> named) {
  double longest = 0;
  for (const PairAdhesion& pair : named)
    if (pair.law.any()) longest = std::max(longest, pair.law.range);
  return longest;
}

}  // namespace softgrain
