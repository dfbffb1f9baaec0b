#pragma once
#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/volumetric.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// Hooke's law (theory (40)) in the small strain e = sym(F - 1): psi = mu e : e + lambda/2 (tr e)^2.
/// For small rotations only: a rotated, unstrained point has stress. Its tangent is constant.
struct SmallStrainHooke {
  static constexpr bool objective = false;
  double lambda = 0;  ///< [Pa]
  double mu = 0;      ///< shear modulus [Pa]

  /// psi(F) [J/m^3 of the undeformed material].
  template <int Dim, class T>
  T energy(const Mat<Dim, T>& F) const {
    const Mat<Dim, T> e = strain(F);
    const T volume = trace(e);
    return mu * contract(e, e) + 0.5 * lambda * volume * volume;
  }
  /// Stress P = dpsi/dF [Pa] = 2 mu e + lambda tr(e) 1.
  template <int Dim, class T>
  Mat<Dim, T> stress(const Mat<Dim, T>& F) const {
    const Mat<Dim, T> e = strain(F);
    return (2.0 * mu) * e + (lambda * trace(e)) * identity<Dim, T>();
  }
  /// dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L) = lambda d_iJ d_kL + mu (d_ik d_JL + d_iL d_kJ), whatever F.
  template <int Dim, class T>
  Mat<Dim * Dim, T> tangent(const Mat<Dim, T>&) const {
    Mat<Dim * Dim, T> A;
    add_outer(A, T(lambda), identity<Dim, T>(), identity<Dim, T>());
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        A(i * Dim + j, i * Dim + j) += T(mu);
        A(i * Dim + j, j * Dim + i) += T(mu);
      }
    return A;
  }
  /// Speed of pressure waves [m/s].
  double wave_speed(double density) const { return Lame{lambda, mu}.wave_speed(density); }

  /// The law without lambda/2 (tr e)^2, that, and tr e, for mean dilatation.
  SmallStrainHooke deviatoric() const { return {0.0, mu}; }
  QuadraticVolume volume() const { return {lambda}; }
  LinearDilatation dilatation() const { return {}; }

 private:
  template <int Dim, class T>
  static Mat<Dim, T> strain(const Mat<Dim, T>& F) {
    return symmetric_part(F - identity<Dim, T>());
  }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu; UsageError as lame(E, nu).
inline SmallStrainHooke small_strain_hooke(double E, double nu) {
  const Lame parameters = lame(E, nu);
  return {parameters.lambda, parameters.mu};
}

}  // namespace softgrain
