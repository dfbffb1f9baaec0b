#pragma once
#include "softgrain/sample/box_sample.hpp"

namespace softgrain {

struct PourOptions {
  BoxSampleOptions grains;  ///< its packing fraction and aspect give the width of the box, not its height
  double friction = 0;      ///< mu between grains
  double wall_friction = 0;
};

/// Grains that have fallen into a box along -y and lie at rest, without overlap; the height of the box is
/// that of the highest point of a grain.
///
/// They fall as rigid disks of their sizes by contact dynamics, without bouncing, in a drag that lets them
/// fall at v = sqrt(g <R>) at most: f = m (g - (g/v) v). What lies at rest depends on no unit of g. The same
/// seed gives the same bits. Raises UsageError where the loose sample above the box cannot be placed, and for
/// a box that repeats along y.
BoxSample pour(const PourOptions& options);

}  // namespace softgrain
