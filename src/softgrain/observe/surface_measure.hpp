#pragma once

namespace softgrain {

/// Volume and area of a closed surface.
struct SurfaceMeasure {
  double volume = 0;  ///< [m^3]
  double area = 0;    ///< [m^2]
};

}  // namespace softgrain
