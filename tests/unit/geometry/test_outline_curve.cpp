#include "softgrain/geometry/outline_curve.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"

using namespace softgrain;

namespace {

constexpr double pi = std::numbers::pi;

std::vector<OutlinePoint> circle_of(int points, const Vec<2>& centre = {}) {
  std::vector<OutlinePoint> circle;
  for (int k = 0; k < points; ++k)
    circle.push_back({centre + Vec<2>{std::cos(2 * pi * k / points), std::sin(2 * pi * k / points)}});
  return circle;
}

/// The upper half of the unit disk: corners where its arc ends.
std::vector<OutlinePoint> half_disk(int points) {
  std::vector<OutlinePoint> half;
  for (int k = 0; k <= points; ++k) {
    const double angle = pi * k / points;
    half.push_back({{std::cos(angle), std::sin(angle)}, k == 0 || k == points});
  }
  return half;
}

}  // namespace

TEST_CASE("a curve through points of a circle is the circle, the nearer the more points") {
  double before = 0;
  for (const int points : {12, 24, 48}) {
    const OutlineCurve curve(circle_of(points, {3, -2}));
    const double error = std::abs(curve.area() / pi - 1);
    CHECK(error < 0.5 * std::pow(pi / points, 4));
    if (before > 0) CHECK(before / error > 14);  // fourth order
    before = error;
    CHECK(norm(curve.centroid() - Vec<2>{3, -2}) < 1e-12);
    CHECK(std::abs(curve.moment() / (pi / 2) - 1) < 0.9 * std::pow(pi / points, 4));
    for (const OutlinePoint& point : curve.sample(100)) {
      CHECK(std::abs(norm(point.x - Vec<2>{3, -2}) - 1) < 0.4 * std::pow(pi / points, 4));
      CHECK_FALSE(point.corner);
    }
  }
}

TEST_CASE("a polygon is straight between its corners, which all are vertices, to the last digits") {
  for (const int sides : {3, 4, 5, 12}) {
    CAPTURE(sides);
    const OutlineCurve curve(regular_polygon(sides));
    const double turn = 2 * pi / sides, area = sides / 2.0 * std::sin(turn);
    const double sine = std::sin(pi / sides);
    CHECK(std::abs(curve.area() / area - 1) < 1e-14);
    CHECK(std::abs(curve.moment() / (area / 2 * (1 - sine * sine * 2 / 3)) - 1) < 1e-13);
    CHECK(norm(curve.centroid()) < 1e-15);
    const auto points = curve.sample(30);
    CHECK(points.size() == 30);
    CHECK(std::ranges::count_if(points, &OutlinePoint::corner) == sides);
    for (const OutlinePoint& point :
         points) {  // at the distance of a side from the centre, seen along its normal
      double nearest = 2;
      for (int k = 0; k < sides; ++k) {
        const double angle = (k + 0.5) * turn;
        nearest = std::min(
            nearest, std::abs(dot(point.x, Vec<2>{std::cos(angle), std::sin(angle)}) - std::cos(turn / 2)));
      }
      CHECK(nearest < 1e-14);
    }
  }
}

TEST_CASE("a half disk has two sharp corners, a straight side and a round one") {
  const OutlineCurve curve(half_disk(24));
  CHECK(std::abs(curve.area() / (pi / 2) - 1) < 1e-4);
  CHECK(norm(curve.centroid() - Vec<2>{0, 4 / (3 * pi)}) < 1e-4);
  const double about_centre = pi / 4 - pi / 2 * std::pow(4 / (3 * pi), 2);
  CHECK(std::abs(curve.moment() / about_centre - 1) < 2e-4);
  CHECK(std::abs(curve.reach() - std::hypot(1, 4 / (3 * pi))) < 1e-4);
  CHECK(curve.corners() == 2);
  for (const OutlinePoint& point : curve.sample(64)) {
    if (point.corner) CHECK(std::abs(std::abs(point.x[0]) - 1) < 1e-15);
    CHECK(std::min(std::abs(point.x[1]), std::abs(norm(point.x) - 1)) < 2e-4);
  }
}

TEST_CASE(
    "points are taken in either sense, and corners found where the polygon turns by more than 30 degrees") {
  auto points = half_disk(24);
  for (OutlinePoint& point : points) point.corner = false;
  find_corners(points);
  CHECK(std::ranges::count_if(points, &OutlinePoint::corner) == 2);
  CHECK((points.front().corner && points.back().corner));
  const double area = OutlineCurve(points).area();
  std::ranges::reverse(points);
  CHECK(std::abs(OutlineCurve(points).area() / area - 1) < 1e-14);
  auto thirteen = regular_polygon(13), eleven = regular_polygon(11);
  find_corners(thirteen);
  find_corners(eleven);
  CHECK(std::ranges::count_if(thirteen, &OutlinePoint::corner) == 0);
  CHECK(std::ranges::count_if(eleven, &OutlinePoint::corner) == 11);
}

TEST_CASE("outlines that cross themselves, touch or are too short are refused") {
  const auto of = [](std::initializer_list<Vec<2>> places) {
    std::vector<OutlinePoint> points;
    for (const Vec<2>& x : places) points.push_back({x, true});
    return points;
  };
  CHECK_THROWS_AS(OutlineCurve(of({{0, 0}, {1, 0}})), UsageError);
  CHECK_THROWS_AS(OutlineCurve(of({{0, 0}, {1, 1}, {1, 0}, {0, 1}})), UsageError);
  CHECK((crossing_edges(of({{0, 0}, {1, 1}, {1, 0}, {0, 1}})) == std::array{0, 2}));
  CHECK_THROWS_AS(OutlineCurve(of({{0, 0}, {0, 0}, {1, 0}, {0, 1}})), UsageError);
  CHECK_THROWS_AS(OutlineCurve(of({{0, 0}, {2, 0}, {1, 0}, {1, 1}})), UsageError);  // runs back
  CHECK_THROWS_AS(OutlineCurve(regular_polygon(12)).sample(11), UsageError);
  CHECK_THROWS_AS(OutlineCurve(regular_polygon(3)).sample(7), UsageError);
}
