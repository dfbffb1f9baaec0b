#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "softgrain/soft/soft_grains.hpp"

namespace softgrain::test {

/// Largest difference of the forces on these nodes from central differences of the elastic energy, with nodes
/// moved by `step` to both sides.
template <int Dim>
double worst_of_energy_differences(const GrainsOf<Dim>& grains, BatchOf<Dim>& batch,
                                   const WidePlaces<Dim>& force, const std::vector<std::size_t>& nodes,
                                   double step) {
  double worst = 0;
  for (const std::size_t i : nodes)
    for (int d = 0; d < Dim; ++d) {
      const Wide x = batch.position[i][d];
      batch.position[i][d] = x + Wide(step);
      const Wide above = elastic_energy(grains, batch);
      batch.position[i][d] = x - Wide(step);
      const Wide below = elastic_energy(grains, batch);
      batch.position[i][d] = x;
      for (int lane = 0; lane < Wide::size; ++lane)
        worst = std::max(worst, std::abs((above - below)[lane] / (2 * step) - force[i][d][lane]));
    }
  return worst;
}

}  // namespace softgrain::test
