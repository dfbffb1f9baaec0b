#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "softgrain/math/sym_eigen.hpp"
#include "softgrain/math/tensor.hpp"

using namespace softgrain;

namespace {

const Mat<2> a2{{1, 2, 3, 5}};
const Mat<3> a3{{2, 1, 0, -1, 3, 4, 5, 0, 2}};

template <int N>
double largest_difference(const Mat<N>& a, const Mat<N>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.c.size(); ++k) largest = std::max(largest, std::abs(a.c[k] - b.c[k]));
  return largest;
}

/// d(cof m)_ij / dm_kl by differences; exact, since the cofactor is at most quadratic.
template <int N>
Mat<N * N> cofactor_derivative_by_differences(const Mat<N>& m) {
  Mat<N * N> result;
  for (int column = 0; column < N * N; ++column) {
    Mat<N> plus = m, minus = m;
    plus.c[static_cast<std::size_t>(column)] += 0.5;
    minus.c[static_cast<std::size_t>(column)] -= 0.5;
    const Mat<N> slope = cofactor(plus) - cofactor(minus);
    for (int row = 0; row < N * N; ++row) result(row, column) = slope.c[static_cast<std::size_t>(row)];
  }
  return result;
}

template <int N>
void check_decomposition(const Mat<N>& m, const SymEigen<N, double>& eigen) {
  const Mat<N>& v = eigen.vectors;
  CHECK(largest_difference(transpose(v) * v, identity<N>()) < 1e-15);
  CHECK(largest_difference(v * Mat<N>::diagonal(eigen.values) * transpose(v), m) < 4e-15);
}

}  // namespace

TEST_CASE("determinants, inverses and products are those worked out by hand") {
  CHECK(determinant(a2) == -1);
  CHECK(determinant(a3) == 34);
  CHECK(inverse(a2) == Mat<2>{{-5, 2, 3, -1}});
  CHECK(largest_difference(inverse(a3) * a3, identity<3>()) < 1e-15);
  CHECK(a2 * a2 == Mat<2>{{7, 12, 18, 31}});
  CHECK(transpose(a2) == Mat<2>{{1, 3, 2, 5}});
  CHECK(trace(a3) == 7);
  CHECK(contract(a2, Mat<2>{{1, 10, 100, 1000}}) == 5321);
  CHECK(symmetric_part(a2) == Mat<2>{{1, 2.5, 2.5, 5}});
  CHECK(a2 + 2.0 * a2 - a2 == Mat<2>{{2, 4, 6, 10}});
  CHECK(cofactor(a2) == Mat<2>{{5, -3, -2, 1}});
  CHECK(cofactor(a3) == Mat<3>{{6, 22, -15, -2, 4, 5, 4, -8, 7}});
}

TEST_CASE("the derivative of the cofactor is that of its differences") {
  Mat<4> d2;
  add_cofactor_derivative(d2, 1.0, a2);
  CHECK(d2 == cofactor_derivative_by_differences(a2));
  Mat<9> d3;
  add_cofactor_derivative(d3, 1.0, a3);
  CHECK(d3 == cofactor_derivative_by_differences(a3));
}

TEST_CASE("an outer product has the entries a_ij b_kl") {
  Mat<4> sum;
  add_outer(sum, 2.0, a2, Mat<2>{{1, 10, 100, 1000}});
  CHECK(sum(0, 3) == 2000);
  CHECK(sum(3, 0) == 10);
  CHECK(sum(1, 2) == 400);
}

TEST_CASE("eigenvalues of the string of three beads are 2 and 2 +- root 2") {
  const Mat<3> m{{2, 1, 0, 1, 2, 1, 0, 1, 2}};
  SymEigen<3, double> eigen = sym_eigen(m);
  check_decomposition(m, eigen);
  std::sort(eigen.values.c.begin(), eigen.values.c.end());
  CHECK(eigen.values[0] == doctest::Approx(2 - std::sqrt(2.0)).epsilon(1e-14));
  CHECK(eigen.values[1] == doctest::Approx(2).epsilon(1e-14));
  CHECK(eigen.values[2] == doctest::Approx(2 + std::sqrt(2.0)).epsilon(1e-14));
}

TEST_CASE("equal, nearly equal and widely different eigenvalues are found with orthonormal vectors") {
  for (const Mat<3>& m :
       {identity<3>(), Mat<3>{}, Mat<3>{{2, 1, 1, 1, 2, 1, 1, 1, 2}},
        Mat<3>{{1, 1e-12, 0, 1e-12, 1, 0, 0, 0, 1}},
        Mat<3>{{1, 1e-3, 1e-6, 1e-3, 1e-3, 1e-9, 1e-6, 1e-9, 1e-9}}, Mat<3>{{0, 1, 2, 1, 0, 3, 2, 3, 0}}})
    check_decomposition(m, sym_eigen(m));
  const Mat<2> plane{{1, 2, 2, -2}};  // eigenvalues 2 and -3
  const SymEigen<2, double> eigen = sym_eigen(plane);
  check_decomposition(plane, eigen);
  CHECK(std::max(eigen.values[0], eigen.values[1]) == doctest::Approx(2).epsilon(1e-15));
}

TEST_CASE("eight matrices at once get the eigenvalues that each gets alone") {
  Mat<3, Wide> m;
  const auto entry = [](int i, int j, int lane) {
    return lane == 3 ? (i == j) : std::cos(lane + 3 * (i + j) + i * j);
  };
  for (int lane = 0; lane < Wide::size; ++lane)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m(i, j).set(lane, entry(i, j, lane));
  const SymEigen<3, Wide> wide = sym_eigen(m);
  for (int lane = 0; lane < Wide::size; ++lane) {
    Mat<3> one;
    SymEigen<3, double> eigen;
    for (int i = 0; i < 3; ++i) {
      eigen.values[i] = wide.values[i][lane];
      for (int j = 0; j < 3; ++j) {
        one(i, j) = entry(i, j, lane);
        eigen.vectors(i, j) = wide.vectors(i, j)[lane];
      }
    }
    check_decomposition(one, eigen);
  }
}
