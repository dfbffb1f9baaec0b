#include "softgrain/soft/reference_grid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"

namespace softgrain {
namespace {

/// Places on the border of the square [-1, 1]^2, counter-clockwise from a corner; 4n of them.
Vec<2> square_border(int k, int n) {
  const int side = k / n;
  const double along = -1 + 2.0 * (k % n) / n;
  switch (side) {
    case 0:
      return {along, -1};
    case 1:
      return {1, along};
    case 2:
      return {-along, 1};
    default:
      return {-1, -along};
  }
}

// The shape of the grid of a disk: found by scanning; the smallest point has 0.68 of the mean volume, the
// largest 1.38.
constexpr double square_half_width = 0.44;
constexpr double square_bulge = 0.4;   // 0: straight sides, 1: a circle
constexpr double ring_exponent = 0.8;  // wider rings inside

Vec<2> unit_circle(int k, int around) {
  const double angle = 2 * std::numbers::pi * k / around - 0.75 * std::numbers::pi;
  return {std::cos(angle), std::sin(angle)};
}

/// The bulged border of the inner square.
Vec<2> inner_border(int k, int n) {
  return square_half_width * ((1 - square_bulge) * square_border(k, n) +
                              square_bulge * std::numbers::sqrt2 * unit_circle(k, 4 * n));
}

/// Inside of the bulged square: Coons' patch of its four sides.
Vec<2> inner_node(int i, int j, int n) {
  const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
  const auto border = [n](int k) { return inner_border(k % (4 * n), n); };
  const Vec<2> sides =
      (1 - v) * border(i) + v * border(3 * n - i) + (1 - u) * border(4 * n - j) + u * border(n + j);
  const Vec<2> corners = (1 - u) * (1 - v) * border(0) + u * (1 - v) * border(n) + u * v * border(2 * n) +
                         (1 - u) * v * border(3 * n);
  return sides - corners;
}

/// FE stiffness of Laplace's equation on the grid, as rows of (node, weight) without the diagonal.
std::vector<std::vector<std::pair<int, double>>> laplace_rows(const ReferenceGrid& grid) {
  std::vector<std::map<int, double>> rows(grid.nodes());
  const std::vector<MaterialPoint> points = material_points(grid);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto& cell = grid.cell[p / 4];
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (a != b)
          rows[cell[a]][cell[b]] -= points[p].volume * dot(points[p].gradient[a], points[p].gradient[b]);
  }
  std::vector<std::vector<std::pair<int, double>>> lists;
  for (const auto& row : rows) lists.emplace_back(row.begin(), row.end());
  return lists;
}

/// Carries the grid of the disk to another outline: positions become harmonic functions on the disk
/// (Rado-Kneser-Choquet: no cell folds if the outline is convex). Gauss-Seidel with over-relaxation.
void map_to_outline(ReferenceGrid& grid, std::span<const Vec<2>> outline) {
  const auto rows = laplace_rows(grid);
  std::copy(outline.begin(), outline.end(), grid.node.begin() + grid.outline_begin);
  constexpr int passes = 1000;
  constexpr double over_relaxation = 1.8;
  for (int pass = 0; pass < passes; ++pass) {
    for (int i = 0; i < grid.outline_begin; ++i) {
      Vec<2> sum;
      double weights = 0;
      for (const auto& [j, weight] : rows[i]) sum += weight * grid.node[j], weights += weight;
      grid.node[i] += over_relaxation * ((1 / weights) * sum - grid.node[i]);
    }
  }
}

MaterialPoint point_of_cell(const ReferenceGrid& grid, const std::array<int, 4>& cell, double xi,
                            double eta) {
  constexpr std::array<Vec<2>, 4> corner{Vec<2>{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  MaterialPoint point;
  std::array<Vec<2>, 4> local;  // dN/d(xi, eta)
  Mat<2> J;                     // dX/d(xi, eta)
  for (int a = 0; a < 4; ++a) {
    point.shape[a] = (1 + corner[a][0] * xi) * (1 + corner[a][1] * eta) / 4;
    local[a] = {corner[a][0] * (1 + corner[a][1] * eta) / 4, corner[a][1] * (1 + corner[a][0] * xi) / 4};
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) J(i, j) += grid.node[cell[a]][i] * local[a][j];
  }
  point.volume = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);  // weight 1 x det J
  for (int a = 0; a < 4; ++a) {
    // dN/dX = J^-T dN/d(xi, eta)
    point.gradient[a] = {(J(1, 1) * local[a][0] - J(1, 0) * local[a][1]) / point.volume,
                         (J(0, 0) * local[a][1] - J(0, 1) * local[a][0]) / point.volume};
  }
  return point;
}

}  // namespace

ReferenceGrid disk_grid(int n) {
  require(n >= 2, "a grain needs at least 2 cells along the side of its inner square, got {}", n);
  const int rings = disk_rings(n), around = 4 * n;
  ReferenceGrid grid;
  const auto inner = [&](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) grid.node.push_back(inner_node(i, j, n));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      grid.cell.push_back({inner(i, j), inner(i + 1, j), inner(i + 1, j + 1), inner(i, j + 1)});
  std::vector<int> ring(around);
  for (int k = 0; k < n; ++k) {
    ring[k] = inner(k, 0);
    ring[n + k] = inner(n, k);
    ring[2 * n + k] = inner(n - k, n);
    ring[3 * n + k] = inner(0, n - k);
  }
  for (int layer = 1; layer <= rings; ++layer) {
    const double share = std::pow(static_cast<double>(layer) / rings, ring_exponent);
    const int begin = grid.nodes();
    for (int k = 0; k < around; ++k) {
      const int next = (k + 1) % around;
      grid.node.push_back((1 - share) * inner_border(k, n) + share * unit_circle(k, around));
      grid.cell.push_back({ring[k], begin + k, begin + next, ring[next]});
    }
    for (int k = 0; k < around; ++k) ring[k] = begin + k;
  }
  grid.outline_begin = grid.nodes() - around;
  grid.fullness = std::numbers::pi / polygon_area(grid.outline());
  return grid;
}

ReferenceGrid outline_grid(std::span<const Vec<2>> outline, int n) {
  ReferenceGrid grid = disk_grid(n);
  require(static_cast<int>(outline.size()) == grid.outline_nodes(),
          "the outline of a grid of {} cells has {} vertices, not {}", n, grid.outline_nodes(),
          outline.size());
  map_to_outline(grid, outline);
  grid.fullness = 1;
  return grid;
}

std::optional<Vec<2>> folded_cell(const ReferenceGrid& grid) {
  const std::vector<MaterialPoint> points = material_points(grid);
  const auto worst = std::min_element(points.begin(), points.end(),
                                      [](const auto& a, const auto& b) { return a.volume < b.volume; });
  if (worst->volume > 0) return std::nullopt;
  Vec<2> centre;
  for (const int node : grid.cell[static_cast<std::size_t>(worst - points.begin()) / 4])
    centre += 0.25 * grid.node[node];
  return centre;
}

ReferenceGrid polygon_grid(std::span<const Vec<2>> vertices, int n) {
  require(is_simple_polygon(vertices), "the outline of {} vertices crosses or touches itself",
          vertices.size());
  std::vector<Vec<2>> ordered(vertices.begin(), vertices.end());
  if (polygon_area(ordered) < 0) std::reverse(ordered.begin(), ordered.end());
  ReferenceGrid grid = outline_grid(resample_polygon(ordered, 4 * n), n);
  require(!folded_cell(grid),
          "the outline of {} vertices is so concave that a cell of its grid folds; use more cells or a "
          "rounder outline",
          vertices.size());
  return grid;
}

std::vector<MaterialPoint> material_points(const ReferenceGrid& grid) {
  const double gauss = 1 / std::sqrt(3.0);
  std::vector<MaterialPoint> points;
  for (const auto& cell : grid.cell)
    for (const double eta : {-gauss, gauss})
      for (const double xi : {-gauss, gauss}) points.push_back(point_of_cell(grid, cell, xi, eta));
  return points;
}

}  // namespace softgrain
