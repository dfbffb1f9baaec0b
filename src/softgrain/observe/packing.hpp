#pragma once
#include <numbers>
#include <span>

namespace softgrain {

/// How densely a box is filled, by both measures of a grain's area (theory (54)).
struct PackingFraction {
  double undeformed = 0;  ///< Phi_0 = sum pi R^2 / A: that of the paper's Phi = 0.7 e^eps
  double deformed = 0;    ///< Phi = sum of A_g, the areas of the deformed grains / A
};

/// Radii of the undeformed grains [m], the area of all deformed grains and that of the box [m^2].
inline PackingFraction packing_fraction(std::span<const double> radius, double grain_area, double box_area) {
  double squares = 0;
  for (const double R : radius) squares += R * R;
  return {.undeformed = std::numbers::pi * squares / box_area, .deformed = grain_area / box_area};
}

}  // namespace softgrain
