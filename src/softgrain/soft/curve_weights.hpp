#pragma once
#include <array>

namespace softgrain {

/// w_k(xi), xi in [0, 1], of the smooth curve through points (uniform Catmull-Rom): between x_1 and x_2, with
/// their neighbours x_0 and x_3,
///   c(xi) = sum_k w_k(xi) x_k.
constexpr std::array<double, 4> curve_weights(double xi) {
  const double a = xi * xi, b = a * xi;
  return {-xi / 2 + a - b / 2, 1 - 2.5 * a + 1.5 * b, xi / 2 + 2 * a - 1.5 * b, (b - a) / 2};
}

/// dw_k/dxi.
constexpr std::array<double, 4> curve_slopes(double xi) {
  const double a = xi * xi;
  return {-0.5 + 2 * xi - 1.5 * a, -5 * xi + 4.5 * a, 0.5 + 4 * xi - 4.5 * a, 1.5 * a - xi};
}

}  // namespace softgrain
