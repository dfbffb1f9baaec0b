#pragma once
#include "softgrain/geometry/outline_curve.hpp"
#include "softgrain/soft/topology.hpp"

namespace softgrain {

// Rigid grains within the circle of unit radius about their centre of mass, the outline through so many
// vertices. They raise UsageError for fewer than 8.

Topology rigid_disk(int vertices);
/// aspect: long over short axis, the long one along x. Raises UsageError for less than 1.
Topology rigid_ellipse(double aspect, int vertices);
/// Regular, a corner on the x axis; each side has the same number of vertices, about as many as asked for in
/// all. Raises UsageError for fewer than 3 sides.
Topology rigid_polygon(int sides, int vertices);
/// Smooth but for its corners, each of which is a vertex. Raises UsageError for more corners than vertices.
Topology rigid_outline(const OutlineCurve& curve, int vertices);

}  // namespace softgrain
