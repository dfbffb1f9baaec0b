#pragma once
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// An isotropic law in plane strain is a function psi(I, J) of I = F : F (2D) and J = det F, and some are in
/// space. Here its value [J/m^3] and derivatives [Pa] at one F; stress and tangent follow without
/// eigenvectors, so equal stretches are nothing special.
template <int Dim, class T>
struct InvariantResponse {
  Mat<Dim, T> F;
  T energy, d_I, d_J, d_II, d_IJ, d_JJ;
};
template <class T>
using PlaneResponse = InvariantResponse<2, T>;

/// An energy of plane strain [J/m^3] and its derivatives by s = I/(2 J) = cosh(e_1 - e_2) and L = ln J, e_a
/// the logarithmic principal strains.
template <class T>
struct StretchEnergy {
  T value{}, by_s{}, by_L{}, by_ss{}, by_sL{}, by_LL{};
};

/// The same by I and J.
template <class T>
PlaneResponse<T> response_of(const Mat<2, T>& F, const T& s, const StretchEnergy<T>& psi) {
  const T inverse_J = 1.0 / determinant(F), s_I = 0.5 * inverse_J;
  const T first = psi.by_L - s * psi.by_s;  // by L at I, as s falls with L as -s
  const T second = psi.by_LL - 2.0 * s * psi.by_sL + s * (psi.by_s + s * psi.by_ss);
  return {.F = F,
          .energy = psi.value,
          .d_I = psi.by_s * s_I,
          .d_J = first * inverse_J,
          .d_II = psi.by_ss * s_I * s_I,
          .d_IJ = (psi.by_sL - s * psi.by_ss - psi.by_s) * s_I * inverse_J,
          .d_JJ = (second - first) * inverse_J * inverse_J};
}

/// P = 2 psi_I F + psi_J cof F.
template <int Dim, class T>
Mat<Dim, T> stress_of(const InvariantResponse<Dim, T>& psi) {
  return (2.0 * psi.d_I) * psi.F + psi.d_J * cofactor(psi.F);
}

/// dP/dF = 2 psi_I 1 + 4 psi_II F (x) F + 2 psi_IJ (F (x) cof F + cof F (x) F) + psi_JJ cof F (x) cof F
///         + psi_J d(cof F)/dF.
template <int Dim, class T>
Mat<Dim * Dim, T> tangent_of(const InvariantResponse<Dim, T>& psi) {
  const Mat<Dim, T>& F = psi.F;
  const Mat<Dim, T> cof = cofactor(F);
  Mat<Dim * Dim, T> A;
  for (int k = 0; k < Dim * Dim; ++k) A(k, k) = 2.0 * psi.d_I;
  add_outer(A, T(1.0), F, (4.0 * psi.d_II) * F + (2.0 * psi.d_IJ) * cof);
  add_outer(A, T(1.0), cof, (2.0 * psi.d_IJ) * F + psi.d_JJ * cof);
  add_cofactor_derivative(A, psi.d_J, F);
  return A;
}

}  // namespace softgrain
