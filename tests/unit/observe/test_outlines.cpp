#include "softgrain/observe/outlines.hpp"

#include <doctest/doctest.h>

using namespace softgrain;

TEST_CASE("the area of grains is that of their outlines, each closed on itself") {
  // a unit square and a triangle of area 2, far apart
  const std::vector<Vec<2>> outline{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {10, 0}, {12, 0}, {10, 2}};
  const std::vector<int> begin{0, 4, 7};
  CHECK(total_area(outline, begin) == doctest::Approx(3));
}

TEST_CASE("the coordination number counts a pair of grains once, however many points they touch at") {
  CHECK(coordination_number({}, 5) == 0);
  CHECK(coordination_number({{0, 1}}, 2) == 1);
  // a ring of four grains, each pair found several times and from both sides
  CHECK(coordination_number({{0, 1}, {1, 0}, {0, 1}, {1, 2}, {3, 2}, {2, 3}, {3, 0}}, 4) == 2);
}
