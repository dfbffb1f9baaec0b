#pragma once
#include <array>
#include <vector>

#include "softgrain/math/tensor.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

using WideMat = Mat<2, Wide>;

/// Q of a batch: by which each grain was turned when it was placed.
inline WideMat placed_rotation(const GrainBatch& batch) {
  const auto& [c, s] = batch.placed_along.c;
  return {{c, -s, s, c}};
}

/// The four points of a cell in the eight grains: F of each. A law that is not objective needs F = 1 in the
/// grain as it was placed: it sees Q^T F, which to an isotropic law is as good as F Q^T, and its forces are
/// turned back by Q.
struct CellState {
  CellState(const GrainBatch& batch, int cell_index, bool turned_back)
      : index(cell_index),
        cell(batch.topology->grid.cell[cell_index]),
        points(&batch.topology->points[4 * cell_index]),
        volume(1 / batch.topology->cell_shapes[cell_index].inverse_volume) {
    // F = sum_a x_a (x) dN_a/dX = sum_(a > 0) (x_a - x_0) (x) dN_a/dX, as sum_a N_a = 1
    const Wide inverse_radius = 1.0 / batch.radius;
    std::array<Vec<2, Wide>, 4> edge;
    for (int a = 1; a < 4; ++a)
      edge[a] = inverse_radius * (batch.position[cell[a]] - batch.position[cell[0]]);
    if (turned_back)
      for (int a = 1; a < 4; ++a) edge[a] = transpose(placed_rotation(batch)) * edge[a];
    for (int p = 0; p < 4; ++p) {
      const auto& g = points[p].gradient;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          F[p](i, j) = edge[1][i] * g[1][j] + edge[2][i] * g[2][j] + edge[3][i] * g[3][j];
    }
  }
  /// Mean of theta over the cell, weighted by volume.
  template <class Dilatation>
  Wide mean(const Dilatation& theta) const {
    Wide sum = 0.0;
    for (int p = 0; p < 4; ++p) sum += points[p].volume * theta.value(F[p]);
    return sum * Wide(1 / volume);
  }

  int index;  ///< of the cell
  const std::array<int, 4>& cell;
  const MaterialPoint* points;
  double volume;  ///< [R^2]
  std::array<WideMat, 4> F;
};

/// visit(state) for all cells of a batch.
template <class Law, class Visit>
void for_each_cell(const Law&, const GrainBatch& batch, Visit&& visit) {
  for (int cell = 0; cell < static_cast<int>(batch.topology->grid.cell.size()); ++cell)
    visit(CellState(batch, cell, !Law::objective));
}

}  // namespace softgrain
