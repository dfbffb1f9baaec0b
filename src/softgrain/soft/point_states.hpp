#pragma once
#include <array>
#include <vector>

#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// What one material point feels.
struct PointState {
  Mat<2> F;              ///< deformation gradient, 1 as the grain was placed
  Mat<2> stress;         ///< Cauchy stress sigma = P F^T / J [Pa], tension positive, in plane
  double pressure;       ///< -tr(sigma)/2 [Pa], compression positive; of laws that flow -tr(sigma)/3 in space
  double von_mises = 0;  ///< sqrt(3/2) |dev sigma| [Pa] of laws that flow
  double plastic_strain = 0;  ///< alpha
};
/// All points of the grain in each lane of a batch whose bit is set, four by four in the order of the cells;
/// U' at the mean of the cell.
std::array<std::vector<PointState>, Wide::size> point_states(const SoftGrains& grains,
                                                             const GrainBatch& batch, unsigned lanes);
/// Of one grain.
std::vector<PointState> point_states(const SoftGrains& grains, int grain);

}  // namespace softgrain
