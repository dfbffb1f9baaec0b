#pragma once
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A grain as a sample places it, for any model.
struct PlacedGrain {
  Vec<2> centre;      ///< [m]
  double radius = 0;  ///< [m]
  double angle = 0;   ///< [rad] orientation
  int kind = 0;

  friend bool operator==(const PlacedGrain& a, const PlacedGrain& b) {
    return a.centre.c == b.centre.c && a.radius == b.radius && a.angle == b.angle && a.kind == b.kind;
  }
};

}  // namespace softgrain
