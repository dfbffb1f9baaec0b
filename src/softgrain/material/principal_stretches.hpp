#pragma once
#include "softgrain/math/log_ratio.hpp"
#include "softgrain/math/sym_eigen.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// F = sum_a stretch[a] u_a (x) v_a; v_a in the columns of `v`, u_a in those of `u`, det F > 0.
template <class T>
struct PrincipalFrame {
  Vec<3, T> stretch;
  Mat<3, T> u, v;
};

/// By the eigenvectors of F^T F.
template <class T>
PrincipalFrame<T> principal_frame(const Mat<3, T>& F) {
  // F^T F = sum_a stretch_a^2 v_a (x) v_a, u_a = F v_a / stretch_a.
  const SymEigen<3, T> C = sym_eigen(transpose(F) * F);
  PrincipalFrame<T> frame{{}, F * C.vectors, C.vectors};
  for (int a = 0; a < 3; ++a) {
    frame.stretch[a] = sqrt(C.values[a]);
    for (int i = 0; i < 3; ++i) frame.u(i, a) = frame.u(i, a) / frame.stretch[a];
  }
  return frame;
}

/// An isotropic law in 3D is a function psi of the principal stretches s_a. Here its value [J/m^3] and
/// derivatives [Pa] at one F. `quotient` is (psi_a - psi_b) / (s_a - s_b), a != b, which the law knows
/// without dividing by zero at equal stretches.
template <class T>
struct PrincipalResponse {
  PrincipalFrame<T> frame{};
  T energy{};
  Vec<3, T> first;     ///< psi_a = dpsi/ds_a
  Mat<3, T> second;    ///< psi_ab
  Mat<3, T> quotient;  ///< a < b
};

/// Fills the derivatives of a law in the logarithmic strains e_a = ln s_a from Kirchhoff's stress
/// tau_a = 2 shear e_a + mean [Pa] and its derivative D_ab = dtau_a/de_b: psi_a = tau_a / s_a.
template <class T>
void differentiate(PrincipalResponse<T>& psi, const Vec<3, T>& e, const T& shear, const T& mean,
                   const Mat<3, T>& D) {
  const Vec<3, T>& s = psi.frame.stretch;
  for (int a = 0; a < 3; ++a) {
    const T tau = 2.0 * shear * e[a] + mean;
    psi.first[a] = tau / s[a];
    psi.second(a, a) = (D(a, a) - tau) / (s[a] * s[a]);
    for (int b = a + 1; b < 3; ++b) {
      const T product = 1.0 / (s[a] * s[b]), sum = s[a] + s[b], q = (s[a] - s[b]) / sum;
      psi.second(a, b) = psi.second(b, a) = D(a, b) * product;
      // (e_a / s_a - e_b / s_b) / (s_a - s_b) = (s_b slope - e_b) / (s_a s_b), slope = (e_a - e_b) / (s_a -
      // s_b).
      const T slope = 2.0 * log_ratio(q * q).value / sum;
      psi.quotient(a, b) = (2.0 * shear * (s[b] * slope - e[b]) - mean) * product;
    }
  }
}

/// The same from any tau_a, D_ab, and slope_ab = (tau_a - tau_b)/(e_a - e_b), a < b, known without dividing
/// by zero.
template <class T>
void differentiate(PrincipalResponse<T>& psi, const Vec<3, T>& tau, const Mat<3, T>& D,
                   const Mat<3, T>& slope) {
  const Vec<3, T>& s = psi.frame.stretch;
  for (int a = 0; a < 3; ++a) {
    psi.first[a] = tau[a] / s[a];
    psi.second(a, a) = (D(a, a) - tau[a]) / (s[a] * s[a]);
    for (int b = a + 1; b < 3; ++b) {
      const T product = 1.0 / (s[a] * s[b]), sum = s[a] + s[b], q = (s[a] - s[b]) / sum;
      psi.second(a, b) = psi.second(b, a) = D(a, b) * product;
      // (e_a - e_b)/(s_a - s_b) = 2 phi(q^2)/sum
      psi.quotient(a, b) = (s[b] * slope(a, b) * (2.0 * log_ratio(q * q).value / sum) - tau[b]) * product;
    }
  }
}

/// P = sum_a psi_a u_a (x) v_a.
template <class T>
Mat<3, T> stress_of(const PrincipalResponse<T>& psi) {
  return psi.frame.u * Mat<3, T>::diagonal(psi.first) * transpose(psi.frame.v);
}

/// dP/dF = sum_ab psi_ab N_aa (x) N_bb + sum_{a<b} q_ab S_ab (x) S_ab + r_ab R_ab (x) R_ab  (theory (42))
/// with N_ab = u_a (x) v_b, stretching S_ab = (N_ab + N_ba) / sqrt 2, rotating R_ab = (N_ab - N_ba) / sqrt 2,
/// q_ab the quotient and r_ab = (psi_a + psi_b) / (s_a + s_b).
template <class T>
Mat<9, T> tangent_of(const PrincipalResponse<T>& psi) {
  const auto& [stretch, u, v] = psi.frame;
  const auto N = [&u = u, &v = v](int a, int b) {
    Mat<3, T> dyad;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) dyad(i, j) = u(i, a) * v(j, b);
    return dyad;
  };
  const Mat<3, T> diagonal[3] = {N(0, 0), N(1, 1), N(2, 2)};
  Mat<9, T> A;
  for (int a = 0; a < 3; ++a) {
    Mat<3, T> row;
    for (int b = 0; b < 3; ++b) row += psi.second(a, b) * diagonal[b];
    add_outer(A, T(1.0), diagonal[a], row);
    for (int b = a + 1; b < 3; ++b) {
      const T r = (psi.first[a] + psi.first[b]) / (stretch[a] + stretch[b]);
      const Mat<3, T> ab = N(a, b), ba = N(b, a), S = ab + ba, R = ab - ba;
      add_outer(A, 0.5 * psi.quotient(a, b), S, S);
      add_outer(A, 0.5 * r, R, R);
    }
  }
  return A;
}

}  // namespace softgrain
