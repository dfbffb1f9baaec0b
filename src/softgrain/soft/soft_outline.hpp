#pragma once
#include <string>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/outline_curve.hpp"
#include "softgrain/soft/topology.hpp"

namespace softgrain {

// Elastic grains that are no disks, within the circle of unit radius about their centre of area, on the grid
// of a disk carried to their outline. Their mass is that of the true body.

/// aspect: long over short axis, the long one along x; the disk's grid made narrow, vertices on the ellipse.
/// Raises UsageError for less than 1.
Topology soft_ellipse(double aspect, int cells);

/// The outline is smooth but for its corners, each of which is a vertex. Raises OutlineFolds, and UsageError
/// for more corners than 4 cells.
Topology soft_outline(const OutlineCurve& curve, int cells);

/// Regular, a corner on the x axis.
Topology soft_polygon(int sides, int cells);

/// The outline is so concave that no grid fits.
class OutlineFolds : public UsageError {
 public:
  OutlineFolds(const std::string& message, const Vec<2>& where) : UsageError(message), place(where) {}
  Vec<2> place;  ///< of a cell that folds, in the units and the place of the curve
};

}  // namespace softgrain
