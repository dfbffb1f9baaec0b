#pragma once
#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/math/lanes.hpp"

namespace softgrain {

/// The attraction between primary particles of one grain (the paper's Eq. (1), theory (14)): with r the
/// distance of the centres, a0 = a1 + a2 and gap g = r - a0,
///   F = F0 (1 + g/a0)^-gamma = F0 (a0/r)^gamma  for r >= a0,   F = F0 under overlap,   0 beyond r = 2 a0.
/// Positive towards each other.
struct Attraction {
  double F0 = 100;   ///< [N/m in the plane, N in space]
  double gamma = 7;  ///< [-]

  /// F [N/m, N in space] at distance r [m].
  double force(double r, double a0) const {
    if (r > 2 * a0) return 0;
    return F0 * std::pow(std::min(1.0, a0 / r), gamma);
  }

  /// Potential [J/m, J in space], zero beyond the cut: U(r) = -integral from r to 2 a0 of F.
  double energy(double r, double a0) const {
    if (r > 2 * a0) return 0;
    if (r < a0) return energy(a0, a0) - F0 * (a0 - r);
    if (gamma == 1) return -F0 * a0 * std::log(2 * a0 / r);
    return -F0 * a0 / (gamma - 1) * (std::pow(a0 / r, gamma - 1) - std::pow(0.5, gamma - 1));
  }

  /// F(r)/r for four pairs at once, from r^2 and a0 [N/m^2, N/m in space].
  Lanes force_over_distance(Lanes r_squared, Lanes a0) const {
    const Lanes a0_squared = a0 * a0;
    const Lanes closeness = min(a0_squared / r_squared, splat(1));  // min(1, a0^2/r^2)
    Lanes over_distance;
    if (gamma == 7) {
      const Lanes square = closeness * closeness;
      over_distance = F0 / a0 * (square * square) * overlap_factor(r_squared / a0_squared);
    } else {
      for (int lane = 0; lane < lane_count; ++lane) {
        const double r = std::sqrt(r_squared[lane]);
        over_distance[lane] = F0 * std::pow(std::min(1.0, a0[lane] / r), gamma) / r;
      }
    }
    return r_squared > 4 * a0_squared ? splat(0) : over_distance;
  }

 private:
  /// a0/r under overlap, else 1, without a square root: 1/sqrt(1 - y), y = max(0, 1 - r^2/a0^2), by two
  /// Newton steps from 1 + y/2; exact to round-off for overlaps below 1 %, to 2e-7 at 10 %.
  static Lanes overlap_factor(Lanes ratio_squared) {
    const Lanes x = min(ratio_squared, splat(1));
    Lanes root = 1.5 - 0.5 * x;
    for (int newton = 0; newton < 2; ++newton) root = root * (1.5 - 0.5 * x * root * root);
    return root;
  }
};

/// Raises UsageError for a law that cannot hold a grain.
inline void require_valid(const Attraction& law) {
  require(law.F0 > 0 && std::isfinite(law.F0), "attraction F0 must be > 0, got {}", law.F0);
  require(law.gamma > 0 && std::isfinite(law.gamma), "attraction exponent must be > 0, got {}", law.gamma);
}

}  // namespace softgrain
