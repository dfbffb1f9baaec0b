#pragma once
#include <algorithm>
#include <cmath>
#include <span>

#include "softgrain/contact/by_kinds.hpp"

namespace softgrain {

/// Adhesion of two surfaces (theory (78)): they attract each other by a traction that falls linearly with the
/// gap g, from sigma_0 to 0 at the range delta,
///   t(g) = sigma_0 (1 - g/delta),  w = sigma_0 delta/2,  Phi(g) = -w (1 - g/delta)^2,
/// t = dPhi/dg >= 0 pulling; t = sigma_0 for g < 0.
struct Adhesion {
  double surface_energy = 0;  ///< w [J/m^2], what it takes to part a unit of surface
  double range = 0;           ///< delta [m]

  bool any() const { return surface_energy > 0; }
  double strength() const { return 2 * surface_energy / range; }  ///< sigma_0 [Pa]
  /// t [Pa] at a gap [m].
  double traction(double gap) const { return strength() * (1 - std::clamp(gap, 0.0, range) / range); }
  /// Phi [J/m^2], 0 beyond the range.
  double energy(double gap) const {
    const double left = 1 - std::clamp(gap, 0.0, range) / range;
    return -surface_energy * left * left + strength() * std::min(gap, 0.0);
  }

  /// (Phi(g') - Phi(g))/(g' - g) [Pa]: the traction that takes from a motion from g to g' what Phi gains
  /// (theory (80)); t(g) where they are equal.
  double mean_traction(double gap, double next) const {
    const double way = next - gap;
    if (std::abs(way) < 1e-12 * range) return traction((gap + next) / 2);
    const double from = std::clamp(gap, 0.0, range), to = std::clamp(next, 0.0, range);
    const double within = (to - from) * (1 - (from + to) / (2 * range));
    return strength() * ((within + (std::min(next, 0.0) - std::min(gap, 0.0))) / way);
  }
};

/// Adhesion of the grains of two kinds, or of a kind and walls.
struct PairAdhesion {
  static constexpr int wall = ByKinds<Adhesion>::wall;
  int kind = 0;
  int other = wall;  ///< another kind, the same, or `wall`
  Adhesion law{};
};

/// Adhesion of every pair of kinds: none but of those named. Raises UsageError for a surface energy < 0 or a
/// range <= 0, and for kinds that are not there.
ByKinds<Adhesion> adhesion_by_kinds(int kinds, std::span<const PairAdhesion> named);
/// The longest range [m]; 0: nothing adheres.
double longest_range(std::span<const PairAdhesion> named);

}  // namespace softgrain
