#pragma once
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {

/// Lamé's parameters [Pa].
struct Lame {
  double lambda = 0;
  double mu = 0;  ///< shear modulus

  /// Speed of pressure waves [m/s] in the unstrained material: c = sqrt((lambda + 2 mu) / density).
  double wave_speed(double density) const { return std::sqrt((lambda + 2.0 * mu) / density); }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu (theory (37)): lambda = E nu / ((1 + nu) (1 - 2 nu)),
/// mu = E / (2 (1 + nu)). UsageError unless 0 < E < infinity and -1 < nu < 1/2.
inline Lame lame(double E, double nu) {
  require(E > 0 && std::isfinite(E), "Young's modulus must be > 0 Pa, got {}", E);
  require(nu > -1 && nu < 0.5, "Poisson's ratio must be > -1 and < 0.5 (0.5 is incompressible), got {}", nu);
  return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))};
}

}  // namespace softgrain
