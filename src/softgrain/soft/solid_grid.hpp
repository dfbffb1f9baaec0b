#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// The reference grid of a grain in space, as ReferenceGrid is in the plane: eight-node cells with eight
/// material points each, one at every Gauss position. Lengths are in units of the grain's radius R.
///
/// Nodes of a cell: 0 to 3 round one face, 4 to 7 behind them in the same order, so that node 1 lies along
/// xi, 3 along eta and 4 along zeta from node 0, and det dX/d(xi, eta, zeta) > 0.
struct SolidGrid {
  std::vector<Vec<3>> node;              ///< (nodes) X
  std::vector<std::array<int, 8>> cell;  ///< (cells) nodes
  /// (quads) nodes of the outline, counter-clockwise seen from outside
  std::vector<std::array<int, 4>> quad;
  int outline_begin = 0;  ///< first node of the outline; its nodes come last
  double fullness = 1;    ///< volume of the body over that of the cells

  int nodes() const { return static_cast<int>(node.size()); }
  int outline_nodes() const { return nodes() - outline_begin; }
};

/// A ball of unit radius: a bulged cube of n x n x n cells and n/2 layers of 6 n^2 cells round it, 4 n^3
/// cells for even n, with 6 n^2 + 2 outline nodes on the sphere. `fullness` is 4 pi/3 over the volume of the
/// cells: the grid is not blown up to the ball's volume, for its vertices would then touch too early. Raises
/// UsageError for n < 2.
SolidGrid ball_grid(int n);

/// The eight material points of a cell: volume and gradients of the eight shape functions.
struct SolidPoint {
  double volume = 0;                 ///< V_p [R^3]
  std::array<double, 8> shape{};     ///< N_a(X_p)
  std::array<Vec<3>, 8> gradient{};  ///< dN_a/dX [1/R]
};

/// (8 cells) points, eight by eight in the order of the cells; of a cell xi varies fastest, then eta.
std::vector<SolidPoint> material_points(const SolidGrid& grid);

}  // namespace softgrain
