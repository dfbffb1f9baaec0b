#include "softgrain/experiment/shape_of_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/soft/rigid_outline.hpp"
#include "softgrain/soft/soft_outline.hpp"

namespace softgrain {
namespace {

Topology rigid_shape(const Case& c) {
  const int vertices = 4 * c.mpm.cells;
  switch (c.grain.shape) {
    case ShapeOfGrain::ellipse:
      return rigid_ellipse(c.grain.aspect, vertices);
    case ShapeOfGrain::polygon:
      return rigid_polygon(c.grain.sides, vertices);
    case ShapeOfGrain::outline:
      return rigid_outline(OutlineCurve(c.grain.outline), vertices);
    default:
      return rigid_disk(vertices);
  }
}

Topology soft_shape(const Case& c) {
  switch (c.grain.shape) {
    case ShapeOfGrain::ellipse:
      return soft_ellipse(c.grain.aspect, c.mpm.cells);
    case ShapeOfGrain::polygon:
      return soft_polygon(c.grain.sides, c.mpm.cells);
    case ShapeOfGrain::outline:
      return soft_outline(OutlineCurve(c.grain.outline), c.mpm.cells);
    default:
      return Topology(disk_grid(c.mpm.cells));
  }
}

double shortest_edge(const ReferenceGrid& grid) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& cell : grid.cell)
    for (std::size_t a = 0; a < 4; ++a)
      shortest = std::min(shortest, norm(grid.node[cell[a]] - grid.node[cell[(a + 1) % 4]]));
  return shortest;
}

}  // namespace

std::shared_ptr<const Topology> grain_shape_of(const Case& kind) {
  return std::make_shared<const Topology>(is_rigid(kind) ? rigid_shape(kind) : soft_shape(kind));
}

double area_share(const Case& kind) {
  switch (kind.grain.shape) {
    case ShapeOfGrain::ellipse:
      return 1 / kind.grain.aspect;
    case ShapeOfGrain::polygon: {
      const double turn = 2 * std::numbers::pi / kind.grain.sides;
      return std::sin(turn) / turn;
    }
    case ShapeOfGrain::outline: {
      if (kind.grain.outline.empty()) return 1;
      const OutlineCurve curve(kind.grain.outline);
      return curve.area() / (std::numbers::pi * curve.reach() * curve.reach());
    }
    case ShapeOfGrain::surface:
      if (kind.grain.surface.triangle.empty()) return 1;
      return StarSurface(kind.grain.surface).volume() / (4 * std::numbers::pi / 3);
    default:
      return 1;
  }
}

std::pair<double, double> between_walls(const Case& c) {
  const double R = c.grain.radius;
  const std::shared_ptr<const Topology> shape = grain_shape_of(c);
  if (c.grain.shape == ShapeOfGrain::disk) {  // they meet the circle through its vertices
    double reach = 0;
    for (const Vec<2>& X : shape->grid.outline()) reach = std::max(reach, norm(X) * R);
    return {-reach, reach};
  }
  const Vec<2> up{std::sin(c.grain.angle), std::cos(c.grain.angle)};  // seen by the shape
  return {-R * reach_of(*shape, -up), R * reach_of(*shape, up)};
}

double cell_share(const Case& kind) {
  if (is_rigid(kind) || kind.grain.shape == ShapeOfGrain::disk) return 1;
  return shortest_edge(grain_shape_of(kind)->grid) / shortest_edge(disk_grid(kind.mpm.cells));
}

int least_cells(const Case::Grain& grain) {
  int corners = 0;
  if (grain.shape == ShapeOfGrain::polygon) corners = grain.sides;
  if (grain.shape == ShapeOfGrain::outline)
    corners = static_cast<int>(std::count_if(grain.outline.begin(), grain.outline.end(),
                                             [](const OutlinePoint& point) { return point.corner; }));
  return std::max(2, (corners + 3) / 4);
}

}  // namespace softgrain
