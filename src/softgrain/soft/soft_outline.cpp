#include "softgrain/soft/soft_outline.hpp"

#include <numbers>
#include <optional>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"

namespace softgrain {

Topology soft_ellipse(double aspect, int cells) {
  require(aspect >= 1, "long over short axis of an ellipse must be >= 1, got {}", aspect);
  ReferenceGrid grid = disk_grid(cells);
  for (Vec<2>& X : grid.node) X[1] /= aspect;
  std::vector<char> corners(grid.outline_nodes(), 0);
  return {std::move(grid), std::move(corners)};
}

Topology soft_outline(const OutlineCurve& curve, int cells) {
  std::vector<Vec<2>> outline;
  std::vector<char> corners;
  for (const OutlinePoint& point : curve.sample(4 * cells)) {
    outline.push_back((1 / curve.reach()) * (point.x - curve.centroid()));
    corners.push_back(point.corner ? 1 : 0);
  }
  require(is_simple_polygon(outline),
          "the smooth curve through the points of the outline crosses itself; give more points, or corners");
  ReferenceGrid grid = outline_grid(outline, cells);
  if (const std::optional<Vec<2>> fold = folded_cell(grid))
    throw OutlineFolds("the outline is so concave that a cell of its grid folds; make it rounder there",
                       curve.reach() * *fold + curve.centroid());
  grid.fullness = curve.area() / (curve.reach() * curve.reach()) / polygon_area(outline);
  return {std::move(grid), std::move(corners)};
}

Topology soft_polygon(int sides, int cells) {
  return soft_outline(OutlineCurve(regular_polygon(sides)), cells);
}

}  // namespace softgrain
