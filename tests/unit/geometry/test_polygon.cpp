#include "softgrain/geometry/polygon.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

using namespace softgrain;

namespace {

const std::vector<Vec<2>> l_shape{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};

}  // namespace

TEST_CASE("area, perimeter and centroid of an L are those of its two rectangles") {
  CHECK(polygon_area(l_shape) == doctest::Approx(4));
  CHECK(polygon_perimeter(l_shape) == doctest::Approx(10));
  // 3 x 1 at (1.5, 0.5) and 1 x 1 at (0.5, 1.5)
  const Vec<2> centre = polygon_centroid(l_shape);
  CHECK(centre[0] == doctest::Approx((3 * 1.5 + 0.5) / 4));
  CHECK(centre[1] == doctest::Approx((3 * 0.5 + 1.5) / 4));
}

TEST_CASE("the area of a clockwise polygon is negative, its centroid is the same") {
  std::vector<Vec<2>> reversed(l_shape.rbegin(), l_shape.rend());
  CHECK(polygon_area(reversed) == doctest::Approx(-4));
  CHECK(polygon_centroid(reversed)[0] == doctest::Approx(1.25));
}

TEST_CASE("an outline is simple unless two of its edges cross, touch or fold back") {
  const auto simple = [](std::vector<Vec<2>> vertices) { return is_simple_polygon(vertices); };
  CHECK(simple({{0, 0}, {1, 0}, {0, 1}}));
  CHECK(simple(l_shape));
  CHECK_FALSE(simple({{0, 0}, {1, 0}}));
  CHECK_FALSE(simple({{0, 0}, {1, 1}, {1, 0}, {0, 1}}));                   // bow tie
  CHECK_FALSE(simple({{0, 0}, {1, 0}, {1, 0}, {0, 1}}));                   // a vertex twice
  CHECK_FALSE(simple({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}));           // a vertex on an edge
  CHECK_FALSE(simple({{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, -1}, {0, 3}}));  // an edge through another
}

TEST_CASE("a resampled square keeps its corners and has equal pieces") {
  const std::vector<Vec<2>> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto points = resample_polygon(square, 8);
  const std::vector<Vec<2>> expected{{0, 0}, {.5, 0}, {1, 0}, {1, .5}, {1, 1}, {.5, 1}, {0, 1}, {0, .5}};
  REQUIRE(points.size() == 8);
  for (int k = 0; k < 8; ++k) CHECK(norm(points[k] - expected[k]) < 1e-15);
}

TEST_CASE("resampling gives long edges more points, and no fewer points than vertices") {
  const std::vector<Vec<2>> flat{{0, 0}, {3, 0}, {3, 1}, {0, 1}};  // edges 3, 1, 3, 1
  const auto points = resample_polygon(flat, 8);
  REQUIRE(points.size() == 8);
  CHECK(std::ranges::count_if(points, [](const Vec<2>& x) { return x[1] == 0; }) == 4);
  CHECK(polygon_perimeter(points) == doctest::Approx(8));
  for (const Vec<2>& corner : flat) CHECK(std::ranges::count(points, corner) == 1);
  CHECK(resample_polygon(flat, 4) == flat);
  CHECK_THROWS_AS(resample_polygon(flat, 3), UsageError);
}
