#pragma once
#include <type_traits>

#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// A grain as a sample places it, for any model.
template <int Dim>
struct PlacedGrainOf {
  Vec<Dim> centre;                                       ///< [m]
  double radius = 0;                                     ///< [m]
  std::conditional_t<Dim == 2, double, Mat<3>> angle{};  ///< orientation [rad]; in space a rotation
  int kind = 0;

  friend bool operator==(const PlacedGrainOf& a, const PlacedGrainOf& b) {
    return a.centre.c == b.centre.c && a.radius == b.radius && a.angle == b.angle && a.kind == b.kind;
  }
};
using PlacedGrain = PlacedGrainOf<2>;

}  // namespace softgrain
