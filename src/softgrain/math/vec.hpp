#pragma once
#include <array>
#include <cmath>
#include <type_traits>

namespace softgrain {

/// Vector of N numbers; plain data, no allocation. v[0] is the first component. T is double, or lanes of
/// doubles where several grains are worked on at once.
template <int N, class T = double>
struct Vec {
  std::array<T, N> c{};

  constexpr T& operator[](int k) { return c[static_cast<std::size_t>(k)]; }
  constexpr const T& operator[](int k) const { return c[static_cast<std::size_t>(k)]; }
  constexpr bool operator==(const Vec& b) const {
    for (std::size_t k = 0; k < c.size(); ++k)
      if (!(c[k] == b.c[k])) return false;
    return true;
  }

  constexpr Vec& operator+=(const Vec& b) {
    for (int k = 0; k < N; ++k) (*this)[k] += b[k];
    return *this;
  }
  constexpr Vec& operator-=(const Vec& b) {
    for (int k = 0; k < N; ++k) (*this)[k] -= b[k];
    return *this;
  }
  constexpr Vec& operator*=(const T& s) {
    for (int k = 0; k < N; ++k) (*this)[k] *= s;
    return *this;
  }
};

template <int N, class T>
constexpr Vec<N, T> operator+(Vec<N, T> a, const Vec<N, T>& b) {
  return a += b;
}
template <int N, class T>
constexpr Vec<N, T> operator-(Vec<N, T> a, const Vec<N, T>& b) {
  return a -= b;
}
template <int N, class T>
constexpr Vec<N, T> operator-(const Vec<N, T>& a) {
  return Vec<N, T>{} - a;
}
template <int N, class T>
constexpr Vec<N, T> operator*(const std::type_identity_t<T>& s, Vec<N, T> a) {
  return a *= s;
}
template <int N, class T>
constexpr T dot(const Vec<N, T>& a, const Vec<N, T>& b) {
  T sum{};
  for (int k = 0; k < N; ++k) sum += a[k] * b[k];
  return sum;
}
template <int N>
double norm(const Vec<N>& a) {
  return std::sqrt(dot(a, a));
}

constexpr Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// e_z x a: the vector turned left by a right angle.
constexpr Vec<2> perpendicular(const Vec<2>& a) { return {-a[1], a[0]}; }

/// N x N matrix, row-major: m(i, j).
template <int N, class T = double>
struct Mat {
  std::array<T, N * N> c{};

  constexpr T& operator()(int i, int j) { return c[static_cast<std::size_t>(i * N + j)]; }
  constexpr const T& operator()(int i, int j) const { return c[static_cast<std::size_t>(i * N + j)]; }
  constexpr bool operator==(const Mat& b) const {
    for (std::size_t k = 0; k < c.size(); ++k)
      if (!(c[k] == b.c[k])) return false;
    return true;
  }

  static constexpr Mat diagonal(const Vec<N, T>& d) {
    Mat m;
    for (int k = 0; k < N; ++k) m(k, k) = d[k];
    return m;
  }
};

template <int N, class T>
constexpr Vec<N, T> operator*(const Mat<N, T>& m, const Vec<N, T>& a) {
  Vec<N, T> b;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) b[i] += m(i, j) * a[j];
  return b;
}

}  // namespace softgrain
