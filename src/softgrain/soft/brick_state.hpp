#pragma once
#include <array>

#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// The eight points of a cell in the eight grains: F of each.
struct BrickState {
  BrickState(const BatchOf<3>& batch, int cell_index)
      : index(cell_index),
        nodes(batch.topology->grid.cell[static_cast<std::size_t>(cell_index)]),
        points(&batch.topology->points[8 * static_cast<std::size_t>(cell_index)]) {
    // F = sum_(a > 0) (x_a - x_0) (x) dN_a/dX, as sum_a N_a = 1
    const Wide inverse_radius = 1.0 / batch.radius;
    const auto x = [&](std::size_t a) { return batch.position[static_cast<std::size_t>(nodes[a])]; };
    for (std::size_t a = 1; a < 8; ++a) {
      const Vec<3, Wide> edge = inverse_radius * (x(a) - x(0));
      for (std::size_t p = 0; p < 8; ++p)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) F[p](i, j) += edge[i] * points[p].gradient[a][j];
    }
    for (std::size_t p = 0; p < 8; ++p) volume += points[p].volume;
  }

  /// U' belongs to the mean of theta, or to that of the point.
  template <class Law>
  std::array<Wide, 8> thetas(const Law& law, bool mean_dilatation) const {
    std::array<Wide, 8> theta;
    Wide mean = 0.0;
    for (std::size_t p = 0; p < 8; ++p) {
      theta[p] = law.dilatation().value(F[p]);
      mean += Wide(points[p].volume / volume) * theta[p];
    }
    if (mean_dilatation) theta.fill(mean);
    return theta;
  }

  /// part(theta) of each point, U or U'; once where all have the mean.
  template <class Part>
  static std::array<Wide, 8> of_each(const std::array<Wide, 8>& theta, bool mean_dilatation,
                                     const Part& part) {
    std::array<Wide, 8> values;
    if (mean_dilatation)
      values.fill(part(theta[0]));
    else
      for (std::size_t p = 0; p < 8; ++p) values[p] = part(theta[p]);
    return values;
  }

  int index;  ///< of the cell
  const std::array<int, 8>& nodes;
  const SolidPoint* points;
  double volume = 0;  ///< [R^3]
  std::array<Mat<3, Wide>, 8> F{};
};

/// visit(state) for all cells of a batch.
template <class Visit>
void for_each_cell(const BatchOf<3>& batch, Visit&& visit) {
  for (int cell = 0; cell < static_cast<int>(batch.topology->grid.cell.size()); ++cell)
    visit(BrickState(batch, cell));
}

}  // namespace softgrain
