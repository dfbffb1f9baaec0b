#include "softgrain/geometry/support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace softgrain {

template <int Dim>
double support(std::span<const Vec<Dim>> position, std::span<const double> radius,
               const Vec<Dim>& direction) {
  double reach = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < position.size(); ++i)
    reach = std::max(reach, dot(position[i], direction) + radius[i]);
  return reach;
}

template <>
Vec<2> even_direction<2>(int k, int count) {
  const double angle = 2 * std::numbers::pi * k / count;
  return {std::cos(angle), std::sin(angle)};
}
template <>
Vec<3> even_direction<3>(int k, int count) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  const double z = 1 - (2 * k + 1.0) / count, across = std::sqrt(1 - z * z);
  return {across * std::cos(golden_angle * k), across * std::sin(golden_angle * k), z};
}

template <int Dim>
OutlineShape outline_shape(std::span<const Vec<Dim>> position, std::span<const double> radius,
                           const Vec<Dim>& centre, int directions) {
  double sum = 0, low = std::numeric_limits<double>::infinity(), high = 0;
  for (int k = 0; k < directions; ++k) {
    const auto e = even_direction<Dim>(k, directions);
    const double h = support<Dim>(position, radius, e) - dot(centre, e);
    sum += h;
    low = std::min(low, h);
    high = std::max(high, h);
  }
  const double mean = sum / directions;
  return {mean, (high - low) / mean};
}

template double support<2>(std::span<const Vec<2>>, std::span<const double>, const Vec<2>&);
template double support<3>(std::span<const Vec<3>>, std::span<const double>, const Vec<3>&);
template OutlineShape outline_shape<2>(std::span<const Vec<2>>, std::span<const double>, const Vec<2>&, int);
template OutlineShape outline_shape<3>(std::span<const Vec<3>>, std::span<const double>, const Vec<3>&, int);

}  // namespace softgrain
