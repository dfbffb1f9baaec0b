#pragma once
#include <cstddef>

#include "softgrain/math/vec.hpp"

namespace softgrain {

// Algebra of N x N matrices, N = 2 or 3 where a determinant is needed. T is double or lanes of doubles.

template <int N, class T>
constexpr Mat<N, T>& operator+=(Mat<N, T>& a, const Mat<N, T>& b) {
  for (std::size_t k = 0; k < a.c.size(); ++k) a.c[k] += b.c[k];
  return a;
}
template <int N, class T>
constexpr Mat<N, T>& operator-=(Mat<N, T>& a, const Mat<N, T>& b) {
  for (std::size_t k = 0; k < a.c.size(); ++k) a.c[k] -= b.c[k];
  return a;
}
template <int N, class T>
constexpr Mat<N, T> operator+(Mat<N, T> a, const Mat<N, T>& b) {
  return a += b;
}
template <int N, class T>
constexpr Mat<N, T> operator-(Mat<N, T> a, const Mat<N, T>& b) {
  return a -= b;
}
template <int N, class T>
constexpr Mat<N, T> operator*(const std::type_identity_t<T>& s, Mat<N, T> a) {
  for (T& entry : a.c) entry *= s;
  return a;
}

/// Matrix product a_ik b_kj.
template <int N, class T>
constexpr Mat<N, T> operator*(const Mat<N, T>& a, const Mat<N, T>& b) {
  Mat<N, T> product;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      T sum = a(i, 0) * b(0, j);
      for (int k = 1; k < N; ++k) sum += a(i, k) * b(k, j);
      product(i, j) = sum;
    }
  return product;
}

template <int N, class T = double>
constexpr Mat<N, T> identity() {
  Mat<N, T> m;
  for (int k = 0; k < N; ++k) m(k, k) = T(1.0);
  return m;
}

template <int N, class T>
constexpr Mat<N, T> transpose(const Mat<N, T>& m) {
  Mat<N, T> t;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) t(i, j) = m(j, i);
  return t;
}

template <int N, class T>
constexpr T trace(const Mat<N, T>& m) {
  T sum = m(0, 0);
  for (int k = 1; k < N; ++k) sum += m(k, k);
  return sum;
}

/// Double contraction a : b = a_ij b_ij.
template <int N, class T>
constexpr T contract(const Mat<N, T>& a, const Mat<N, T>& b) {
  T sum = a.c[0] * b.c[0];
  for (std::size_t k = 1; k < a.c.size(); ++k) sum += a.c[k] * b.c[k];
  return sum;
}

/// (m + m^T) / 2.
template <int N, class T>
constexpr Mat<N, T> symmetric_part(const Mat<N, T>& m) {
  Mat<N, T> s;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) s(i, j) = 0.5 * (m(i, j) + m(j, i));
  return s;
}

/// cof m = det(m) m^-T, the derivative of det(m) with respect to m; exists for singular m too.
template <class T>
constexpr Mat<2, T> cofactor(const Mat<2, T>& m) {
  return {{m(1, 1), -m(1, 0), -m(0, 1), m(0, 0)}};
}
template <class T>
constexpr Mat<3, T> cofactor(const Mat<3, T>& m) {
  Mat<3, T> cof;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cof(i, j) = m(i1, j1) * m(i2, j2) - m(i1, j2) * m(i2, j1);
    }
  return cof;
}

template <class T>
constexpr T determinant(const Mat<2, T>& m) {
  return m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0);
}
template <class T>
constexpr T determinant(const Mat<3, T>& m) {
  return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) +
         m(0, 1) * (m(1, 2) * m(2, 0) - m(1, 0) * m(2, 2)) +
         m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
}

/// Inverse; infinite or NaN where the determinant is 0.
template <int N, class T>
constexpr Mat<N, T> inverse(const Mat<N, T>& m) {
  return (1.0 / determinant(m)) * transpose(cofactor(m));
}

/// Adds s d(cof m)_ij / dm_kl to a(i N + j, k N + l): the second derivative of the determinant.
template <class T>
constexpr void add_cofactor_derivative(Mat<4, T>& a, const T& s, const Mat<2, T>&) {
  a(0, 3) += s;
  a(3, 0) += s;
  a(1, 2) -= s;
  a(2, 1) -= s;
}
template <class T>
constexpr void add_cofactor_derivative(Mat<9, T>& a, const T& s, const Mat<3, T>& m) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3, row = 3 * i + j;
      a(row, 3 * i1 + j1) += s * m(i2, j2);
      a(row, 3 * i2 + j2) += s * m(i1, j1);
      a(row, 3 * i1 + j2) -= s * m(i2, j1);
      a(row, 3 * i2 + j1) -= s * m(i1, j2);
    }
}

/// Adds s a_ij b_kl to sum(i N + j, k N + l).
template <int N, class T>
constexpr void add_outer(Mat<N * N, T>& sum, const T& s, const Mat<N, T>& a, const Mat<N, T>& b) {
  for (int row = 0; row < N * N; ++row) {
    const T s_a = s * a.c[static_cast<std::size_t>(row)];
    for (int column = 0; column < N * N; ++column)
      sum(row, column) += s_a * b.c[static_cast<std::size_t>(column)];
  }
}

}  // namespace softgrain
