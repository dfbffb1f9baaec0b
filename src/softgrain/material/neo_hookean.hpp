#pragma once
#include <algorithm>

#include "softgrain/material/dilatation.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/material/volumetric.hpp"
#include "softgrain/math/log_inverse.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// Compressible neo-Hookean law (theory (38)-(39)): psi = mu/2 (I1 - 3) - mu ln J + U(J), I1 = tr F^T F (3D;
/// plane strain has F_33 = 1). The default: it stiffens under compression and never lets a point invert.
/// Stress and tangent are the innermost kernels, hence always_inline.
template <class Volume>
struct NeoHookean {
  static constexpr bool objective = true;
  double mu = 0;  ///< shear modulus [Pa]
  Volume volumetric;

  /// psi(F) [J/m^3 of the undeformed material].
  template <int Dim, class T>
  T energy(const Mat<Dim, T>& F) const {
    const T J = determinant(F);
    return 0.5 * mu * (contract(F, F) - double(Dim)) - mu * log(J) + volumetric.energy(J);
  }

  /// First Piola-Kirchhoff stress P = dpsi/dF [Pa] = mu F + h cof F, h = U'(J) - mu / J.
  template <int Dim, class T>
  [[gnu::always_inline]] Mat<Dim, T> stress(const Mat<Dim, T>& F) const {
    const T J = determinant(F), h = volumetric.derivative(J) - mu * (1.0 / J);
    const Mat<Dim, T> cof = cofactor(F);
    Mat<Dim, T> P;
    for (std::size_t k = 0; k < P.c.size(); ++k) P.c[k] = mu * F.c[k] + h * cof.c[k];
    return P;
  }
  /// h_p = U'(mean J) - mu / J_p [Pa] of N points that share one mean J. With all J near one the inverses and
  /// the logarithm are those of log_inverse.
  template <class T, std::size_t N>
  [[gnu::always_inline]] std::array<T, N> cofactor_factors(const std::array<T, N>& J, const T& mean_J) const {
    std::array<T, N + 1> numbers;
    std::copy(J.begin(), J.end(), numbers.begin());
    numbers[N] = mean_J;
    const LogInverse<T, N + 1> of = log_inverse(numbers);
    const T pressure = volumetric.kirchhoff(mean_J, of.log[N]) * of.inverse[N];
    std::array<T, N> h;
    for (std::size_t p = 0; p < N; ++p) h[p] = pressure - mu * of.inverse[p];
    return h;
  }

  /// h_p = U'(J_p) - mu / J_p [Pa] of N points, each with its own J.
  template <class T, std::size_t N>
  [[gnu::always_inline]] std::array<T, N> cofactor_factors(const std::array<T, N>& J) const {
    const LogInverse<T, N> of = log_inverse(J);
    std::array<T, N> h;
    for (std::size_t p = 0; p < N; ++p) h[p] = (volumetric.kirchhoff(J[p], of.log[p]) - mu) * of.inverse[p];
    return h;
  }

  /// dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L) = mu 1 + h' cof F (x) cof F + h d(cof F)/dF.
  template <int Dim, class T>
  [[gnu::always_inline]] Mat<Dim * Dim, T> tangent(const Mat<Dim, T>& F) const {
    const T J = determinant(F), inverse_J = 1.0 / J;
    const T h = volumetric.derivative(J) - mu * inverse_J;
    const T dh_dJ = volumetric.second_derivative(J) + mu * (inverse_J * inverse_J);
    Mat<Dim * Dim, T> A;
    for (int k = 0; k < Dim * Dim; ++k) A(k, k) = T(mu);
    const Mat<Dim, T> cof = cofactor(F);
    add_outer(A, dh_dJ, cof, cof);
    add_cofactor_derivative(A, h, F);
    return A;
  }

  /// Speed of pressure waves [m/s] in the unstrained material.
  double wave_speed(double density) const { return Lame{volumetric.lambda, mu}.wave_speed(density); }

  /// The law without U(J), U, and J, for mean dilatation.
  NeoHookean<NoVolume> deviatoric() const { return {mu, {}}; }
  Volume volume() const { return volumetric; }
  Determinant dilatation() const { return {}; }
};

/// From Young's modulus E [Pa] and Poisson's ratio nu; UsageError as lame(E, nu).
inline NeoHookean<LogVolume> neo_hookean(double E, double nu) {
  const Lame parameters = lame(E, nu);
  return {parameters.mu, {parameters.lambda}};
}
inline NeoHookean<QuadraticVolume> neo_hookean_quadratic(double E, double nu) {
  const Lame parameters = lame(E, nu);
  return {parameters.mu, {parameters.lambda}};
}

}  // namespace softgrain
