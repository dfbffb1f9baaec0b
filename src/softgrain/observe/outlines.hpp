#pragma once
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// True deformed area of grains [m^2]: sum over outline polygons; grain g has the vertices begin[g] ..
/// begin[g + 1] - 1.
double total_area(std::span<const Vec<2>> outline, std::span<const int> begin);

/// Outline of a grain made of disks, counter-clockwise: what a probe disk of radius `probe` [m] that rolls
/// round the grain can touch. Notches narrower than the probe are bridged by straight lines, pores inside do
/// not exist; a probe of half a primary's size sees dents of the size of a primary and more. If the grain has
/// broken, the outline is that of the piece that reaches lowest. A single disk has a polygon of its area.
std::vector<Vec<2>> disk_outline(std::span<const Vec<2>> position, std::span<const double> radius,
                                 double probe);

}  // namespace softgrain
