#include "softgrain/observe/outlines.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/geometry/polygon.hpp"

using namespace softgrain;

TEST_CASE("the area of grains is that of their outlines, each closed on itself") {
  // a unit square and a triangle of area 2, far apart
  const std::vector<Vec<2>> outline{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {10, 0}, {12, 0}, {10, 2}};
  const std::vector<int> begin{0, 4, 7};
  CHECK(total_area(outline, begin) == doctest::Approx(3));
}

namespace {

constexpr double pi = std::numbers::pi;

/// Deepest that a disk sticks out of the outline, by the distance of every point of its rim that lies
/// outside.
double sticks_out(const std::vector<Vec<2>>& x, double R, const std::vector<Vec<2>>& outline) {
  double deepest = 0;
  for (const Vec<2>& centre : x)
    for (int k = 0; k < 64; ++k) {
      const Vec<2> p = centre + R * Vec<2>{std::cos(pi * k / 32), std::sin(pi * k / 32)};
      double winding = 0, closest = 1e9;
      for (std::size_t v = 0; v < outline.size(); ++v) {
        const Vec<2> a = outline[v] - p, b = outline[(v + 1) % outline.size()] - p;
        winding += std::atan2(a[0] * b[1] - a[1] * b[0], dot(a, b));
        const double share = std::clamp(dot(a, a - b) / dot(a - b, a - b), 0.0, 1.0);
        closest = std::min(closest, norm(a + share * (b - a)));
      }
      if (std::abs(winding) < pi) deepest = std::max(deepest, closest);
    }
  return deepest;
}

}  // namespace

TEST_CASE("the outline of one disk is a polygon of its area, close to the circle") {
  const auto outline = disk_outline(std::vector<Vec<2>>{{3, -2}}, std::vector<double>{2}, 0.5);
  for (const Vec<2>& p : outline) CHECK(std::abs(norm(p - Vec<2>{3, -2}) - 2) < 2e-3);
  CHECK(std::abs(polygon_area(outline) / (4 * pi) - 1) < 1e-12);
}

TEST_CASE("a probe bridges the notch between two disks where it touches both") {
  // two disks of radius 1 at distance 2: a probe of radius 1 touches them at 60 degrees, half-way in
  const auto outline = disk_outline(std::vector<Vec<2>>{{-1, 0}, {1, 0}}, std::vector<double>{1, 1}, 1);
  const double height = std::sqrt(0.75);
  double nearest = 1e9;  // to the touching point (-0.5, height)
  for (const Vec<2>& p : outline) nearest = std::min(nearest, norm(p - Vec<2>{-0.5, height}));
  CHECK(nearest < 1e-12);
  // two segments of a disk without the part beyond x = +-0.5, and the bridge between
  const double beyond = pi / 3 - std::sin(pi / 3) * std::cos(pi / 3);
  const double exact = 2 * (pi - beyond) + 2 * height;
  CHECK(polygon_area(outline) == doctest::Approx(exact).epsilon(0.03));
  CHECK(polygon_area(outline) < exact);
}

TEST_CASE("a ring of disks has no inside, and a dent as wide as the probe is seen") {
  // a 7 x 7 block of disks without the middle, and without the middle of its lower side
  std::vector<Vec<2>> closed, dented;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j) {
      if (i == 3 && j == 3) continue;
      closed.push_back({2.0 * i, 2.0 * j});
      if (!(i == 3 && j == 0)) dented.push_back({2.0 * i, 2.0 * j});
    }
  const std::vector<double> R(closed.size(), 1.0);
  const auto whole = disk_outline(closed, R, 0.9), bitten = disk_outline(dented, std::span(R).first(47), 0.9);
  CHECK(is_simple_polygon(whole));
  CHECK(is_simple_polygon(bitten));
  // the square round the centres; along its sides, from disk to disk, half disks up to where the probe
  // touches both and a bridge; quarter disks at the corners
  const double touch = std::acos(1 / 1.9),
               half_disk = 0.5 * (std::cos(touch) * std::sin(touch) + pi / 2 - touch);
  const double side = 2 * half_disk + 2 * (1 - std::cos(touch)) * std::sin(touch);
  CHECK(polygon_area(whole) == doctest::Approx(144 + 4 * 6 * side + pi).epsilon(0.01));
  CHECK(polygon_area(whole) - polygon_area(bitten) == doctest::Approx(4).epsilon(0.2));
  CHECK(sticks_out(closed, 1, whole) < 0.03);
  CHECK(sticks_out(dented, 1, bitten) < 0.03);
}
