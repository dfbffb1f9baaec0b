#pragma once
#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_invariants.hpp"
#include "softgrain/material/space_flow.hpp"
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
    if constexpr (Dim == 3) {
      const SpaceTrial<T> e = logarithm(F);
      return mu * e.square() + 0.5 * bulk() * e.log_J * e.log_J;
    } else {
      return response(F).energy;
    }
  }
  /// First Piola-Kirchhoff stress P = dpsi/dF [Pa].
  template <int Dim, class T>
  Mat<Dim, T> stress(const Mat<Dim, T>& F) const {
    if constexpr (Dim == 3)
      return stress_of(logarithm(F), bulk(), T(mu));
    else
      return stress_of(response(F));
  }
  /// dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L).
  template <int Dim, class T>
  Mat<Dim * Dim, T> tangent(const Mat<Dim, T>& F) const {
    if constexpr (Dim == 3)
      return tangent_of(logarithm(F), bulk(), T(mu), T(0.0));
    else
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

  // 3D: tau = 2 mu e' + bulk ln J 1, from ln sqrt(F^T F) = e' + ln J/3.
  template <class T>
  static SpaceTrial<T> logarithm(const Mat<3, T>& F) {
    return space_trial(F, identity<3, T>());
  }
  double bulk() const { return lambda + 2.0 / 3.0 * mu; }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu; UsageError as lame(E, nu).
inline Hencky hencky(double E, double nu) {
  const Lame parameters = lame(E, nu);
  return {parameters.lambda, parameters.mu};
}

}  // namespace softgrain
