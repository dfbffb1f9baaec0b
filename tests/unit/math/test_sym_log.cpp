#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "softgrain/math/sym_log.hpp"

using namespace softgrain;

namespace {

/// Turned about (1, 2, 3) by 0.7: by Rodrigues' formula.
Mat<3> some_axes() {
  const Vec<3> n = (1 / std::sqrt(14.0)) * Vec<3>{1, 2, 3};
  const double c = std::cos(0.7), s = std::sin(0.7);
  Mat<3> axes;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) axes(i, j) = (1 - c) * n[i] * n[j] + (i == j ? c : 0);
  axes += s * Mat<3>{{0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0}};
  return axes;
}

/// The symmetric matrix of these eigenvalues, in axes that are nobody's.
Mat<3> with_eigenvalues(const Vec<3>& values) {
  const Mat<3> axes = some_axes();
  return axes * Mat<3>::diagonal(values) * transpose(axes);
}

double largest_difference(const Mat<3>& a, const Mat<3>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.c.size(); ++k) largest = std::max(largest, std::abs(a.c[k] - b.c[k]));
  return largest;
}

/// Logarithms of eigenvalues near 1, at both sides of each border between the rules, and far from it.
const std::vector<Vec<3>> logarithms{{0, 0, 0},        {1e-9, -2e-9, 1e-9},  {1e-3, 2e-3, -3e-3},
                                     {0.1, 0.1, -0.2}, {0.2230, 0, 0},       {0.2232, 0, 0},
                                     {-0.2876, 0, 0},  {0.4, 0.4, -0.1},     {-0.9162, 0, 0},
                                     {-0.9164, 0, 0},  {0.3, -0.5, 0.2},     {1.5, -0.7, -0.8},
                                     {3, 3, -6},       {0.5, 0.5 + 1e-9, 0}, {-0.2, -0.2 - 1e-12, -0.2}};

Vec<3> exponentials(const Vec<3>& e) { return {std::exp(e[0]), std::exp(e[1]), std::exp(e[2])}; }

}  // namespace

TEST_CASE("logarithms and exponentials of symmetric matrices are those of their eigenvalues") {
  for (const Vec<3>& e : logarithms) {
    CAPTURE(e[0]);
    const Vec<3> values = exponentials(e);
    const Mat<3> m = with_eigenvalues(values), logarithm = with_eigenvalues(e);
    const double smallest = *std::min_element(values.c.begin(), values.c.end());
    const double largest = *std::max_element(values.c.begin(), values.c.end());
    CHECK(largest_difference(sym_log(m), logarithm) < 3e-15 * std::max(1.0, largest) / smallest);
    CHECK(largest_difference(sym_exp(logarithm), m) < 1e-14 * std::max(1.0, largest));
  }
}

TEST_CASE("a lane's logarithm and exponential do not depend on its neighbours") {
  for (const Vec<3>& e : logarithms) {
    Mat<3, Wide> alone, among, exponents_alone, exponents_among;
    for (int lane = 0; lane < Wide::size; ++lane) {
      const Vec<3>& neighbour = logarithms[(static_cast<std::size_t>(lane) * 4) % logarithms.size()];
      const Mat<3> own = with_eigenvalues(exponentials(e)), own_exponent = with_eigenvalues(e);
      const Mat<3> other = with_eigenvalues(exponentials(neighbour)),
                   other_exponent = with_eigenvalues(neighbour);
      for (std::size_t k = 0; k < 9; ++k) {
        alone.c[k].set(lane, own.c[k]);
        among.c[k].set(lane, lane == 3 ? own.c[k] : other.c[k]);
        exponents_alone.c[k].set(lane, own_exponent.c[k]);
        exponents_among.c[k].set(lane, lane == 3 ? own_exponent.c[k] : other_exponent.c[k]);
      }
    }
    const Mat<3, Wide> log_alone = sym_log(alone), log_among = sym_log(among);
    const Mat<3, Wide> exp_alone = sym_exp(exponents_alone), exp_among = sym_exp(exponents_among);
    for (std::size_t k = 0; k < 9; ++k) {
      CHECK(log_alone.c[k][3] == log_among.c[k][3]);
      CHECK(exp_alone.c[k][3] == exp_among.c[k][3]);
    }
  }
}

TEST_CASE("a matrix that is not positive has no logarithm") {
  CHECK(std::isnan(trace(sym_log(with_eigenvalues({1, 1, -0.5})))));
  CHECK(std::isnan(trace(sym_log(Mat<3>::diagonal({std::nan(""), 1, 1})))));
}
