#pragma once
#include "softgrain/math/tensor.hpp"

namespace softgrain {

// Measures theta(F) of the change of volume at a point, 1 where there is none, to first order det F. A law in
// two parts, psi = psi_dev(F) + U(theta), names the one that stands in its U. `gradient` is dtheta/dF;
// `add_second_derivative` adds weight d^2 theta/dF^2 to A, at (i Dim + J, k Dim + L).

/// theta = J = det F.
struct Determinant {
  template <int Dim, class T>
  T value(const Mat<Dim, T>& F) const {
    return determinant(F);
  }
  template <int Dim, class T>
  Mat<Dim, T> gradient(const Mat<Dim, T>& F) const {
    return cofactor(F);
  }
  template <int Dim, class T>
  void add_second_derivative(Mat<Dim * Dim, T>& A, const T& weight, const Mat<Dim, T>& F) const {
    add_cofactor_derivative(A, weight, F);
  }
};

/// theta = 1 + tr(F - 1), of the small strain.
struct LinearDilatation {
  template <int Dim, class T>
  T value(const Mat<Dim, T>& F) const {
    return trace(F) - double(Dim - 1);
  }
  template <int Dim, class T>
  Mat<Dim, T> gradient(const Mat<Dim, T>&) const {
    return identity<Dim, T>();
  }
  template <int Dim, class T>
  void add_second_derivative(Mat<Dim * Dim, T>&, const T&, const Mat<Dim, T>&) const {}
};

/// theta = 1 + tr(F^T F - 1)/2, of Green's strain.
struct GreenDilatation {
  template <int Dim, class T>
  T value(const Mat<Dim, T>& F) const {
    return 0.5 * contract(F, F) + (1.0 - 0.5 * Dim);
  }
  template <int Dim, class T>
  Mat<Dim, T> gradient(const Mat<Dim, T>& F) const {
    return F;
  }
  template <int Dim, class T>
  void add_second_derivative(Mat<Dim * Dim, T>& A, const T& weight, const Mat<Dim, T>&) const {
    for (int k = 0; k < Dim * Dim; ++k) A(k, k) += weight;
  }
};

/// theta = 1 + tr(S - 1) in plane strain, F = R S: tr S = sqrt(a^2 + b^2) with a = F_11 + F_22,
/// b = F_12 - F_21.
struct StretchDilatation {
  template <class T>
  T value(const Mat<2, T>& F) const {
    return trace_of_stretch(F) - 1.0;
  }
  /// R
  template <class T>
  Mat<2, T> gradient(const Mat<2, T>& F) const {
    const T inverse = 1.0 / trace_of_stretch(F);
    const T c = (F(0, 0) + F(1, 1)) * inverse, s = (F(0, 1) - F(1, 0)) * inverse;
    return {{c, s, -s, c}};
  }
  /// dR/dF = Q (x) Q / tr S, Q = R turned by a right angle
  template <class T>
  void add_second_derivative(Mat<4, T>& A, const T& weight, const Mat<2, T>& F) const {
    const Mat<2, T> R = gradient(F), Q{{-R(0, 1), R(0, 0), -R(0, 0), -R(0, 1)}};
    add_outer(A, weight / trace_of_stretch(F), Q, Q);
  }

 private:
  template <class T>
  static T trace_of_stretch(const Mat<2, T>& F) {
    const T a = F(0, 0) + F(1, 1), b = F(0, 1) - F(1, 0);
    return sqrt(a * a + b * b);
  }
};

}  // namespace softgrain
