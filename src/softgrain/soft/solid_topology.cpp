#include "softgrain/soft/solid_topology.hpp"

#include <map>
#include <numbers>
#include <utility>

namespace softgrain {
namespace {

LaplaceRows rows_of_laplace(const SolidGrid& grid, const std::vector<SolidPoint>& points) {
  std::vector<std::map<int, double>> rows(grid.node.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto& cell = grid.cell[p / 8];
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t b = 0; b < 8; ++b)
        if (a != b)
          rows[cell[a]][cell[b]] += points[p].volume * dot(points[p].gradient[a], points[p].gradient[b]);
  }
  LaplaceRows laplace{.begin = {0}, .column = {}, .weight = {}};
  for (const auto& row : rows) {
    for (const auto& [column, weight] : row) {
      laplace.column.push_back(column);
      laplace.weight.push_back(weight);
    }
    laplace.begin.push_back(static_cast<int>(laplace.column.size()));
  }
  return laplace;
}

/// Of the outline, from its first vertex on.
std::vector<std::array<int, 4>> quads_of_vertices(const SolidGrid& grid) {
  std::vector<std::array<int, 4>> quads(grid.outline_nodes(), {-1, -1, -1, -1});
  for (std::size_t q = 0; q < grid.quad.size(); ++q)
    for (const int node : grid.quad[q]) {
      auto& list = quads[node - grid.outline_begin];
      std::size_t free = 0;
      while (list[free] >= 0) ++free;
      list[free] = static_cast<int>(q);
    }
  return quads;
}

}  // namespace

SolidTopology::SolidTopology(SolidGrid reference_grid)
    : grid(std::move(reference_grid)),
      points(material_points(grid)),
      laplace(rows_of_laplace(grid, points)),
      node_volume(grid.node.size(), 0),
      quads_round(quads_of_vertices(grid)) {
  std::vector<std::array<int, 4>> quads;
  for (auto quad : grid.quad) {
    for (int& node : quad) node -= grid.outline_begin;
    quads.push_back(quad);
  }
  patches = patch_nets(quads, quads_round);
  middles = middles_of(patches);
  const double inside = measure_surface(patches, &grid.node[grid.outline_begin]).volume;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (p % 8 == 0) cell_shapes.emplace_back();
    BrickShape& shape = cell_shapes.back();
    shape.inverse_volume[p % 8] = 1 / (8 * points[p].volume);
    shape.inverse_of_all += 8 * points[p].volume;
    volume += grid.fullness * points[p].volume;
    for (std::size_t a = 0; a < 8; ++a)
      node_volume[grid.cell[p / 8][a]] += grid.fullness * points[p].shape[a] * points[p].volume;
  }
  patch_fullness = volume / inside;
  for (BrickShape& shape : cell_shapes) shape.inverse_of_all = 1 / shape.inverse_of_all;
}

SolidTopology::SolidTopology(SolidGrid outline, double body_volume, double moment)
    : SolidTopology(std::move(outline)) {
  volume = body_volume;
  patch_fullness = volume / measure_surface(patches, grid.node.data()).volume;
  double squares = 0;
  for (const Vec<3>& X : grid.node) squares += dot(X, X);
  node_volume.assign(grid.node.size(), moment / squares);
  node_volume.back() = volume - static_cast<double>(grid.node.size() - 1) * (moment / squares);
}

SolidTopology rigid_ball(int n) {
  const SolidGrid ball = ball_grid(n);
  SolidGrid outline;
  outline.node.assign(ball.node.begin() + ball.outline_begin, ball.node.end());
  outline.node.push_back({0, 0, 0});
  outline.quad = ball.quad;
  for (auto& quad : outline.quad)
    for (int& node : quad) node -= ball.outline_begin;
  constexpr double volume = 4 * std::numbers::pi / 3;
  SolidTopology shape(std::move(outline), volume, 0.6 * volume);
  shape.ball = true;
  return shape;
}

}  // namespace softgrain
