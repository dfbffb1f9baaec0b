#include "softgrain/mpm/topology.hpp"

#include <array>

#include "softgrain/geometry/polygon.hpp"

namespace softgrain {
namespace {

BlockPattern pattern_of(const ReferenceGrid& grid) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& cell : grid.cell)
    for (int a = 1; a < 4; ++a)
      for (int b = 0; b < a; ++b) edges.push_back({cell[a], cell[b]});
  return {grid.nodes(), edges, grid.outline_nodes()};
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
  for (const auto& cell : grid.cell)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b <= a; ++b)
        cell_blocks.push_back(
            {pattern.block(cell[a], cell[b]), a != b && pattern.transposed(cell[a], cell[b])});
}

}  // namespace softgrain
