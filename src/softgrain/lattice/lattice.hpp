#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "softgrain/lattice/point_grain.hpp"
#include "softgrain/lattice/shape_functions.hpp"

namespace softgrain {

/// A node's share in the velocity of something: v = sum_i w_i v_i.
struct NodeWeight {
  int node = 0;
  double weight = 0;
};

/// The velocity fields of all grains on one Cartesian lattice, nodes at whole multiples of the cell. Each
/// grain has its own field on the window of nodes around it; the fields lie one after the other in flat
/// arrays.
class Lattice {
 public:
  Lattice(ShapeFunction shape, double cell) : shape_(shape), cell_(cell) {}

  /// Windows around the grains where they are now, with all fields zero.
  void reset(std::span<const PointGrain> grains);

  ShapeFunction shape() const { return shape_; }
  double cell() const { return cell_; }  ///< h [m]
  int nodes() const { return static_cast<int>(mass.size()); }
  /// A grain's nodes in the arrays: from the first one on, row after row.
  int first_node(int grain) const { return window_[grain].begin; }
  int columns(int grain) const { return window_[grain].columns; }
  int rows(int grain) const { return window_[grain].rows; }
  /// Whether a node is one of a grain's.
  bool holds(int grain, int node) const {
    const Window& w = window_[grain];
    return w.begin <= node && node < w.begin + w.columns * w.rows;
  }
  /// Index of a grain's node in the arrays.
  int node(int grain, int column, int row) const {
    const Window& w = window_[grain];
    return w.begin + (row - w.row) * w.columns + column - w.column;
  }
  /// visit(node, its place [m]) for all nodes of the window of a grain.
  template <class Visit>
  void for_each_node(int grain, Visit&& visit) const {
    const Window& w = window_[grain];
    for (int j = w.row; j < w.row + w.rows; ++j)
      for (int i = w.column; i < w.column + w.columns; ++i)
        visit(node(grain, i, j), Vec<2>{i * cell_, j * cell_});
  }
  /// visit(node of a, node of b, their place [m]) where the windows of two grains overlap.
  template <class Visit>
  void for_each_common_node(int a, int b, Visit&& visit) const;

  /// Weights of a massless vertex at x: the shape functions of the nodes with more than `least_mass`
  /// [kg/m], divided by their sum. Empty if there is no such node.
  void vertex_weights(int grain, const Vec<2>& x, double least_mass, std::vector<NodeWeight>& weights) const;

  std::vector<double> mass;      ///< m_i [kg/m]
  std::vector<Vec<2>> velocity;  ///< v_i [m/s]
  std::vector<Vec<2>> inward;    ///< gradient of the mass [kg/m^2]: points into the grain

 private:
  struct Window {
    int begin = 0, column = 0, row = 0, columns = 0, rows = 0;
  };
  ShapeFunction shape_;
  double cell_;
  std::vector<Window> window_;
};

template <class Visit>
void Lattice::for_each_common_node(int a, int b, Visit&& visit) const {
  const Window &u = window_[a], &w = window_[b];
  const int last_column = std::min(u.column + u.columns, w.column + w.columns);
  const int last_row = std::min(u.row + u.rows, w.row + w.rows);
  for (int j = std::max(u.row, w.row); j < last_row; ++j)
    for (int i = std::max(u.column, w.column); i < last_column; ++i)
      visit(node(a, i, j), node(b, i, j), Vec<2>{i * cell_, j * cell_});
}

}  // namespace softgrain
