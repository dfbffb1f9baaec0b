#include "softgrain/mpm/topology.hpp"

#include <cmath>
#include <span>

#include "softgrain/geometry/polygon.hpp"

namespace softgrain {
namespace {

/// A vertex that turns by less than this, over their number, has no arc: 2 pi for a regular polygon.
constexpr double straight_turn = 1;

BlockPattern pattern_of(const ReferenceGrid& grid) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& cell : grid.cell)
    for (int a = 1; a < 4; ++a)
      for (int b = 0; b < a; ++b) edges.push_back({cell[a], cell[b]});
  return {grid.nodes(), edges, grid.outline_nodes()};
}

CellShape shape_of(std::span<const MaterialPoint, 4> points) {
  const auto L = [&](int a, int b) {
    double sum = 0;
    for (const MaterialPoint& p : points) sum += p.volume * dot(p.gradient[a], p.gradient[b]);
    return sum;
  };
  CellShape shape{
      .L_11 = L(1, 1), .L_12 = L(1, 2), .L_13 = L(1, 3), .L_22 = L(2, 2), .L_23 = L(2, 3), .L_33 = L(3, 3)};
  double volume = 0;
  for (std::size_t p = 0; p < 4; ++p)
    shape.inverse_area[p] = 1 / (4 * points[p].volume), volume += points[p].volume;
  shape.inverse_volume = 1 / volume;
  return shape;
}

OutlineArc arc_of(const Vec<2>& before, const Vec<2>& at, const Vec<2>& after, double straight) {
  const Vec<2> a = at - before, b = after - at;
  const double turn = std::atan2(-dot(a, perpendicular(b)), dot(a, b)), l = norm(after - before) / 2;
  if (turn < straight) return {};
  return {.half_chord = l, .radius = l / std::sin(turn), .end_sine = std::sin(turn / 2)};
}

}  // namespace

Topology::Topology(ReferenceGrid reference_grid)
    : grid(std::move(reference_grid)),
      points(material_points(grid)),
      node_volume(grid.nodes(), 0),
      area(polygon_area(grid.outline())),
      pattern(pattern_of(grid)) {
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int a = 0; a < 4; ++a) node_volume[grid.cell[p / 4][a]] += points[p].shape[a] * points[p].volume;
  const auto outline = grid.outline();
  const std::size_t n = outline.size();
  for (std::size_t v = 0; v < n; ++v)
    arc.push_back(arc_of(outline[(v + n - 1) % n], outline[v], outline[(v + 1) % n],
                         straight_turn / static_cast<double>(n)));
  for (std::size_t p = 0; p < points.size(); p += 4)
    cell_shapes.push_back(shape_of(std::span(points).subspan(p).first<4>()));
  for (const auto& cell : grid.cell)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b <= a; ++b)
        cell_blocks.push_back(
            {pattern.block(cell[a], cell[b]), a != b && pattern.transposed(cell[a], cell[b])});
}

}  // namespace softgrain
