#include "softgrain/observe/grain_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/sym_eigen.hpp"

namespace softgrain {
namespace {

/// M = integral over the polygon of (x - c) (x) (x - c) dA [m^4], c its centre of area: each triangle (c, a,
/// b) has area/12 (a (x) a + b (x) b + (a + b) (x) (a + b)).
Mat<2> second_moment(std::span<const Vec<2>> outline) {
  const Vec<2> centre = polygon_centroid(outline);
  Mat<2> M;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec<2> a = outline[k] - centre, b = outline[(k + 1) % outline.size()] - centre, sum = a + b;
    const double area = 0.5 * (a[0] * b[1] - a[1] * b[0]);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) M(i, j) += area / 12 * (a[i] * a[j] + b[i] * b[j] + sum[i] * sum[j]);
  }
  return M;
}

}  // namespace

GrainShape grain_shape(std::span<const Vec<2>> outline) {
  const double area = polygon_area(outline), perimeter = polygon_perimeter(outline);
  const Vec<2> moments = sym_eigen(second_moment(outline)).values;
  return {.area = area,
          .perimeter = perimeter,
          .circularity = 4 * std::numbers::pi * area / (perimeter * perimeter),
          .aspect_ratio = std::sqrt(std::max(moments[0], moments[1]) / std::min(moments[0], moments[1]))};
}

}  // namespace softgrain
