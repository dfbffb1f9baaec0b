#pragma once
#include <array>
#include <cmath>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Shape functions of the nodes i of a Cartesian lattice, products of one function in each direction
/// (theory (55)). All sum to one and carry linear fields exactly.
enum class ShapeFunction {
  bilinear,  ///< hat functions: their gradient jumps where a point crosses into another cell
  gimp,      ///< uGIMP: hat functions averaged over a point's square of half a cell, which stays as it was
  bspline,   ///< quadratic B-splines
};

/// Side of a material point's square over the cell: 2 x 2 points in a cell at the start.
constexpr double point_side = 0.5;

/// Farthest distance of a point from a node that it gives mass to, in cells.
constexpr double support(ShapeFunction shape) {
  return shape == ShapeFunction::bilinear ? 1 : shape == ShapeFunction::gimp ? 1 + point_side / 2 : 1.5;
}

/// Weights of the nodes first, first + 1, first + 2 in one direction, and their derivatives over the
/// coordinate in cells.
struct LineWeights {
  int first = 0;
  std::array<double, 3> N{}, dN{};
};

/// Hat function averaged over [x - l, x + l], l <= 1/2, at the distance x from its node, in cells.
inline void averaged_hat(double x, double l, double& N, double& dN) {
  const double distance = std::abs(x), side = x < 0 ? -1 : 1;
  if (distance < l) {
    N = 1 - (x * x + l * l) / (2 * l);
    dN = -x / l;
  } else if (distance < 1 - l) {
    N = 1 - distance;
    dN = -side;
  } else if (distance < 1 + l) {
    N = (1 + l - distance) * (1 + l - distance) / (4 * l);
    dN = -side * (1 + l - distance) / (2 * l);
  }
}

/// x: coordinate of the point over the cell.
inline LineWeights line_weights(ShapeFunction shape, double x) {
  LineWeights w;
  if (shape == ShapeFunction::bilinear) {
    w.first = static_cast<int>(std::floor(x));
    const double r = x - w.first;
    w.N = {1 - r, r, 0};
    w.dN = {-1, 1, 0};
  } else if (shape == ShapeFunction::gimp) {
    constexpr double l = point_side / 2;
    w.first = static_cast<int>(std::floor(x - l));
    for (int k = 0; k < 3; ++k) averaged_hat(x - w.first - k, l, w.N[k], w.dN[k]);
  } else {
    w.first = static_cast<int>(std::floor(x - 0.5));
    const double r = x - 0.5 - w.first;
    w.N = {(1 - r) * (1 - r) / 2, 0.75 - (r - 0.5) * (r - 0.5), r * r / 2};
    w.dN = {r - 1, 1 - 2 * r, r};
  }
  return w;
}

/// Weights N_i(x) and gradients dN_i/dx [1/m] of the nodes around a place.
struct Stencil {
  /// x [m], cell h [m].
  Stencil(ShapeFunction shape, const Vec<2>& x, double cell)
      : along{line_weights(shape, x[0] / cell), line_weights(shape, x[1] / cell)}, inverse_cell(1 / cell) {}

  /// visit(column, row, N_i, dN_i/dx) for the nine nodes, those of no weight too.
  template <class Visit>
  void for_each_node(Visit&& visit) const {
    const auto& [x, y] = along;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        visit(x.first + i, y.first + j, x.N[i] * y.N[j],
              Vec<2>{inverse_cell * x.dN[i] * y.N[j], inverse_cell * x.N[i] * y.dN[j]});
  }

  std::array<LineWeights, 2> along;
  double inverse_cell;
};

}  // namespace softgrain
