#pragma once
#include <array>
#include <functional>

#include "softgrain/math/block_cholesky.hpp"
#include "softgrain/soft/history.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// Internal force of the eight grains of a batch, f_i = sum_p V_p P_p dN_i/dX [N/m], at the positions given,
/// from
///   F_p = sum_i x_i (x) dN_i/dX,  P = dpsi_dev/dF + U'(theta) dtheta/dF, theta the mean over the cell
/// (mean dilatation). X lies as the grain was placed, so that F = 1 there. Overwrites `force` (nodes).
/// Returns the lanes in which some point has det F <= 0, whatever the law: bit l; their force is void. A law
/// with history goes on from the grains' history over dt [s]; 0: as it stands, what takes time has none.
unsigned internal_force(const SoftGrains& grains, const GrainBatch& batch, WideVectors& force, double dt = 0);

/// The same in one pass with advance_history, at the same positions: both begin with the same trial. Where a
/// point is inverted the history is void too.
unsigned internal_force_and_history(const SoftGrains& grains, GrainBatch& batch, WideVectors& force,
                                    double dt, FlowOfStep& flow);

/// The ten blocks K_ab, b <= a, of a cell, from a = 0 on; a block is row by row [Pa].
using CellStiffness = std::array<std::array<Wide, 4>, 10>;

/// visit(cell, its tangent stiffness) for all cells of the eight grains.
void for_each_cell_stiffness(const SoftGrains& grains, const GrainBatch& batch, double dt,
                             const std::function<void(int cell, const CellStiffness& K)>& visit);

/// Adds the tangent stiffness K_ij = df_i/dx_j = sum_p V_p dN_i/dX . dP/dF . dN_j/dX [Pa], and what
/// the mean over the cell adds, to the matrix.
void add_stiffness(const SoftGrains& grains, const GrainBatch& batch, BatchedCholesky& matrix, double dt = 0);

/// Elastic energy sum_p V_p psi_dev(F_p) + sum_cells V U(theta) [J/m] of each grain of the batch; of a law
/// with history what is stored now.
Wide elastic_energy(const SoftGrains& grains, const GrainBatch& batch);

/// Smallest J = det F of the points of each grain.
Wide least_J(const GrainBatch& batch);

}  // namespace softgrain
