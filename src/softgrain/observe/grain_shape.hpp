#pragma once
#include <span>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// The shape of a grain's outline (theory (65)).
struct GrainShape {
  double area = 0;          ///< A [m^2]
  double perimeter = 0;     ///< P [m]
  double circularity = 0;   ///< 4 pi A/P^2, 1 for a circle
  double aspect_ratio = 0;  ///< sqrt of the ratio of the principal second moments, >= 1; a/b for an ellipse
};

/// Of a simple polygon, counter-clockwise, of non-zero area.
GrainShape grain_shape(std::span<const Vec<2>> outline);

}  // namespace softgrain
