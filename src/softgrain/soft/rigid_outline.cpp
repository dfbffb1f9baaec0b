#include "softgrain/soft/rigid_outline.hpp"

#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"

namespace softgrain {

Topology rigid_disk(int vertices) {
  require(vertices >= 8, "the outline of a rigid grain needs at least 8 vertices, got {}", vertices);
  ReferenceGrid grid{.node = {{0, 0}}, .cell = {}, .outline_begin = 1};
  for (int k = 0; k < vertices; ++k) {
    const double angle = 2 * std::numbers::pi * k / vertices;
    grid.node.push_back({std::cos(angle), std::sin(angle)});
  }
  grid.fullness = std::numbers::pi / polygon_area(grid.outline());
  return {std::move(grid), std::numbers::pi / 2};
}

}  // namespace softgrain
