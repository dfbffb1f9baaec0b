#pragma once
#include <array>
#include <cmath>

namespace softgrain {

/// Vector of N doubles; plain data, no allocation. v[0] is the first component.
template <int N>
struct Vec {
  std::array<double, N> c{};

  constexpr double& operator[](int k) { return c[static_cast<std::size_t>(k)]; }
  constexpr const double& operator[](int k) const { return c[static_cast<std::size_t>(k)]; }
  constexpr bool operator==(const Vec&) const = default;

  constexpr Vec& operator+=(const Vec& b) {
    for (int k = 0; k < N; ++k) (*this)[k] += b[k];
    return *this;
  }
  constexpr Vec& operator-=(const Vec& b) {
    for (int k = 0; k < N; ++k) (*this)[k] -= b[k];
    return *this;
  }
  constexpr Vec& operator*=(double s) {
    for (int k = 0; k < N; ++k) (*this)[k] *= s;
    return *this;
  }
};

template <int N>
constexpr Vec<N> operator+(Vec<N> a, const Vec<N>& b) {
  return a += b;
}
template <int N>
constexpr Vec<N> operator-(Vec<N> a, const Vec<N>& b) {
  return a -= b;
}
template <int N>
constexpr Vec<N> operator-(const Vec<N>& a) {
  return Vec<N>{} - a;
}
template <int N>
constexpr Vec<N> operator*(double s, Vec<N> a) {
  return a *= s;
}
template <int N>
constexpr double dot(const Vec<N>& a, const Vec<N>& b) {
  double sum = 0;
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
template <int N>
struct Mat {
  std::array<double, N * N> c{};

  constexpr double& operator()(int i, int j) { return c[static_cast<std::size_t>(i * N + j)]; }
  constexpr double operator()(int i, int j) const { return c[static_cast<std::size_t>(i * N + j)]; }
  constexpr bool operator==(const Mat&) const = default;

  static constexpr Mat diagonal(const Vec<N>& d) {
    Mat m;
    for (int k = 0; k < N; ++k) m(k, k) = d[k];
    return m;
  }
};

template <int N>
constexpr Vec<N> operator*(const Mat<N>& m, const Vec<N>& a) {
  Vec<N> b;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) b[i] += m(i, j) * a[j];
  return b;
}

}  // namespace softgrain
