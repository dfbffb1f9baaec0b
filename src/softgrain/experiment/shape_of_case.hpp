#pragma once
#include <memory>
#include <utility>

#include "softgrain/experiment/case.hpp"
#include "softgrain/soft/topology.hpp"

namespace softgrain {

// The shape of the grains of a kind, of a case of one kind: elastic or rigid ones in the plane.

/// With the resolution of the case. Raises UsageError for outlines that cannot be, OutlineFolds for elastic
/// ones that are too concave.
std::shared_ptr<const Topology> grain_shape_of(const Case& kind);

/// Area over that of the circle of its diameter, which contains it, in space volume over that of the sphere:
/// 1 of a disk.
double area_share(const Case& kind);

/// Of one grain between two walls: how it is turned [rad].
inline double angle_between_walls(const Case& c) {
  return c.grain.shape == ShapeOfGrain::disk ? 0 : c.grain.angle;
}
/// Of one grain between two walls: where they touch it [m], its centre of area being the origin.
std::pair<double, double> between_walls(const Case& the_case);

/// Shortest edge of its cells over that of the disk's grid; 1 of a disk and of rigid grains.
double cell_share(const Case& kind);

/// The fewest cells with which all its corners are vertices.
int least_cells(const Case::Grain& grain);

}  // namespace softgrain
