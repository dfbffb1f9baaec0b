#pragma once
#include "softgrain/material/principal_stretches.hpp"
#include "softgrain/math/sym_log.hpp"

namespace softgrain {

/// Elastic logarithmic strain of a point in space, F = F_e F_p, from F and G = F_p^-1: ln sqrt(F_e^T F_e),
/// F_e = F G, is e' + ln J/3, as flow keeps the volume. A tensor in the axes of the flowed material, without
/// eigenvectors.
template <class T>
struct SpaceTrial {
  Mat<3, T> F_e, G;
  Mat<3, T> cof;       ///< of F_e
  Mat<3, T> deviator;  ///< e'
  T inverse_J, log_J;

  T square() const { return contract(deviator, deviator); }  ///< |e'|^2
};

template <class T>
SpaceTrial<T> space_trial(const Mat<3, T>& F, const Mat<3, T>& G) {
  SpaceTrial<T> trial;
  trial.F_e = F * G;
  trial.G = G;
  const Mat<3, T>& F_e = trial.F_e;
  trial.cof = cofactor(F_e);
  const T J = F_e(0, 0) * trial.cof(0, 0) + F_e(0, 1) * trial.cof(0, 1) + F_e(0, 2) * trial.cof(0, 2);
  trial.inverse_J = 1.0 / J;
  trial.log_J = log(J);
  const T shape = exp((-2.0 / 3.0) * trial.log_J);
  Mat<3, T> C;  // F_e^T F_e / J^(2/3)
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      C(i, j) = C(j, i) = shape * (F_e(0, i) * F_e(0, j) + F_e(1, i) * F_e(1, j) + F_e(2, i) * F_e(2, j));
  trial.deviator = 0.5 * sym_log(C);
  return trial;
}

/// P of Kirchhoff's stress bulk ln J 1 + 2 shear e' [Pa], e' in the axes of space.
template <class T>
Mat<3, T> stress_of(const SpaceTrial<T>& trial, double bulk, const T& shear) {
  // P = F_e^-T M G^T, M = bulk ln J 1 + 2 shear e' in the axes of the flowed material
  Mat<3, T> M = (2.0 * shear) * trial.deviator;
  for (int k = 0; k < 3; ++k) M(k, k) += bulk * trial.log_J;
  return trial.cof * ((trial.inverse_J * M) * transpose(trial.G));
}

/// dP/dF of the same, with dtau/de = bulk 1 (x) 1 + 2 (shear dev + turn n (x) n), n = e'/|e'| [Pa].
template <class T>
Mat<9, T> tangent_of(const SpaceTrial<T>& trial, double bulk, const T& shear, const T& turn) {
  const SymEigen<3, T> deviator = sym_eigen(trial.deviator);
  const T inverse = 1.0 / max(trial.square(), T(1e-20));
  PrincipalResponse<T> response{.frame = {{}, trial.F_e * deviator.vectors, deviator.vectors},
                                .first = {},
                                .second = {},
                                .quotient = {}};
  Vec<3, T> e;
  Mat<3, T> D;
  for (int a = 0; a < 3; ++a) {
    e[a] = deviator.values[a] + (1.0 / 3.0) * trial.log_J;
    T& stretch = response.frame.stretch[a] = exp(e[a]);
    for (int i = 0; i < 3; ++i) response.frame.u(i, a) = response.frame.u(i, a) / stretch;
    for (int b = 0; b < 3; ++b)
      D(a, b) = bulk + 2.0 * (shear * ((a == b) - 1.0 / 3.0) +
                              turn * inverse * deviator.values[a] * deviator.values[b]);
  }
  differentiate(response, e, shear, (bulk - 2.0 / 3.0 * shear) * trial.log_J, D);
  const Mat<9, T> A_e = tangent_of(response);
  // A_iJkL = (A_e)_iMkN G_JM G_LN, one index after the other.
  const Mat<3, T>& G = trial.G;
  Mat<9, T> half, A;
  for (int row = 0; row < 9; ++row)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        for (int n = 0; n < 3; ++n) half(row, 3 * k + l) += A_e(row, 3 * k + n) * G(l, n);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int column = 0; column < 9; ++column)
        for (int m = 0; m < 3; ++m) A(3 * i + j, column) += half(3 * i + m, column) * G(j, m);
  return A;
}

/// G after a flow that leaves e' <- share e': G exp((share - 1) e').
template <class T>
Mat<3, T> flowed(const SpaceTrial<T>& trial, const T& share) {
  return trial.G * sym_exp((share - 1.0) * trial.deviator);
}

}  // namespace softgrain
