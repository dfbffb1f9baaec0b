#pragma once
#include <vector>

#include "softgrain/geometry/periodic_cell.hpp"
#include "softgrain/geometry/wall.hpp"
#include "softgrain/math/padded_vec.hpp"

namespace softgrain {

/// Where the outlines are, and where they were at the start of the step.
template <int Dim>
struct OutlineStateOf {
  std::vector<ScatteredVec<Dim>> position, start;  ///< (outline vertices) [m]
  std::vector<Wall<Dim>> walls;                    ///< with their points at the end of the step
  double dt = 0;                                   ///< [s]
  /// Share of the step at which pairs take place and normal: half-way contact gives no energy; 1 where the
  /// step is quasi-static and its end must be an equilibrium (docs/decisions/0026).
  double normals_at = 0.5;
  PeriodicCell<Dim> cell{};  ///< at the end of the step
  /// (outline vertices) of the centre of a rigid sphere its radius times its turn over the step [m], else 0;
  /// empty where no grain is rigid
  std::vector<Vec<Dim>> rolled{};

  /// Where place and normal are taken [m].
  Vec<Dim> on_the_way(int vertex) const {
    return start[vertex] + normals_at * (position[vertex] - start[vertex]);
  }
};
using OutlineState = OutlineStateOf<2>;

}  // namespace softgrain
