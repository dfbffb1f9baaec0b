#pragma once
#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/volumetric.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// St Venant-Kirchhoff law (theory (40)): Hooke's in Green's strain E = (F^T F - 1) / 2,
/// psi = mu E : E + lambda/2 (tr E)^2. It gives the lower slope at large strain of the paper's Fig. 1, for a
/// reason that no rubber has: its stress falls below a stretch of 1/sqrt(3), and a point may turn inside out
/// for a finite energy. Not for packings.
struct StVenantKirchhoff {
  static constexpr bool objective = true;
  double lambda = 0;  ///< [Pa]
  double mu = 0;      ///< shear modulus [Pa]

  /// psi(F) [J/m^3 of the undeformed material].
  template <int Dim, class T>
  T energy(const Mat<Dim, T>& F) const {
    const Mat<Dim, T> E = strain(F);
    const T volume = trace(E);
    return mu * contract(E, E) + 0.5 * lambda * volume * volume;
  }
  /// First Piola-Kirchhoff stress P = dpsi/dF [Pa] = F S, S = 2 mu E + lambda tr(E) 1.
  template <int Dim, class T>
  Mat<Dim, T> stress(const Mat<Dim, T>& F) const {
    return F * second_stress(F);
  }
  /// dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L) = d_ik S_JL + lambda F_iJ F_kL + mu (F_iL F_kJ + (F F^T)_ik
  /// d_JL).
  template <int Dim, class T>
  Mat<Dim * Dim, T> tangent(const Mat<Dim, T>& F) const {
    const Mat<Dim, T> S = second_stress(F), b = F * transpose(F);
    Mat<Dim * Dim, T> A;
    add_outer(A, T(lambda), F, F);
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        for (int k = 0; k < Dim; ++k) {
          for (int l = 0; l < Dim; ++l) A(i * Dim + j, k * Dim + l) += mu * F(i, l) * F(k, j);
          A(i * Dim + j, k * Dim + j) += mu * b(i, k);
          A(k * Dim + i, k * Dim + j) += S(i, j);
        }
    return A;
  }
  /// Speed of pressure waves [m/s] in the unstrained material.
  double wave_speed(double density) const { return Lame{lambda, mu}.wave_speed(density); }

  /// The law without lambda/2 (tr E)^2, that, and tr E, for mean dilatation.
  StVenantKirchhoff deviatoric() const { return {0.0, mu}; }
  QuadraticVolume volume() const { return {lambda}; }
  GreenDilatation dilatation() const { return {}; }

 private:
  template <int Dim, class T>
  static Mat<Dim, T> strain(const Mat<Dim, T>& F) {
    return 0.5 * (transpose(F) * F - identity<Dim, T>());
  }
  /// Second Piola-Kirchhoff stress S [Pa].
  template <int Dim, class T>
  Mat<Dim, T> second_stress(const Mat<Dim, T>& F) const {
    const Mat<Dim, T> E = strain(F);
    return (2.0 * mu) * E + (lambda * trace(E)) * identity<Dim, T>();
  }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu; UsageError as lame(E, nu).
inline StVenantKirchhoff st_venant_kirchhoff(double E, double nu) {
  const Lame parameters = lame(E, nu);
  return {parameters.lambda, parameters.mu};
}

}  // namespace softgrain
