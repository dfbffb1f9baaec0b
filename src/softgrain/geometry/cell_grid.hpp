#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Points sorted into square (cubic) cells, to find all pairs closer than a reach in O(n).
template <int Dim>
class CellGrid {
 public:
  /// Cells at least `reach` [m] wide, and not many more cells than points. Raises NumericalError unless all
  /// positions are finite.
  CellGrid(std::span<const Vec<Dim>> position, double reach) : position_(position) {
    if (position.empty()) return;
    Vec<Dim> high = low_ = position[0];
    for (const Vec<Dim>& x : position) {
      for (int k = 0; k < Dim; ++k) low_[k] = std::min(low_[k], x[k]), high[k] = std::max(high[k], x[k]);
      if (!std::isfinite(dot(x, x)))
        throw NumericalError("a position is not finite; use a smaller time step");
    }
    width_ = reach;
    while (count_cells(high) > 4.0 * static_cast<double>(position.size()) + 64) width_ *= 2;
    sort_points();
  }

  /// Calls visit(i, j) once, i < j, for each pair in the same or adjacent cells: every pair closer than the
  /// reach, and others.
  template <class Visit>
  void for_each_close_pair(Visit&& visit) const {
    const int n = static_cast<int>(position_.size());
    for (int i = 0; i < n; ++i)
      for_each_neighbour(i, [&](int j) {
        if (i < j) visit(i, j);
      });
  }

  /// Calls visit(j) for each other point j in the same or adjacent cells of point i.
  template <class Visit>
  void for_each_neighbour(int i, Visit&& visit) const {
    const auto cell = cell_of(position_[i]);
    if constexpr (Dim == 2) {
      for (int y = cell[1] - 1; y <= cell[1] + 1; ++y) visit_row({cell[0], y}, i, visit);
    } else {
      for (int z = cell[2] - 1; z <= cell[2] + 1; ++z)
        for (int y = cell[1] - 1; y <= cell[1] + 1; ++y) visit_row({cell[0], y, z}, i, visit);
    }
  }

 private:
  using Cell = std::array<int, Dim>;

  double count_cells(const Vec<Dim>& high) {
    double count = 1;
    for (int k = 0; k < Dim; ++k) {
      const double along = std::floor((high[k] - low_[k]) / width_) + 1;
      count *= along;
      shape_[k] = along < 1e9 ? static_cast<int>(along) : 1000000000;
    }
    return count;
  }

  Cell cell_of(const Vec<Dim>& x) const {
    Cell cell;
    for (int k = 0; k < Dim; ++k) cell[k] = static_cast<int>(std::floor((x[k] - low_[k]) / width_));
    return cell;
  }

  int index_of(const Cell& cell) const {
    int index = cell[Dim - 1];
    for (int k = Dim - 2; k >= 0; --k) index = index * shape_[k] + cell[k];
    return index;
  }

  /// Counting sort: points_ holds the points cell by cell, begin_ where each cell starts.
  void sort_points() {
    int cells = 1;
    for (const int along : shape_) cells *= along;
    begin_.assign(cells + 1, 0);
    std::vector<int> cell_index(position_.size());
    for (std::size_t i = 0; i < position_.size(); ++i) {
      cell_index[i] = index_of(cell_of(position_[i]));
      ++begin_[cell_index[i] + 1];
    }
    for (int c = 0; c < cells; ++c) begin_[c + 1] += begin_[c];
    points_.resize(position_.size());
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < position_.size(); ++i) points_[next[cell_index[i]]++] = static_cast<int>(i);
  }

  /// The three cells of a row lie side by side in memory.
  template <class Visit>
  void visit_row(Cell cell, int i, Visit& visit) const {
    for (int k = 1; k < Dim; ++k)
      if (cell[k] < 0 || cell[k] >= shape_[k]) return;
    const int middle = cell[0];
    cell[0] = std::max(middle - 1, 0);
    const int first = begin_[index_of(cell)];
    cell[0] = std::min(middle + 1, shape_[0] - 1);
    const int last = begin_[index_of(cell) + 1];
    for (int k = first; k < last; ++k)
      if (points_[k] != i) visit(points_[k]);
  }

  std::span<const Vec<Dim>> position_;
  Vec<Dim> low_{};
  double width_ = 0;
  Cell shape_{};
  std::vector<int> begin_, points_;
};

}  // namespace softgrain
