#include "softgrain/soft/solid_grid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {
namespace {

// The shape of the grid of a ball: found by scanning for the longest stable step; the smallest point has 0.3
// of the mean volume, the largest 2.1.
constexpr double cube_half_width = 0.42;
constexpr double cube_bulge = 0.51;     // 0: plane faces, 1: a sphere of the radius below
constexpr double bulge_radius = 1.054;  // over the half width
constexpr double bulge_exponent = 2.18;
constexpr double layer_exponent = 0.8;  // thicker layers inside

using Place = std::array<int, 3>;

constexpr std::array<Vec<3>, 8> corner{Vec<3>{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                       Vec<3>{-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

/// Where a place of the cube [-1, 1]^3 points to: equal angles along its faces.
Vec<3> direction(const Vec<3>& c) {
  Vec<3> d;
  for (int k = 0; k < 3; ++k) d[k] = std::tan(std::numbers::pi / 4 * c[k]);
  return (1 / norm(d)) * d;
}

Vec<3> on_cube(const Place& place, int n) {
  Vec<3> c;
  for (int k = 0; k < 3; ++k) c[k] = 2.0 * place[static_cast<std::size_t>(k)] / n - 1;
  return c;
}

/// Of a place of the cube within the bulged cube.
Vec<3> inner_place(const Vec<3>& c) {
  const double r = std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])});
  if (r == 0) return {};
  const double bulge = cube_bulge * std::pow(r, bulge_exponent);
  return cube_half_width * ((1 - bulge) * c + (bulge * bulge_radius * r) * direction((1 / r) * c));
}

/// The faces of the cells on the cube's outside, counter-clockwise seen from there.
std::vector<std::array<Place, 4>> outer_faces(int n) {
  std::vector<std::array<Place, 4>> faces;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          std::array<Place, 4> face;
          for (std::size_t k = 0; k < 4; ++k) {
            face[k][axis] = side;
            face[k][(axis + 1) % 3] = i + (k == 1 || k == 2 ? 1 : 0);
            face[k][(axis + 2) % 3] = j + (k >= 2 ? 1 : 0);
          }
          if (side == 0) std::swap(face[1], face[3]);
          faces.push_back(face);
        }
  return faces;
}

SolidPoint point_of_brick(const SolidGrid& grid, const std::array<int, 8>& cell, const Vec<3>& at) {
  SolidPoint point;
  std::array<Vec<3>, 8> local;  // dN/d(xi, eta, zeta)
  Mat<3> J;                     // dX/d(xi, eta, zeta)
  for (std::size_t a = 0; a < 8; ++a) {
    const Vec<3>& c = corner[a];
    const Vec<3> f{1 + c[0] * at[0], 1 + c[1] * at[1], 1 + c[2] * at[2]};
    point.shape[a] = f[0] * f[1] * f[2] / 8;
    local[a] = {c[0] * f[1] * f[2] / 8, c[1] * f[0] * f[2] / 8, c[2] * f[0] * f[1] / 8};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) J(i, j) += grid.node[static_cast<std::size_t>(cell[a])][i] * local[a][j];
  }
  point.volume = determinant(J);  // weight 1 x det J
  const Mat<3> to_X = transpose(inverse(J));
  for (std::size_t a = 0; a < 8; ++a) point.gradient[a] = to_X * local[a];
  return point;
}

double volume_of_cells(const SolidGrid& grid) {
  double volume = 0;
  for (const SolidPoint& point : material_points(grid)) volume += point.volume;
  return volume;
}

}  // namespace

SolidGrid ball_grid(int n) {
  require(n >= 2, "a grain needs at least 2 cells along the side of its inner cube, got {}", n);
  SolidGrid grid;
  const auto inner = [n](const Place& p) { return (p[2] * (n + 1) + p[1]) * (n + 1) + p[0]; };
  std::map<Place, int> layer;  // the nodes of the last layer
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const Place place{i, j, k};
        grid.node.push_back(inner_place(on_cube(place, n)));
        if (std::any_of(place.begin(), place.end(), [n](int at) { return at == 0 || at == n; }))
          layer[place] = inner(place);
      }
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        grid.cell.push_back({inner({i, j, k}), inner({i + 1, j, k}), inner({i + 1, j + 1, k}),
                             inner({i, j + 1, k}), inner({i, j, k + 1}), inner({i + 1, j, k + 1}),
                             inner({i + 1, j + 1, k + 1}), inner({i, j + 1, k + 1})});
  const auto faces = outer_faces(n);
  const int layers = n / 2;
  for (int l = 1; l <= layers; ++l) {
    const double share = std::pow(static_cast<double>(l) / layers, layer_exponent);
    std::map<Place, int> next;
    grid.outline_begin = grid.nodes();
    for (const auto& [place, node] : layer) {
      const Vec<3> c = on_cube(place, n);
      next[place] = grid.nodes();
      grid.node.push_back((1 - share) * inner_place(c) + share * direction(c));
    }
    for (const auto& face : faces) {
      std::array<int, 8> cell;
      for (std::size_t k = 0; k < 4; ++k) cell[k] = layer[face[k]], cell[4 + k] = next[face[k]];
      grid.cell.push_back(cell);
    }
    layer = std::move(next);
  }
  for (const auto& face : faces)
    grid.quad.push_back({layer[face[0]], layer[face[1]], layer[face[2]], layer[face[3]]});
  grid.fullness = 4 * std::numbers::pi / 3 / volume_of_cells(grid);
  return grid;
}

std::vector<SolidPoint> material_points(const SolidGrid& grid) {
  constexpr double gauss = std::numbers::inv_sqrt3;
  std::vector<SolidPoint> points;
  for (const auto& cell : grid.cell)
    for (const double zeta : {-gauss, gauss})
      for (const double eta : {-gauss, gauss})
        for (const double xi : {-gauss, gauss}) points.push_back(point_of_brick(grid, cell, {xi, eta, zeta}));
  return points;
}

}  // namespace softgrain
