#pragma once
#include <numbers>

namespace softgrain {

/// Area of the unit disk, volume of the unit ball.
template <int Dim>
inline constexpr double unit_ball = Dim == 2 ? std::numbers::pi : 4 * std::numbers::pi / 3;

/// factor R^Dim, a factor after the other: the size of a disk or ball of radius R is unit_ball R^Dim.
template <int Dim>
constexpr double times_power(double factor, double R) {
  for (int k = 0; k < Dim; ++k) factor *= R;
  return factor;
}

}  // namespace softgrain
