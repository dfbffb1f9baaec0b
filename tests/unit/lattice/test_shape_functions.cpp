#include "softgrain/lattice/shape_functions.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "support/random_numbers.hpp"

using namespace softgrain;

namespace {

constexpr double cell = 0.3;
constexpr ShapeFunction shapes[] = {ShapeFunction::bilinear, ShapeFunction::gimp, ShapeFunction::bspline};

/// N of one node at x; 0 if the stencil does not hold it.
double value_at(ShapeFunction shape, const Vec<2>& x, int column, int row) {
  double value = 0;
  Stencil(shape, x, cell).for_each_node([&](int i, int j, double N, const Vec<2>&) {
    if (i == column && j == row) value = N;
  });
  return value;
}

template <class Check>
void at_random_places(Check&& check) {
  test::RandomNumbers random(5);
  for (const ShapeFunction shape : shapes)
    for (int trial = 0; trial < 200; ++trial) {
      CAPTURE(static_cast<int>(shape));
      check(shape, random.vector<2>(2.0));
    }
}

}  // namespace

TEST_CASE("shape functions are positive, sum to one, and carry linear fields exactly") {
  at_random_places([](ShapeFunction shape, const Vec<2>& x) {
    double sum = 0;
    Vec<2> sum_of_gradients, place;
    Mat<2> slope;  // sum x_i (x) dN_i/dx = 1
    Stencil(shape, x, cell).for_each_node([&](int i, int j, double N, const Vec<2>& dN) {
      CHECK(N >= 0);
      const Vec<2> node{i * cell, j * cell};
      sum += N;
      sum_of_gradients += dN;
      place += N * node;
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) slope(a, b) += node[a] * dN[b];
    });
    CHECK(sum == doctest::Approx(1).epsilon(1e-14));
    CHECK(norm(sum_of_gradients) < 1e-13);
    CHECK(norm(place - x) < 1e-14);
    for (int k = 0; k < 4; ++k) CHECK(std::abs(slope.c[k] - (k % 3 == 0 ? 1 : 0)) < 1e-13);
  });
}

TEST_CASE("gradients of shape functions are their differences") {
  constexpr double e = 1e-6;
  at_random_places([](ShapeFunction shape, const Vec<2>& x) {
    Stencil(shape, x, cell).for_each_node([&](int i, int j, double, const Vec<2>& dN) {
      for (int d = 0; d < 2; ++d) {
        Vec<2> ahead = x, behind = x;
        ahead[d] += e, behind[d] -= e;
        const double difference = (value_at(shape, ahead, i, j) - value_at(shape, behind, i, j)) / (2 * e);
        CHECK(dN[d] == doctest::Approx(difference).epsilon(1e-5));
      }
    });
  });
}

TEST_CASE("a point reaches nodes within the support of its shape function, and none beyond") {
  for (const ShapeFunction shape : shapes) {
    CAPTURE(static_cast<int>(shape));
    const double edge = support(shape);
    const Vec<2> inside{(7 + edge - 1e-3) * cell, 0}, outside{(7 + edge + 1e-3) * cell, 0};
    CHECK(value_at(shape, inside, 7, 0) > 0);
    CHECK(value_at(shape, outside, 7, 0) == 0);
  }
}
