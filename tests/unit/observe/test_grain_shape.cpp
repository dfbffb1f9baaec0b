#include "softgrain/observe/grain_shape.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "softgrain/observe/outlines.hpp"
#include "softgrain/observe/packing.hpp"

using namespace softgrain;

namespace {

/// n corners of a regular polygon, stretched to the half axes a and b, turned by `turn` and moved.
std::vector<Vec<2>> polygon(int n, double a, double b, double turn = 0) {
  std::vector<Vec<2>> outline;
  for (int k = 0; k < n; ++k) {
    const double t = 2 * std::numbers::pi * k / n;
    const double x = a * std::cos(t), y = b * std::sin(t);
    outline.push_back(
        {7 + x * std::cos(turn) - y * std::sin(turn), -3 + x * std::sin(turn) + y * std::cos(turn)});
  }
  return outline;
}

}  // namespace

TEST_CASE("a regular polygon has circularity (pi/n) cot(pi/n) and aspect ratio 1") {
  for (const int n : {3, 4, 6, 17}) {
    const GrainShape shape = grain_shape(polygon(n, 2, 2, 0.4));
    const double half = std::numbers::pi / n;
    CHECK(shape.area == doctest::Approx(n * 4 * std::sin(half) * std::cos(half)));
    CHECK(shape.perimeter == doctest::Approx(n * 4 * std::sin(half)));
    CHECK(shape.circularity == doctest::Approx(half / std::tan(half)));
    CHECK(shape.aspect_ratio == doctest::Approx(1));
  }
}

TEST_CASE("an ellipse has the aspect ratio of its axes, however it lies") {
  for (const double turn : {0.0, 0.7, 2.1})
    CHECK(grain_shape(polygon(400, 3, 1.2, turn)).aspect_ratio == doctest::Approx(2.5));
  CHECK(grain_shape(polygon(4000, 5, 5)).circularity == doctest::Approx(1).epsilon(1e-5));
}

TEST_CASE("a rectangle has the aspect ratio of its sides, however many points lie on them") {
  CHECK(grain_shape(std::vector<Vec<2>>{{0, 0}, {1, 0}, {2, 0}, {6, 0}, {6, 2}, {0, 2}}).aspect_ratio ==
        doctest::Approx(3));
  CHECK(grain_shape(std::vector<Vec<2>>{{0, 0}, {6, 0}, {6, 2}, {0, 2}}).aspect_ratio == doctest::Approx(3));
}

TEST_CASE("the cell of a hexagonal packing is filled to pi/(2 sqrt 3) by disks and wholly by hexagons") {
  // a rectangle of 2 x 2 sqrt 3 holds two disks of radius 1
  const double box_area = 4 * std::sqrt(3.0);
  const std::vector<double> radius{1, 1};
  std::vector<Vec<2>> hexagons = polygon(6, 2 / std::sqrt(3.0), 2 / std::sqrt(3.0), 0.5);
  const auto other = hexagons;
  hexagons.insert(hexagons.end(), other.begin(), other.end());
  const PackingFraction phi =
      packing_fraction(radius, total_area(hexagons, std::vector<int>{0, 6, 12}), box_area);
  CHECK(phi.undeformed == doctest::Approx(std::numbers::pi / (2 * std::sqrt(3.0))));
  CHECK(phi.deformed == doctest::Approx(1));
}
