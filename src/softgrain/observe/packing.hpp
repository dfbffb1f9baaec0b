#pragma once
#include <numbers>
#include <span>

#include "softgrain/math/vec.hpp"
#include "softgrain/observe/outlines.hpp"

namespace softgrain {

/// How densely a box is filled, by both measures of a grain's area (theory (54)).
struct PackingFraction {
  double undeformed = 0;  ///< Phi_0 = sum pi R^2 / A: that of the paper's Phi = 0.7 e^eps
  double deformed = 0;    ///< Phi = sum of the areas within the outlines / A
};

/// Radii of the undeformed grains and the box's area in [m], [m^2]; grain g has the vertices begin[g] ..
/// begin[g + 1] - 1 of the outlines.
inline PackingFraction packing_fraction(std::span<const double> radius, std::span<const Vec<2>> outline,
                                        std::span<const int> begin, double box_area) {
  double squares = 0;
  for (const double R : radius) squares += R * R;
  return {.undeformed = std::numbers::pi * squares / box_area,
          .deformed = total_area(outline, begin) / box_area};
}

}  // namespace softgrain
