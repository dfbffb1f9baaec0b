#include "softgrain/soft/arc_place.hpp"

#include <algorithm>
#include <cmath>

namespace softgrain {
namespace {

/// Along the outline at its vertex, counter-clockwise.
Vec<2> tangent_of(const std::array<Vec<2>, 3>& x) {
  const Vec<2> chord = x[2] - x[0];
  return (1 / norm(chord)) * chord;
}

}  // namespace

Vec<2> arc_centre(const std::array<Vec<2>, 3>& x, const OutlineArc& arc, double size) {
  return x[1] + (size * arc.radius) * perpendicular(tangent_of(x));
}

ArcPlace arc_place(const std::array<Vec<2>, 3>& x, const OutlineArc& arc, double size,
                   const Vec<2>& direction) {
  const Vec<2> t = tangent_of(x), in = perpendicular(t), middle = 0.5 * (x[0] + x[2]) - x[1];
  const bool away = dot(direction, in) >= 0;  // beyond an end of the arc
  const double wanted = dot(direction, t);
  const double sine =
      away ? std::copysign(arc.end_sine, wanted) : std::clamp(wanted, -arc.end_sine, arc.end_sine);
  const double r = size * arc.radius, rise = r * (1 - std::sqrt(1 - sine * sine));
  const double inward = rise / dot(middle, in);
  const double along = (r * sine - inward * dot(middle, t)) / (norm(x[2] - x[0]) / 2);
  return {x[1] + (r * sine) * t + rise * in, along, inward, away || sine != wanted};
}

}  // namespace softgrain
