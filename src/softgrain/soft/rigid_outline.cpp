#include "softgrain/soft/rigid_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"

namespace softgrain {
namespace {

using std::numbers::pi;

void require_vertices(int vertices) {
  require(vertices >= 8, "the outline of a rigid grain needs at least 8 vertices, got {}", vertices);
}

Vec<2> on_circle(int k, int count) {
  const double angle = 2 * pi * k / count;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

Topology rigid_disk(int vertices) { return rigid_ellipse(1, vertices); }

Topology rigid_ellipse(double aspect, int vertices) {
  require_vertices(vertices);
  require(aspect >= 1, "long over short axis of an ellipse must be >= 1, got {}", aspect);
  const double b = 1 / aspect, area = pi * b;
  ReferenceGrid grid{.node = {{0, 0}}, .cell = {}, .outline_begin = 1};
  for (int k = 0; k < vertices; ++k) {
    const Vec<2> X = on_circle(k, vertices);
    grid.node.push_back({X[0], b * X[1]});
  }
  grid.fullness = area / polygon_area(grid.outline());
  return {std::move(grid), area * (1 + b * b) / 4};
}

Topology rigid_polygon(int sides, int vertices) {
  require_vertices(vertices);
  require(sides >= 3, "a polygon needs at least 3 sides, got {}", sides);
  const int parts = std::max(2, static_cast<int>(std::lround(static_cast<double>(vertices) / sides)));
  ReferenceGrid grid{.node = {{0, 0}}, .cell = {}, .outline_begin = 1};
  std::vector<char> corner;
  for (int side = 0; side < sides; ++side)
    for (int k = 0; k < parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      grid.node.push_back((1 - share) * on_circle(side, sides) + share * on_circle(side + 1, sides));
      corner.push_back(k == 0 ? 1 : 0);
    }
  const double sine = std::sin(pi / sides), area = polygon_area(grid.outline());
  return {std::move(grid), area / 2 * (1 - sine * sine * 2 / 3), std::move(corner)};
}

Topology rigid_outline(const OutlineCurve& curve, int vertices) {
  require_vertices(vertices);
  const double unit = 1 / curve.reach(), area = curve.area() * unit * unit;
  ReferenceGrid grid{.node = {{0, 0}}, .cell = {}, .outline_begin = 1};
  std::vector<char> corner;
  for (const OutlinePoint& point : curve.sample(vertices)) {
    grid.node.push_back(unit * (point.x - curve.centroid()));
    corner.push_back(point.corner ? 1 : 0);
  }
  grid.fullness = area / polygon_area(grid.outline());
  Topology shape(std::move(grid), curve.moment() * std::pow(unit, 4), corner);
  shape.arc = arcs_between(shape.grid.outline(), corner);
  return shape;
}

}  // namespace softgrain
