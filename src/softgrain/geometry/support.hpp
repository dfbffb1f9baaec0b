#pragma once
#include <span>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// h(e) = max_i (x_i . e + R_i) [m]: how far a set of disks (spheres) reaches in direction e (unit).
template <int Dim>
double support(std::span<const Vec<Dim>> position, std::span<const double> radius, const Vec<Dim>& direction);

/// The k-th of `count` directions that are spread evenly: over the circle, or over the sphere on a spiral
/// whose turns are the golden angle apart.
template <int Dim>
Vec<Dim> even_direction(int k, int count);

/// The outline of a set of disks (spheres), seen from a centre through its support function over all
/// directions.
struct OutlineShape {
  double mean_radius = 0;  ///< mean of h [m] = perimeter of the hull / 2 pi (Cauchy), in space half its mean
                           ///< width: the radius R of a round grain
  double roundness = 0;    ///< (h_max - h_min) / mean h [-], 0 for a circle
};

/// Over `directions` equally spaced directions.
template <int Dim>
OutlineShape outline_shape(std::span<const Vec<Dim>> position, std::span<const double> radius,
                           const Vec<Dim>& centre, int directions = Dim == 2 ? 360 : 2000);

}  // namespace softgrain
