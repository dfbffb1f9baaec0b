#include "softgrain/soft/reference_grid.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"

using namespace softgrain;

namespace {

/// What every grid must satisfy, whatever its outline.
void check_points(const ReferenceGrid& grid) {
  const auto points = material_points(grid);
  REQUIRE(points.size() == 4 * grid.cell.size());
  double worst_sum = 0, worst_linear = 0, volume = 0, least = points[0].volume;
  for (std::size_t p = 0; p < points.size(); ++p) {
    double shapes = 0;
    Vec<2> gradients;
    Mat<2> of_position;  // sum_a X_a (x) dN_a/dX: the gradient of the linear field X itself
    for (int a = 0; a < 4; ++a) {
      shapes += points[p].shape[a];
      gradients += points[p].gradient[a];
      const Vec<2>& X = grid.node[grid.cell[p / 4][a]];
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) of_position(i, j) += X[i] * points[p].gradient[a][j];
    }
    worst_sum = std::max({worst_sum, std::abs(shapes - 1), norm(gradients)});
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        worst_linear = std::max(worst_linear, std::abs(of_position(i, j) - (i == j ? 1 : 0)));
    volume += points[p].volume;
    least = std::min(least, points[p].volume);
  }
  CHECK(worst_sum < 1e-13);
  CHECK(worst_linear < 1e-12);
  CHECK(least > 0);
  CHECK(volume == doctest::Approx(polygon_area(grid.outline())).epsilon(1e-13));
}

std::vector<Vec<2>> ellipse(int vertices) {
  std::vector<Vec<2>> outline;
  for (int k = 0; k < vertices; ++k) {
    const double angle = 2 * std::numbers::pi * k / vertices;
    outline.push_back({2 * std::cos(angle), std::sin(angle)});
  }
  return outline;
}

}  // namespace

TEST_CASE("shapes sum to one and reproduce linear fields, and points fill the outline, in a disk") {
  for (const int n : {2, 3, 8, 12, 16}) {
    CAPTURE(n);
    const ReferenceGrid grid = disk_grid(n);
    check_points(grid);
    CHECK(grid.fullness * polygon_area(grid.outline()) == doctest::Approx(std::numbers::pi).epsilon(1e-13));
    for (const Vec<2>& X : grid.outline()) CHECK(norm(X) == doctest::Approx(1).epsilon(1e-14));
    CHECK(grid.outline_nodes() == 4 * n);
  }
}

TEST_CASE("a disk has 7/2 n^2 cells, none of them much smaller than the others") {
  for (const int n : {8, 12, 16}) {
    CAPTURE(n);
    const ReferenceGrid grid = disk_grid(n);
    if (n % 8 == 0) CHECK(grid.cell.size() == 7 * n * n / 2);
    const auto points = material_points(grid);
    const double least = std::ranges::min_element(points, {}, &MaterialPoint::volume)->volume;
    CHECK(least > 0.6 * std::numbers::pi / static_cast<double>(points.size()));
    for (const auto& cell : grid.cell) {
      std::vector<Vec<2>> corners;
      for (const int node : cell) corners.push_back(grid.node[node]);
      CHECK(polygon_area(corners) > 0);
    }
  }
}

TEST_CASE("a disk of fewer than two cells is refused") { CHECK_THROWS_AS(disk_grid(1), UsageError); }

TEST_CASE("a grid fitted to an ellipse or a pentagon keeps its vertices and its area") {
  const std::vector<Vec<2>> pentagon{{0, -1}, {1.5, -0.7}, {1.2, 0.6}, {0.1, 1.1}, {-0.9, 0.2}};
  for (const auto& outline : {ellipse(32), pentagon}) {
    CAPTURE(outline.size());
    const ReferenceGrid grid = polygon_grid(outline, 8);
    check_points(grid);
    CHECK(polygon_area(grid.outline()) == doctest::Approx(polygon_area(outline)).epsilon(1e-13));
    CHECK(grid.fullness == 1);
    for (const Vec<2>& vertex : outline) CHECK(std::ranges::count(grid.outline(), vertex) == 1);
  }
}

TEST_CASE("an outline given clockwise makes the same grid as counter-clockwise") {
  auto outline = ellipse(16);
  const ReferenceGrid grid = polygon_grid(outline, 4);
  std::ranges::reverse(outline);
  check_points(polygon_grid(outline, 4));
  CHECK(polygon_area(polygon_grid(outline, 4).outline()) == doctest::Approx(polygon_area(grid.outline())));
}

TEST_CASE("an outline that no grid can fit is refused") {
  const std::vector<Vec<2>> bow_tie{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  CHECK_THROWS_AS(polygon_grid(bow_tie, 8), UsageError);
  CHECK_THROWS_AS(polygon_grid(ellipse(17), 4), UsageError);
  const double w = 0.05;  // a thin L: its inner corner folds cells
  const std::vector<Vec<2>> thin_l{{0, 0}, {1, 0}, {1, w}, {w, w}, {w, 1}, {0, 1}};
  CHECK_THROWS_AS(polygon_grid(thin_l, 8), UsageError);
}
