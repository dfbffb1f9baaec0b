#pragma once
#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_invariants.hpp"
#include "softgrain/material/principal_stretches.hpp"
#include "softgrain/material/volumetric.hpp"

namespace softgrain {

/// Corotated law (theory (40)): Hooke's in the turned frame of F = R S,
/// psi = mu |S - 1|^2 + lambda/2 (tr S - 3)^2 (3D; plane strain has S_33 = 1).
/// Finite at J = 0, so a point may turn inside out under enough pressure.
struct Corotated {
  static constexpr bool objective = true;
  double lambda = 0;  ///< [Pa]
  double mu = 0;      ///< shear modulus [Pa]

  /// psi(F) [J/m^3 of the undeformed material].
  template <int Dim, class T>
  T energy(const Mat<Dim, T>& F) const {
    return response(F).energy;
  }
  /// First Piola-Kirchhoff stress P = dpsi/dF [Pa] = R (2 mu (S - 1) + lambda tr(S - 1) 1).
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

  /// The law without lambda/2 (tr S - 2)^2, that, and tr S, for mean dilatation in plane strain.
  Corotated deviatoric() const { return {0.0, mu}; }
  QuadraticVolume volume() const { return {lambda}; }
  StretchDilatation dilatation() const { return {}; }

 private:
  // Plane strain: with t = s_1 + s_2 = sqrt(I + 2 J), psi = mu (I - 2 t + 2) + lambda/2 (t - 2)^2.
  template <class T>
  PlaneResponse<T> response(const Mat<2, T>& F) const {
    const T a = F(0, 0) + F(1, 1), b = F(0, 1) - F(1, 0);
    const T c = F(0, 0) - F(1, 1), d = F(0, 1) + F(1, 0);
    const T t = sqrt(a * a + b * b), inverse_t = 1.0 / t, opening = t - 2.0;
    const T slope = lambda * opening - 2.0 * mu;                                  // dpsi/dt
    const T curvature = 2.0 * (lambda + mu) * inverse_t * inverse_t * inverse_t;  // d(slope / t)/dt / t
    // |S - 1|^2 = ((s_1 - s_2)^2 + (t - 2)^2) / 2, (s_1 - s_2)^2 = I - 2 J: no cancellation at small strain.
    return {.F = F,
            .energy = 0.5 * mu * (c * c + d * d + opening * opening) + 0.5 * lambda * opening * opening,
            .d_I = mu + 0.5 * slope * inverse_t,
            .d_J = slope * inverse_t,
            .d_II = 0.25 * curvature,
            .d_IJ = 0.5 * curvature,
            .d_JJ = curvature};
  }

  // 3D: psi_a = 2 mu (s_a - 1) + lambda (tr S - 3), linear in the stretches.
  template <class T>
  PrincipalResponse<T> response(const Mat<3, T>& F) const {
    PrincipalResponse<T> psi;
    psi.frame = principal_frame(F);
    const Vec<3, T>& s = psi.frame.stretch;
    const Vec<3, T> e{{s[0] - 1.0, s[1] - 1.0, s[2] - 1.0}};
    const T volume = e[0] + e[1] + e[2];
    psi.energy = mu * dot(e, e) + 0.5 * lambda * volume * volume;
    for (int a = 0; a < 3; ++a) {
      psi.first[a] = 2.0 * mu * e[a] + lambda * volume;
      for (int b = 0; b < 3; ++b) {
        psi.second(a, b) = T(a == b ? lambda + 2.0 * mu : lambda);
        psi.quotient(a, b) = T(2.0 * mu);
      }
    }
    return psi;
  }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu; UsageError as lame(E, nu).
inline Corotated corotated(double E, double nu) {
  const Lame parameters = lame(E, nu);
  return {parameters.lambda, parameters.mu};
}

}  // namespace softgrain
