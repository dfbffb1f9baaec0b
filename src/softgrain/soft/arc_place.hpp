#pragma once
#include "softgrain/soft/topology.hpp"

namespace softgrain {

/// The place of a rigid outline's arc that lies furthest in a direction. It moves with three vertices,
///   p = x + along (x_after - x_before)/2 + inward ((x_after + x_before)/2 - x),
/// so exactly in a rigid motion.
struct ArcPlace {
  Vec<2> x;  ///< p [m]
  double along = 0, inward = 0;
  bool at_end = false;  ///< of the arc, which does not go on in that direction
};

/// x: before the vertex, at it and after it [m]; size: R [m]; direction: unit, out of the grain.
ArcPlace arc_place(const std::array<Vec<2>, 3>& x, const OutlineArc& arc, double size,
                   const Vec<2>& direction);

/// Centre of the arc's circle [m].
Vec<2> arc_centre(const std::array<Vec<2>, 3>& x, const OutlineArc& arc, double size);

}  // namespace softgrain
