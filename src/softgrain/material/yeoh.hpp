#pragma once
#include <algorithm>
#include <cmath>

#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/plane_invariants.hpp"
#include "softgrain/material/volumetric.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// Yeoh's law for filled rubber (theory (40a)): psi = C10 i + C20 i^2 + C30 i^3 + K/2 (ln J)^2 with C10 =
/// mu/2, K = lambda + 2/3 mu and i = J^(-2/3) I1 - 3, I1 = tr F^T F (3D; plane strain has F_33 = 1). It takes
/// the S of a rubber's curve from I1 alone; a term of I2 as Mooney-Rivlin's would say nothing new in plane
/// strain, where I2 = I1 at constant volume.
struct Yeoh {
  static constexpr bool objective = true;
  double lambda = 0;  ///< [Pa]
  double mu = 0;      ///< shear modulus [Pa]
  double c20 = 0;     ///< [Pa]
  double c30 = 0;     ///< [Pa]

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

  /// The law without U(J), U, and J, for mean dilatation.
  Yeoh deviatoric() const { return {0.0, mu, c20, c30}; }
  LogVolume volume() const { return {lambda}; }
  Determinant dilatation() const { return {}; }

 private:
  template <int Dim, class T>
  InvariantResponse<Dim, T> response(const Mat<Dim, T>& F) const {
    const double bulk = lambda + 2.0 / 3.0 * mu;
    const T J = determinant(F), inverse_J = 1.0 / J, log_J = log(J), q = exp((-2.0 / 3.0) * log_J);
    const T i_3 = q * (contract(F, F) + double(3 - Dim)), i = i_3 - 3.0;
    const T w = i * (0.5 * mu + i * (c20 + c30 * i));
    const T dw = 0.5 * mu + i * (2.0 * c20 + 3.0 * c30 * i), ddw = 2.0 * c20 + 6.0 * c30 * i;
    const T i_J = (-2.0 / 3.0) * i_3 * inverse_J;  // i_I = q
    return {
        .F = F,
        .energy = w + 0.5 * bulk * log_J * log_J,
        .d_I = dw * q,
        .d_J = dw * i_J + bulk * log_J * inverse_J,
        .d_II = ddw * q * q,
        .d_IJ = q * (ddw * i_J - (2.0 / 3.0) * dw * inverse_J),
        .d_JJ = ddw * i_J * i_J + ((10.0 / 9.0) * dw * i_3 + bulk * (1.0 - log_J)) * inverse_J * inverse_J};
  }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu, which give C10 = E/(4 (1 + nu)), and the coefficients
/// of (I1 - 3)^2 and ^3 [Pa]. UsageError as lame(E, nu), and unless dpsi/dI1 > 0 at any stretch: otherwise a
/// stretched point would want to stretch further.
inline Yeoh yeoh(double E, double nu, double c20, double c30) {
  const Lame elastic = lame(E, nu);
  const double c10 = elastic.mu / 2;
  require(c30 >= 0 && (c20 >= 0 || c20 * c20 < 3 * c10 * c30),
          "stretched rubber must resist: c30 >= 0, and c20 > -sqrt(3 C_10 c30) = {:.4g} Pa with C_10 = "
          "E/(4 (1 + nu)) = {:.4g} Pa; got c20 = {:.4g} Pa, c30 = {:.4g} Pa",
          -std::sqrt(3 * c10 * std::max(c30, 0.0)), c10, c20, c30);
  return {elastic.lambda, elastic.mu, c20, c30};
}

}  // namespace softgrain
