#pragma once
#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_invariants.hpp"
#include "softgrain/material/principal_stretches.hpp"
#include "softgrain/material/volumetric.hpp"
#include "softgrain/math/log_ratio.hpp"

namespace softgrain {

/// Hencky's law (theory (40)-(41)): Hooke's in the logarithmic strains e_a = ln s_a of the principal
/// stretches, psi = mu sum_a e_a^2 + lambda/2 (ln J)^2. The basis of J2 plasticity at finite strain.
struct Hencky {
  static constexpr bool objective = true;
  double lambda = 0;  ///< [Pa]
  double mu = 0;      ///< shear modulus [Pa]

  /// psi(F) [J/m^3 of the undeformed material].
  template <int Dim, class T>
  T energy(const Mat<Dim, T>& F) const {
    return response(F).energy;
  }
  /// First Piola-Kirchhoff stress P = dpsi/dF [Pa].
  template <int Dim, class T>
  Mat<Dim, T> stress(const Mat<Dim, T>& F) const {
    return stress_of(response(F));
  }
  /// dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L).
  template <int Dim, class T>
  Mat<Dim * Dim, T> tangent(const Mat<Dim, T>& F) const {
    return tangent_of(response(F));
  }
  /// Speed of pressure waves [m/s] in the unstrained material.
  double wave_speed(double density) const { return Lame{lambda, mu}.wave_speed(density); }

  /// The law without lambda/2 (ln J)^2, that, and J, for mean dilatation.
  Hencky deviatoric() const { return {0.0, mu}; }
  LogVolume volume() const { return {lambda}; }
  Determinant dilatation() const { return {}; }

 private:
  // Plane strain: psi = (lambda + mu)/2 (ln J)^2 + mu f(s), where s = I / (2 J) = cosh x, x = e_1 - e_2, and
  // f = x^2 / 2. With z = tanh^2(x / 2) = (s - 1) / (s + 1), x = 2 sqrt(z) phi(z): no root near x = 0.
  template <class T>
  PlaneResponse<T> response(const Mat<2, T>& F) const {
    const T a = F(0, 0) - F(1, 1), b = F(0, 1) + F(1, 0);
    const T J = determinant(F), inverse_J = 1.0 / J, log_J = log(J), J2 = inverse_J * inverse_J;
    const T y = 0.5 * (a * a + b * b) * inverse_J, s = 1.0 + y;  // a^2 + b^2 = I - 2 J without cancellation
    const T z = y / (2.0 + y), rest = 1.0 - z;
    const LogRatio<T> phi = log_ratio(z);
    const T f = 2.0 * z * phi.value * phi.value, df = phi.value * rest;
    const T ddf = 0.5 * (phi.derivative * rest - phi.value) * rest * rest;
    const double bulk = lambda + mu;
    return {.F = F,
            .energy = 0.5 * bulk * log_J * log_J + mu * f,
            .d_I = 0.5 * mu * df * inverse_J,
            .d_J = (bulk * log_J - mu * df * s) * inverse_J,
            .d_II = 0.25 * mu * ddf * J2,
            .d_IJ = -0.5 * mu * (ddf * s + df) * J2,
            .d_JJ = (bulk * (1.0 - log_J) + mu * s * (ddf * s + 2.0 * df)) * J2};
  }

  // 3D: Kirchhoff's stress tau_a = 2 mu e_a + lambda ln J.
  template <class T>
  PrincipalResponse<T> response(const Mat<3, T>& F) const {
    PrincipalResponse<T> psi;
    psi.frame = principal_frame(F);
    const Vec<3, T>& s = psi.frame.stretch;
    const Vec<3, T> e{{log(s[0]), log(s[1]), log(s[2])}};
    const T log_J = e[0] + e[1] + e[2];
    psi.energy = mu * dot(e, e) + 0.5 * lambda * log_J * log_J;
    Mat<3, T> D = Mat<3, T>::diagonal({{T(2.0 * mu), T(2.0 * mu), T(2.0 * mu)}});
    for (T& entry : D.c) entry += T(lambda);
    differentiate(psi, e, T(mu), lambda * log_J, D);
    return psi;
  }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu; UsageError as lame(E, nu).
inline Hencky hencky(double E, double nu) {
  const Lame parameters = lame(E, nu);
  return {parameters.lambda, parameters.mu};
}

}  // namespace softgrain
