#pragma once
#include "softgrain/math/vec.hpp"
#include "softgrain/math/wide.hpp"

namespace softgrain {

/// m = sum_k value[k] v_k (x) v_k with orthonormal v_k in the columns of `vectors`, in no order.
template <int N, class T>
struct SymEigen {
  Vec<N, T> values;
  Mat<N, T> vectors;
};

namespace detail {
/// Jacobi's rotation in the plane (p, q) that makes m(p, q) zero, of the lanes that still move.
template <int N, class T, class Mask>
void rotate(int p, int q, const Mask& moves, Mat<N, T>& m, Mat<N, T>& vectors) {
  const T zero(0.0), one(1.0);
  // tan of the angle: t^2 + 2 theta t - 1 = 0, the root with |t| <= 1; t = 0 where nothing is to be done.
  const T theta = (m(q, q) - m(p, p)) / (2.0 * m(p, q));
  const T size = 1.0 / (max(theta, -theta) + sqrt(theta * theta + 1.0));
  const T t = select(moves & (max(m(p, q), -m(p, q)) > zero), select(theta < zero, -size, size), zero);
  const T cosine = one / sqrt(t * t + 1.0), sine = t * cosine;
  const T change = t * m(p, q);
  m(p, p) -= change;
  m(q, q) += change;
  m(p, q) = m(q, p) = zero;
  for (int k = 0; k < N; ++k) {
    if (k != p && k != q) {
      const T a = m(p, k), b = m(q, k);
      m(p, k) = m(k, p) = cosine * a - sine * b;
      m(q, k) = m(k, q) = sine * a + cosine * b;
    }
    const T a = vectors(k, p), b = vectors(k, q);
    vectors(k, p) = cosine * a - sine * b;
    vectors(k, q) = sine * a + cosine * b;
  }
}

/// Largest off-diagonal entry, and largest entry of all.
template <int N, class T>
T off_diagonal_size(const Mat<N, T>& m) {
  T largest(0.0);
  for (int p = 0; p < N; ++p)
    for (int q = p + 1; q < N; ++q) largest = max(largest, max(m(p, q), -m(p, q)));
  return largest;
}
template <int N, class T>
T diagonal_size(const Mat<N, T>& m) {
  T largest(0.0);
  for (int p = 0; p < N; ++p) largest = max(largest, max(m(p, p), -m(p, p)));
  return largest;
}
}  // namespace detail

/// Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations: to round-off of the largest
/// eigenvalue, equal eigenvalues included. Lanes do not see one another: one that is done moves no more.
/// Not-a-number in: the same out, without an error.
template <int N, class T>
SymEigen<N, T> sym_eigen(Mat<N, T> m) {
  constexpr int max_sweeps = 12;  // 3 x 3 matrices need 4 to 6
  SymEigen<N, T> result;
  for (int k = 0; k < N; ++k) result.vectors(k, k) = T(1.0);
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    const auto moves = detail::off_diagonal_size(m) > 1e-17 * detail::diagonal_size(m);
    if (!any(moves)) break;
    for (int p = 0; p < N; ++p)
      for (int q = p + 1; q < N; ++q) detail::rotate(p, q, moves, m, result.vectors);
  }
  for (int k = 0; k < N; ++k) result.values[k] = m(k, k);
  return result;
}

}  // namespace softgrain
