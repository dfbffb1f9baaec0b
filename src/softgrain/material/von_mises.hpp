#pragma once
#include "softgrain/material/lame.hpp"
#include "softgrain/material/principal_stretches.hpp"

namespace softgrain {

/// Hencky's law with von Mises' plasticity (theory (44)-(46)): F = F_e F_p, the elastic part answers as
/// Hencky, and flows at constant volume where |dev tau| would exceed sqrt(2/3) (yield_stress + hardening *
/// alpha). The logarithmic strain makes the return to the yield surface that of small strain.
struct VonMises {
  double lambda = 0;        ///< [Pa]
  double mu = 0;            ///< shear modulus [Pa]
  double yield_stress = 0;  ///< Kirchhoff stress at first yield in uniaxial tension [Pa]
  double hardening = 0;     ///< its increase per equivalent plastic strain [Pa]

  /// What a point remembers of its flow. In plane strain too it flows across the plane.
  template <class T>
  struct State {
    Mat<3, T> inverse_plastic = identity<3, T>();  ///< F_p^-1
    T plastic_strain{};                            ///< equivalent plastic strain alpha
  };

  /// Incremental potential [J/m^3 of the undeformed material]: elastic energy at the end of the step plus the
  /// plastic work of the step.
  template <int Dim, class T>
  T energy(const Mat<Dim, T>& F, const State<T>& state) const {
    return response(F, state).psi.energy;
  }
  /// First Piola-Kirchhoff stress P [Pa], the derivative of the incremental potential.
  template <int Dim, class T>
  Mat<Dim, T> stress(const Mat<Dim, T>& F, const State<T>& state) const {
    // P = dpsi/dF_e F_p^-T
    const Mat<3, T> full = stress_of(response(F, state).psi) * transpose(state.inverse_plastic);
    Mat<Dim, T> P;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) P(i, j) = full(i, j);
    return P;
  }
  /// Algorithmic tangent dP_iJ/dF_kL [Pa] at (i Dim + J, k Dim + L); symmetric.
  template <int Dim, class T>
  Mat<Dim * Dim, T> tangent(const Mat<Dim, T>& F, const State<T>& state) const {
    const Mat<3, T>& G = state.inverse_plastic;
    const Mat<9, T> A_e = tangent_of(response(F, state).psi);
    // A_iJkL = (A_e)_iMkN G_JM G_LN, one index after the other.
    Mat<9, T> half;
    for (int row = 0; row < 9; ++row)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          for (int n = 0; n < 3; ++n) half(row, 3 * k + l) += A_e(row, 3 * k + n) * G(l, n);
    Mat<Dim * Dim, T> A;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        for (int column = 0; column < Dim * Dim; ++column)
          for (int m = 0; m < 3; ++m)
            A(i * Dim + j, column) += half(3 * i + m, 3 * (column / Dim) + column % Dim) * G(j, m);
    return A;
  }
  /// The state after a step that ends at F.
  template <int Dim, class T>
  State<T> advance(const Mat<Dim, T>& F, const State<T>& state) const {
    // F_p^-1 <- F_p^-1 exp(-gamma sum_a n_a v_a (x) v_a)
    const auto [psi, gamma, n] = response(F, state);
    Mat<3, T> shrink;
    for (int a = 0; a < 3; ++a) shrink(a, a) = exp(-gamma * n[a]);
    const Mat<3, T>& v = psi.frame.v;
    return {state.inverse_plastic * (v * shrink * transpose(v)),
            state.plastic_strain + root_two_thirds * gamma};
  }
  /// Speed of pressure waves [m/s] in the unstrained material.
  double wave_speed(double density) const { return Lame{lambda, mu}.wave_speed(density); }

 private:
  static constexpr double root_two_thirds = 0.81649658092772603;

  template <class T>
  struct Return {
    PrincipalResponse<T> psi;  ///< as a function of the stretches of the trial F_e = F F_p^-1
    T gamma;                   ///< plastic strain of the step |Delta e_p|
    Vec<3, T> n;               ///< its direction
  };

  template <class T>
  static const Mat<3, T>& in_space(const Mat<3, T>& F) {
    return F;
  }
  template <class T>
  static Mat<3, T> in_space(const Mat<2, T>& F) {
    return {{F(0, 0), F(0, 1), T(0.0), F(1, 0), F(1, 1), T(0.0), T(0.0), T(0.0), T(1.0)}};
  }

  /// Return from the trial strain e along dev e: |dev tau| = 2 mu (|dev e| - gamma) = sqrt(2/3) (yield +
  /// ...).
  template <int Dim, class T>
  Return<T> response(const Mat<Dim, T>& F, const State<T>& state) const {
    Return<T> step;
    step.psi.frame = principal_frame(in_space(F) * state.inverse_plastic);
    const Vec<3, T>& s = step.psi.frame.stretch;
    const Vec<3, T> e{{log(s[0]), log(s[1]), log(s[2])}};
    const T log_J = e[0] + e[1] + e[2], mean = (1.0 / 3.0) * log_J;
    const Vec<3, T> deviator{{e[0] - mean, e[1] - mean, e[2] - mean}};
    const T size = max(sqrt(dot(deviator, deviator)), T(1e-300));  // not zero: it divides
    const T yield = yield_stress + hardening * state.plastic_strain;
    const double stiffness = 2.0 * mu + 2.0 / 3.0 * hardening;
    step.n = (1.0 / size) * deviator;
    step.gamma = max((2.0 * mu * size - root_two_thirds * yield) * (1.0 / stiffness), T(0.0));

    const T left = size - step.gamma, alpha = root_two_thirds * step.gamma;
    const double bulk = lambda + 2.0 / 3.0 * mu;
    step.psi.energy =
        mu * left * left + 0.5 * bulk * log_J * log_J + alpha * (yield + 0.5 * hardening * alpha);
    // dtau/de = bulk 1 (x) 1 + 2 mu (left/size dev + (gamma/size - dgamma/de) n (x) n)
    const T share = left / size;
    const T turn = 1.0 - share - select(step.gamma > T(0.0), T(2.0 * mu / stiffness), T(0.0));
    Mat<3, T> D;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        D(a, b) = bulk + 2.0 * mu * (share * ((a == b) - 1.0 / 3.0) + turn * step.n[a] * step.n[b]);
    differentiate(step.psi, e, mu * share, bulk * log_J - 2.0 * mu * share * mean, D);
    return step;
  }
};

/// From Young's modulus E [Pa], Poisson's ratio nu, yield stress [Pa] and hardening modulus [Pa]; UsageError
/// as lame(E, nu), and unless yield_stress > 0 and hardening >= 0.
inline VonMises von_mises(double E, double nu, double yield_stress, double hardening) {
  const Lame elastic = lame(E, nu);
  require(yield_stress > 0, "the yield stress must be > 0 Pa, got {}", yield_stress);
  require(hardening >= 0, "the hardening modulus must be >= 0 Pa, got {}", hardening);
  return {elastic.lambda, elastic.mu, yield_stress, hardening};
}

}  // namespace softgrain
