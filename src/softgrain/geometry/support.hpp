#pragma once
#include <span>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// h(e) = max_i (x_i . e + R_i) [m]: how far a set of disks reaches in direction e (unit).
double support(std::span<const Vec<2>> position, std::span<const double> radius, const Vec<2>& direction);

/// The outline of a set of disks, seen from a centre through its support function over all directions.
struct OutlineShape {
  double mean_radius =
      0;  ///< mean of h [m] = perimeter of the hull / 2 pi (Cauchy): the radius R of a round grain
  double roundness = 0;  ///< (h_max - h_min) / mean h [-], 0 for a circle
};

/// Over `directions` equally spaced directions.
OutlineShape outline_shape(std::span<const Vec<2>> position, std::span<const double> radius,
                           const Vec<2>& centre, int directions = 360);

}  // namespace softgrain
