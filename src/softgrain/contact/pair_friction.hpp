#pragma once
#include <span>

#include "softgrain/contact/by_kinds.hpp"

namespace softgrain {

/// mu of the contacts between grains of two kinds, or of a kind and walls.
struct PairFriction {
  static constexpr int wall = ByKinds<double>::wall;
  int kind = 0;
  int other = wall;  ///< another kind, the same, or `wall`
  double mu = 0;
};

/// mu between grains and against walls, but of the pairs that are named. Raises UsageError for mu < 0 and for
/// kinds that are not there.
ByKinds<double> friction_by_kinds(int kinds, double between_grains, double at_walls,
                                  std::span<const PairFriction> named);

}  // namespace softgrain
