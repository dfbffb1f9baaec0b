#pragma once
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A half-space of infinite mass: the material stays where (x - point) . normal >= 0.
template <int Dim>
struct Wall {
  Vec<Dim> point;     ///< [m] on the surface; moves with the velocity
  Vec<Dim> normal;    ///< unit, into the material
  Vec<Dim> velocity;  ///< [m/s] prescribed
  bool open = false;  ///< it is not there: no grain meets it
};

}  // namespace softgrain
