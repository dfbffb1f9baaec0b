#include "softgrain/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

double cross_z(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

const Vec<2>& next_of(std::span<const Vec<2>> vertices, std::size_t k) {
  return vertices[(k + 1) % vertices.size()];
}

/// Segments ab and cd have a common point.
bool segments_meet(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
  const double c_side = cross_z(b - a, c - a), d_side = cross_z(b - a, d - a);
  const double a_side = cross_z(d - c, a - c), b_side = cross_z(d - c, b - c);
  const auto between = [](const Vec<2>& p, const Vec<2>& q, const Vec<2>& x) {
    return dot(x - p, x - q) <= 0;
  };
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) ||
         (a_side == 0 && between(c, d, a)) || (b_side == 0 && between(c, d, b));
}

}  // namespace

double polygon_area(std::span<const Vec<2>> vertices) {
  double twice = 0;
  for (std::size_t k = 0; k < vertices.size(); ++k) twice += cross_z(vertices[k], next_of(vertices, k));
  return twice / 2;
}

double polygon_perimeter(std::span<const Vec<2>> vertices) {
  double length = 0;
  for (std::size_t k = 0; k < vertices.size(); ++k) length += norm(next_of(vertices, k) - vertices[k]);
  return length;
}

Vec<2> polygon_centroid(std::span<const Vec<2>> vertices) {
  Vec<2> moment;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vec<2>&a = vertices[k], &b = next_of(vertices, k);
    moment += (cross_z(a, b) / 6) * (a + b);
  }
  return (1 / polygon_area(vertices)) * moment;
}

bool edges_meet(std::span<const Vec<2>> vertices, int i, int j) {
  const int n = static_cast<int>(vertices.size());
  const auto at = [&](int k) { return vertices[static_cast<std::size_t>(k % n)]; };
  const auto run_back = [&](int k) {  // on the edge before, or without a length
    const Vec<2> before = at(k) - at(k + n - 1), after = at(k + 1) - at(k);
    return cross_z(before, after) == 0 && dot(before, after) <= 0;
  };
  if ((i + 1) % n == j) return run_back(j);
  if ((j + 1) % n == i) return run_back(i);
  return segments_meet(at(i), at(i + 1), at(j), at(j + 1));
}

bool is_simple_polygon(std::span<const Vec<2>> vertices) {
  const int n = static_cast<int>(vertices.size());
  if (n < 3) return false;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      if (edges_meet(vertices, i, j)) return false;
  return true;
}

std::vector<Vec<2>> resample_polygon(std::span<const Vec<2>> vertices, int count) {
  const int n = static_cast<int>(vertices.size());
  require(count >= n, "an outline of {} vertices needs at least as many points, got {}", n, count);
  // pieces of each edge: one, then always one more where the pieces are longest
  std::vector<int> pieces(n, 1);
  std::vector<double> length(n);
  for (int k = 0; k < n; ++k) length[k] = norm(next_of(vertices, k) - vertices[k]);
  for (int extra = n; extra < count; ++extra) {
    int longest = 0;
    for (int k = 1; k < n; ++k)
      if (length[k] / pieces[k] > length[longest] / pieces[longest]) longest = k;
    ++pieces[longest];
  }
  std::vector<Vec<2>> points;
  for (int k = 0; k < n; ++k)
    for (int piece = 0; piece < pieces[k]; ++piece)
      points.push_back(vertices[k] +
                       (static_cast<double>(piece) / pieces[k]) * (next_of(vertices, k) - vertices[k]));
  return points;
}

}  // namespace softgrain
