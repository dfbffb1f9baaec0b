#pragma once
#include <array>

#include "softgrain/math/sym_eigen.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

// Logarithm and exponential of symmetric 3 x 3 matrices. Near 1 and near 0, where a step of a simulation has
// them, without eigenvectors: a polynomial of degree two with factors from the invariants, by the theorem of
// Cayley and Hamilton (docs/decisions/0078).

namespace detail {

/// Of each lane the entries of `a` where the mask is true, else those of `b`.
template <class Mask, class T>
Mat<3, T> select_of(const Mask& mask, Mat<3, T> a, const Mat<3, T>& b) {
  for (std::size_t k = 0; k < 9; ++k) a.c[k] = select(mask, a.c[k], b.c[k]);
  return a;
}

/// f(m) = sum_k f(value_k) v_k (x) v_k, for any symmetric m.
template <class T, class Function>
[[gnu::noinline]] Mat<3, T> by_eigenvectors(const Mat<3, T>& m, const Function& f) {
  const SymEigen<3, T> eigen = sym_eigen(m);
  Vec<3, T> values;
  for (int k = 0; k < 3; ++k) values[k] = f(eigen.values[k]);
  return eigen.vectors * Mat<3, T>::diagonal(values) * transpose(eigen.vectors);
}

/// X, X^2 and the invariants of X = m - shift 1: X^3 = first X^2 - second X + third 1.
template <class T>
struct SymPowers {
  Mat<3, T> X, square;
  T first, second, third;
  T size_square;  ///< X : X

  SymPowers(const Mat<3, T>& m, double shift) : X(m) {
    for (int k = 0; k < 3; ++k) X(k, k) = m(k, k) - shift;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        square(i, j) = square(j, i) = X(i, 0) * X(0, j) + X(i, 1) * X(1, j) + X(i, 2) * X(2, j);
    first = trace(X);
    size_square = trace(square);
    second = 0.5 * (first * first - size_square);
    third = determinant(X);
  }
  /// a 1 + b X + c X^2.
  Mat<3, T> polynomial(const T& a, const T& b, const T& c) const {
    Mat<3, T> sum;
    for (std::size_t k = 0; k < 9; ++k) sum.c[k] = b * X.c[k] + c * square.c[k];
    for (int k = 0; k < 3; ++k) sum(k, k) += a;
    return sum;
  }
};

/// ln(1 + X) = integral of X (1 + t X)^-1 over t from 0 to 1, by Gauss' rule with N points.
template <std::size_t N, class T>
Mat<3, T> log_by_rule(const SymPowers<T>& of, const std::array<double, N>& points,
                      const std::array<double, N>& weights) {
  T a(0.0), b(0.0), c(0.0);
  for (std::size_t k = 0; k < N; ++k) {
    // X (1 + t X)^-1 = (t^2 third 1 + (1 + t first) X - t X^2) / det(1 + t X)
    const double t = points[k];
    const T share = weights[k] / (1.0 + t * (of.first + t * (of.second + t * of.third)));
    a += (t * t) * share;
    b += (1.0 + t * of.first) * share;
    c -= t * share;
  }
  return of.polynomial(a * of.third, b, c);
}

}  // namespace detail

/// ln m of a symmetric m with positive eigenvalues, to round-off. Lanes do not see one another. Not-a-number
/// where m is not positive.
template <class T>
Mat<3, T> sym_log(const Mat<3, T>& m) {
  // Gauss' rules are exact to round-off while |m - 1| is below these.
  constexpr double near = 0.25, far = 0.6;
  constexpr std::array<double, 7> near_points{
      0.025446043828620737, 0.129234407200302780, 0.297077424311301416, 0.5,
      0.702922575688698583, 0.870765592799697219, 0.974553956171379262},
      near_weights{0.064742483084434846, 0.139852695744638333, 0.190915025252559472, 0.208979591836734693,
                   0.190915025252559472, 0.139852695744638333, 0.064742483084434846};
  constexpr std::array<double, 13> far_points{0.007908472640705925,
                                              0.041200800388511017,
                                              0.099210954633345043,
                                              0.178825330279829889,
                                              0.275753624481776573,
                                              0.384770842022432602,
                                              0.5,
                                              0.615229157977567397,
                                              0.724246375518223426,
                                              0.821174669720170110,
                                              0.900789045366654956,
                                              0.958799199611488982,
                                              0.992091527359294074},
      far_weights{0.020242002382657939, 0.046060749918864223, 0.069436755109893619, 0.089072990380972869,
                  0.103908023768444251, 0.113141590131448619, 0.116275776615436955, 0.113141590131448619,
                  0.103908023768444251, 0.089072990380972869, 0.069436755109893619, 0.046060749918864223,
                  0.020242002382657939};
  const detail::SymPowers<T> of(m, 1.0);
  const auto is_near = of.size_square <= near * near;
  Mat<3, T> result = detail::log_by_rule(of, near_points, near_weights);
  if (all(is_near)) return result;
  const auto is_far = of.size_square <= far * far;
  Mat<3, T> other = detail::log_by_rule(of, far_points, far_weights);
  if (!all(is_far)) {
    const Mat<3, T> any_size = detail::by_eigenvectors(m, [](const T& x) { return log(x); });
    other = detail::select_of(is_far, other, any_size);
  }
  return detail::select_of(is_near, result, other);
}

/// exp m of a symmetric m, to round-off of its largest eigenvalue. Lanes do not see one another.
template <class T>
Mat<3, T> sym_exp(const Mat<3, T>& m) {
  constexpr double near = 0.25;  // up to there the series has converged
  constexpr int terms = 11;
  const detail::SymPowers<T> of(m, 0.0);
  // 1 + m (1 + m/2 (1 + m/3 (...)))
  T a(1.0), b(0.0), c(0.0);
  for (int k = terms; k > 0; --k) {
    const T share = (1.0 / k) * c;
    c = (1.0 / k) * b + of.first * share;
    b = (1.0 / k) * a - of.second * share;
    a = 1.0 + of.third * share;
  }
  Mat<3, T> result = of.polynomial(a, b, c);
  const auto is_near = of.size_square <= near * near;
  if (all(is_near)) return result;
  return detail::select_of(is_near, result, detail::by_eigenvectors(m, [](const T& x) { return exp(x); }));
}

}  // namespace softgrain
