#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "softgrain/geometry/support.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;
using std::numbers::pi;

namespace {

/// Perimeter of the convex hull of points (Andrew's monotone chain).
double hull_perimeter(std::vector<Vec<2>> x) {
  std::sort(x.begin(), x.end(), [](const Vec<2>& a, const Vec<2>& b) { return a.c < b.c; });
  const auto half = [](const auto& points) {
    std::vector<Vec<2>> chain;
    for (const Vec<2>& p : points) {
      while (chain.size() > 1 &&
             dot(perpendicular(chain.back() - chain[chain.size() - 2]), p - chain.back()) <= 0)
        chain.pop_back();
      chain.push_back(p);
    }
    double length = 0;
    for (std::size_t k = 1; k < chain.size(); ++k) length += norm(chain[k] - chain[k - 1]);
    return length;
  };
  const double lower = half(x);
  std::reverse(x.begin(), x.end());
  return lower + half(x);
}

}  // namespace

TEST_CASE("the outline of one disk is a circle, seen from its centre") {
  const std::vector<Vec<2>> x{{3, -2}};
  const std::vector<double> radius{0.7};
  const OutlineShape shape = outline_shape<2>(x, radius, x[0]);
  CHECK(shape.mean_radius == doctest::Approx(0.7).epsilon(1e-14));
  CHECK(shape.roundness < 1e-14);
}

TEST_CASE("seen from off its centre a circle keeps its mean radius but is not round") {
  // h(theta) = R - d cos(theta): mean R, spread 2 d
  const std::vector<Vec<2>> x{{3, -2}};
  const std::vector<double> radius{0.7};
  const OutlineShape shape = outline_shape<2>(x, radius, {2.9, -2});
  CHECK(shape.mean_radius == doctest::Approx(0.7).epsilon(1e-13));
  CHECK(shape.roundness == doctest::Approx(0.2 / 0.7).epsilon(1e-12));
}

TEST_CASE("the support of points on an ellipse is sqrt(a^2 cos^2 + b^2 sin^2)") {
  const double a = 2, b = 1;
  std::vector<Vec<2>> x;
  const int count = 20000;
  for (int k = 0; k < count; ++k)
    x.push_back({a * std::cos(2 * pi * k / count), b * std::sin(2 * pi * k / count)});
  const std::vector<double> radius(x.size(), 0.1);
  for (const double angle : {0.0, 0.4, 1.3, 2.2, 4.0}) {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    CHECK(support<2>(x, radius, {cosine, sine}) ==
          doctest::Approx(std::sqrt(a * a * cosine * cosine + b * b * sine * sine) + 0.1).epsilon(1e-6));
  }
  const OutlineShape shape = outline_shape<2>(x, radius, {0, 0});
  CHECK(shape.mean_radius == doctest::Approx(9.688448220547674 / (2 * pi) + 0.1).epsilon(1e-6));  // Ramanujan
  CHECK(shape.roundness == doctest::Approx((a - b) / shape.mean_radius).epsilon(1e-6));
}

TEST_CASE("the mean support is the perimeter of the hull over 2 pi") {
  test::RandomNumbers random(5);
  std::vector<Vec<2>> x(60);
  for (Vec<2>& point : x) point = random.vector<2>(1);
  const double R = 0.3;  // equal disks: the hull of the centres, widened by R, is longer by 2 pi R
  const OutlineShape shape = outline_shape<2>(x, std::vector<double>(x.size(), R), {0.1, 0.2}, 100000);
  CHECK(shape.mean_radius == doctest::Approx(hull_perimeter(x) / (2 * pi) + R).epsilon(1e-8));
}

TEST_CASE("two spheres have the half mean width R + d/4 and a roundness of d/2 over it") {
  constexpr double R = 1, d = 3;
  const std::vector<Vec<3>> x{{0, 0, 0}, {2, -1, 2}};
  const std::vector<double> radius{R, R};
  const OutlineShape shape = outline_shape<3>(x, radius, {1, -0.5, 1}, 20000);
  CHECK(std::abs(shape.mean_radius / (R + d / 4) - 1) < 1e-4);
  CHECK(std::abs(shape.roundness / (d / 2 / (R + d / 4)) - 1) < 1e-3);
  CHECK(std::abs(support<3>(x, radius, {0, 0, 1}) - 3) < 1e-15);
}
