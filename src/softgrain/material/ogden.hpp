#pragma once
#include <array>

#include "softgrain/core/error.hpp"
#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_invariants.hpp"
#include "softgrain/material/principal_stretches.hpp"
#include "softgrain/material/volumetric.hpp"
#include "softgrain/math/cosh_multiple.hpp"

namespace softgrain {

/// Ogden's law of rubber (theory (40c)) in the stretches without the change of volume, s_a J^(-1/3):
/// psi = sum_p mu_p/alpha_p (sum_a (s_a J^(-1/3))^alpha_p - 3) + K/2 (ln J)^2, mu = sum_p mu_p alpha_p/2.
struct Ogden {
  static constexpr bool objective = true;
  static constexpr int most_terms = 3;
  double lambda = 0;                       ///< [Pa]
  double mu = 0;                           ///< shear modulus [Pa]
  std::array<double, most_terms> mu_p{};   ///< [Pa]; a term of 0 is none
  std::array<double, most_terms> alpha{};  ///< exponents

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
  Ogden deviatoric() const { return {0.0, mu, mu_p, alpha}; }
  LogVolume volume() const { return {lambda}; }
  Determinant dilatation() const { return {}; }

 private:
  double bulk() const { return lambda + 2.0 / 3.0 * mu; }

  // Plane strain: the strains without the change of volume are L/6 +- x/2 and -L/3, cosh x = s.
  template <class T>
  PlaneResponse<T> response(const Mat<2, T>& F) const {
    const T a = F(0, 0) - F(1, 1), b = F(0, 1) + F(1, 0), J = determinant(F), L = log(J);
    const T y = 0.5 * (a * a + b * b) / J;  // s - 1, as I - 2 J = a^2 + b^2
    StretchEnergy<T> psi{.value = 0.5 * bulk() * L * L, .by_L = bulk() * L, .by_LL = T(bulk())};
    for (std::size_t p = 0; p < alpha.size(); ++p) {
      if (mu_p[p] == 0) continue;
      const double third = alpha[p] / 3, sixth = alpha[p] / 6;
      const T up = exp(sixth * L), across = (mu_p[p] / alpha[p]) / (up * up);
      const T in_plane = (2.0 * mu_p[p] / alpha[p]) * up;
      const CoshMultiple<T> cosh = cosh_multiple(0.5 * alpha[p], y);
      psi.value += in_plane * cosh.value + across - 3.0 * mu_p[p] / alpha[p];
      psi.by_s += in_plane * cosh.first;
      psi.by_ss += in_plane * cosh.second;
      psi.by_L += sixth * in_plane * cosh.value - third * across;
      psi.by_sL += sixth * in_plane * cosh.first;
      psi.by_LL += sixth * sixth * in_plane * cosh.value + third * third * across;
    }
    return response_of(F, T(1.0 + y), psi);
  }

  // 3D: tau_a = sum_p mu_p (E_a - mean E) + K ln J, E_a = exp(alpha_p e'_a).
  template <class T>
  PrincipalResponse<T> response(const Mat<3, T>& F) const {
    PrincipalResponse<T> psi;
    psi.frame = principal_frame(F);
    const Vec<3, T>& s = psi.frame.stretch;
    Vec<3, T> e{{log(s[0]), log(s[1]), log(s[2])}};
    const T L = e[0] + e[1] + e[2], mean = (1.0 / 3.0) * L;
    for (int a = 0; a < 3; ++a) e[a] -= mean;
    psi.energy = 0.5 * bulk() * L * L;
    Vec<3, T> tau{{bulk() * L, bulk() * L, bulk() * L}};
    Mat<3, T> D, slope;
    for (T& entry : D.c) entry = T(bulk());
    for (std::size_t p = 0; p < alpha.size(); ++p)
      if (mu_p[p] != 0) add_term(mu_p[p], alpha[p], e, psi.energy, tau, D, slope);
    differentiate(psi, tau, D, slope);
    return psi;
  }
  template <class T>
  static void add_term(double m, double alpha, const Vec<3, T>& e, T& energy, Vec<3, T>& tau, Mat<3, T>& D,
                       Mat<3, T>& slope) {
    const Vec<3, T> E{{exp(alpha * e[0]), exp(alpha * e[1]), exp(alpha * e[2])}};
    const T third = (1.0 / 3.0) * (E[0] + E[1] + E[2]);
    energy += (3.0 * m / alpha) * (third - 1.0);
    for (int a = 0; a < 3; ++a) {
      tau[a] += m * (E[a] - third);
      D(a, a) += m * alpha * E[a];
      for (int b = 0; b < 3; ++b) {
        D(a, b) += (m * alpha / 3.0) * (third - E[a] - E[b]);
        if (b > a)
          slope(a, b) +=
              (m * alpha) * exp((0.5 * alpha) * (e[a] + e[b])) * sinh_ratio(T((0.5 * alpha) * (e[a] - e[b])));
      }
    }
  }
};

/// From Young's modulus E [Pa], Poisson's ratio nu, the exponents, and the shares that the second and the
/// third term have in the shear modulus, mu_p = 2 share_p mu/alpha_p; the first has the rest. UsageError as
/// lame(E, nu), unless the shares are >= 0 and leave the first something, and for a share without an
/// exponent: each mu_p alpha_p > 0, so that stretched rubber resists.
inline Ogden ogden(double E, double nu, const std::array<double, Ogden::most_terms>& exponents,
                   double share_2, double share_3) {
  const Lame elastic = lame(E, nu);
  require(
      share_2 >= 0 && share_3 >= 0 && share_2 + share_3 < 1,
      "ogden_share_2 and ogden_share_3 must be >= 0 and leave something of the shear modulus to the first "
      "term, got {} and {}",
      share_2, share_3);
  const std::array shares{1 - share_2 - share_3, share_2, share_3};
  Ogden law{.lambda = elastic.lambda, .mu = elastic.mu};
  for (std::size_t p = 0; p < shares.size(); ++p) {
    if (shares[p] == 0) continue;
    require(exponents[p] != 0, "ogden_exponent_{} must not be 0 where its term has a share", p + 1);
    law.alpha[p] = exponents[p];
    law.mu_p[p] = 2 * shares[p] * elastic.mu / exponents[p];
  }
  return law;
}

}  // namespace softgrain
