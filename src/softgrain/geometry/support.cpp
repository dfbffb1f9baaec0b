#include "softgrain/geometry/support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace softgrain {

double support(std::span<const Vec<2>> position, std::span<const double> radius, const Vec<2>& direction) {
  double reach = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < position.size(); ++i)
    reach = std::max(reach, dot(position[i], direction) + radius[i]);
  return reach;
}

OutlineShape outline_shape(std::span<const Vec<2>> position, std::span<const double> radius,
                           const Vec<2>& centre, int directions) {
  double sum = 0, low = std::numeric_limits<double>::infinity(), high = 0;
  for (int k = 0; k < directions; ++k) {
    const double angle = 2 * std::numbers::pi * k / directions;
    const Vec<2> e{std::cos(angle), std::sin(angle)};
    const double h = support(position, radius, e) - dot(centre, e);
    sum += h;
    low = std::min(low, h);
    high = std::max(high, h);
  }
  const double mean = sum / directions;
  return {mean, (high - low) / mean};
}

}  // namespace softgrain
