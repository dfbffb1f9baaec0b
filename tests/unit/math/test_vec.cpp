#include <doctest/doctest.h>

#include "softgrain/math/vec.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;

TEST_CASE("the cross product is orthogonal to its factors and as long as their parallelogram is large") {
  test::RandomNumbers random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const auto a = random.vector<3>(2), b = random.vector<3>(2);
    const Vec<3> c = cross(a, b);
    CHECK(dot(c, a) == doctest::Approx(0).epsilon(1e-14));
    CHECK(dot(c, b) == doctest::Approx(0).epsilon(1e-14));
    CHECK(dot(c, c) == doctest::Approx(dot(a, a) * dot(b, b) - dot(a, b) * dot(a, b)).epsilon(1e-13));
  }
  CHECK(cross({1, 0, 0}, {0, 1, 0}) == Vec<3>{0, 0, 1});
}

TEST_CASE("perpendicular is e_z x a") {
  const Vec<2> a{3, -4};
  const Vec<3> turned = cross({0, 0, 1}, {a[0], a[1], 0});
  CHECK(perpendicular(a) == Vec<2>{turned[0], turned[1]});
}

TEST_CASE("a matrix times a unit vector is its column") {
  Mat<3> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = 10 * i + j;
  CHECK(m * Vec<3>{0, 1, 0} == Vec<3>{1, 11, 21});
  CHECK(Mat<3>::diagonal({2, 3, 4}) * Vec<3>{1, 1, 1} == Vec<3>{2, 3, 4});
}

TEST_CASE("vectors add, subtract, negate and scale by components") {
  const Vec<2> a{1, 2}, b{10, 20};
  CHECK(a + b == Vec<2>{11, 22});
  CHECK(b - a == Vec<2>{9, 18});
  CHECK(-a == Vec<2>{-1, -2});
  CHECK(3 * a == Vec<2>{3, 6});
  CHECK(norm(Vec<2>{3, -4}) == 5);
}
