#pragma once
#include "softgrain/core/error.hpp"
#include "softgrain/material/ogden.hpp"

namespace softgrain {

/// Mooney and Rivlin's law of rubber (theory (40b)): psi = C10 (J^(-2/3) I1 - 3) + C01 (J^(-4/3) I2 - 3)
/// + K/2 (ln J)^2, 2 (C10 + C01) = mu. In plane strain at constant volume I1 = I2: C01 tells through the
/// change of volume alone.
struct MooneyRivlin {
  static constexpr bool objective = true;
  double lambda = 0;  ///< [Pa]
  double mu = 0;      ///< shear modulus [Pa]
  double c01 = 0;     ///< [Pa]

  /// psi(F) [J/m^3 of the undeformed material].
  template <class T>
  T energy(const Mat<2, T>& F) const {
    return response(F).energy;
  }
  /// First Piola-Kirchhoff stress P = dpsi/dF [Pa].
  template <class T>
  Mat<2, T> stress(const Mat<2, T>& F) const {
    return stress_of(response(F));
  }
  /// dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L).
  template <class T>
  Mat<4, T> tangent(const Mat<2, T>& F) const {
    return tangent_of(response(F));
  }
  /// In space it is Ogden's law with the exponents 2 and -2.
  template <class T>
  T energy(const Mat<3, T>& F) const {
    return in_stretches().energy(F);
  }
  template <class T>
  Mat<3, T> stress(const Mat<3, T>& F) const {
    return in_stretches().stress(F);
  }
  template <class T>
  Mat<9, T> tangent(const Mat<3, T>& F) const {
    return in_stretches().tangent(F);
  }
  /// Speed of pressure waves [m/s] in the unstrained material.
  double wave_speed(double density) const { return Lame{lambda, mu}.wave_speed(density); }

  /// The law without lambda/2 (ln J)^2, that, and J, for mean dilatation.
  MooneyRivlin deviatoric() const { return {0.0, mu, c01}; }
  LogVolume volume() const { return {lambda}; }
  Determinant dilatation() const { return {}; }

 private:
  double c10() const { return mu / 2 - c01; }

  Ogden in_stretches() const {
    return {.lambda = lambda, .mu = mu, .mu_p = {2 * c10(), -2 * c01, 0}, .alpha = {2, -2, 0}};
  }
  // J^(-2/3) I1 = 2 s c + 1/c^2 and J^(-4/3) I2 = 2 s/c + c^2 with c = exp(L/3)
  template <class T>
  PlaneResponse<T> response(const Mat<2, T>& F) const {
    const double bulk = lambda + 2.0 / 3.0 * mu;
    const T a = F(0, 0) - F(1, 1), b = F(0, 1) + F(1, 0), J = determinant(F), L = log(J);
    const T s = 1.0 + 0.5 * (a * a + b * b) / J;
    const T c = exp((1.0 / 3.0) * L), inverse = 1.0 / c;
    const T first = 2.0 * c10() * c, second = 2.0 * c01 * inverse;  // of s
    const T third = c10() * inverse * inverse, fourth = c01 * c * c;
    return response_of(
        F, s,
        StretchEnergy<T>{.value = (first + second) * s + third + fourth - 1.5 * mu + 0.5 * bulk * L * L,
                         .by_s = first + second,
                         .by_L = (1.0 / 3.0) * ((first - second) * s - 2.0 * third + 2.0 * fourth) + bulk * L,
                         .by_ss = T(0.0),
                         .by_sL = (1.0 / 3.0) * (first - second),
                         .by_LL = (1.0 / 9.0) * ((first + second) * s + 4.0 * third + 4.0 * fourth) + bulk});
  }
};

/// From Young's modulus E [Pa], Poisson's ratio nu and C01 [Pa]; C10 = E/(4 (1 + nu)) - C01. UsageError as
/// lame(E, nu), and unless neither is below 0.
inline MooneyRivlin mooney_rivlin(double E, double nu, double c01) {
  const Lame elastic = lame(E, nu);
  require(c01 >= 0 && c01 <= elastic.mu / 2,
          "c01 must lie in [0, {:.4g}] Pa, so that C_10 = E/(4 (1 + nu)) - c01 is not below 0; got {:.4g} Pa",
          elastic.mu / 2, c01);
  return {elastic.lambda, elastic.mu, c01};
}

}  // namespace softgrain
