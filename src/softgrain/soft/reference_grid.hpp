#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// The reference grid of a grain, fitted to its outline so that no cell is cut: four-node cells with four
/// material points each, one at every Gauss position. With the points there, total-Lagrangian MPM is the
/// four-node finite element (docs/theory.md). Lengths are in units of the grain's radius R.
///
/// Topology: a square of n x n cells in the middle and 5n/8 rings of 4n cells round it: 7/2 n^2 cells for n a
/// multiple of 8. The outline's nodes come last, counter-clockwise.
struct ReferenceGrid {
  std::vector<Vec<2>> node;              ///< (nodes) X
  std::vector<std::array<int, 4>> cell;  ///< (cells) nodes, counter-clockwise
  int outline_begin = 0;                 ///< first node of the outline
  double fullness = 1;                   ///< area of the body over that of the cells

  int nodes() const { return static_cast<int>(node.size()); }
  int outline_nodes() const { return nodes() - outline_begin; }
  std::span<const Vec<2>> outline() const { return std::span(node).subspan(outline_begin); }
};

/// A disk of unit radius: the outline is the regular polygon on the circle, which the smooth outline leaves
/// nowhere outwards, and `fullness` is pi over its area. `n` is the number of cells along a side of the inner
/// square. Raises UsageError for n < 2.
ReferenceGrid disk_grid(int n);
/// Rings of cells round its inner square: 5n/8, rounded, and at least 1.
constexpr int disk_rings(int n) { return std::max(1, (5 * n + 4) / 8); }

/// Any simple polygon, resampled to 4n points with all its vertices kept; interior nodes at the mean of their
/// neighbours. Raises UsageError if the outline crosses itself, has more than 4n vertices, or is so concave
/// that a cell would fold.
ReferenceGrid polygon_grid(std::span<const Vec<2>> vertices, int n);

/// The grid whose outline is these 4n points, counter-clockwise; interior nodes at the mean of their
/// neighbours. No cell folds if the outline is convex. Raises UsageError for another number of points.
ReferenceGrid outline_grid(std::span<const Vec<2>> outline, int n);
/// The centre of the cell that folds most, if one does.
std::optional<Vec<2>> folded_cell(const ReferenceGrid& grid);

/// The four material points of a cell: volume and gradients of the four shape functions.
struct MaterialPoint {
  double volume = 0;                 ///< V_p [R^2]
  std::array<double, 4> shape{};     ///< N_a(X_p)
  std::array<Vec<2>, 4> gradient{};  ///< dN_a/dX [1/R]
};

/// (4 cells) points, four by four in the order of the cells.
std::vector<MaterialPoint> material_points(const ReferenceGrid& grid);

}  // namespace softgrain
