#pragma once
#include "softgrain/material/principal_stretches.hpp"

namespace softgrain {

/// Elastic logarithmic strains of a point in space, F = F_e F_p, from F and G = F_p^-1: F_e = F G has the
/// principal stretches s_a = exp(e_a), e_a = e'_a + ln J/3, as flow keeps the volume.
template <class T>
struct SpaceTrial {
  PrincipalFrame<T> frame;  ///< of F_e
  Mat<3, T> G;
  Vec<3, T> e, deviator;  ///< e_a, e'_a
  T log_J;

  T square() const { return dot(deviator, deviator); }  ///< |e'|^2
};

template <class T>
SpaceTrial<T> space_trial(const Mat<3, T>& F, const Mat<3, T>& G) {
  SpaceTrial<T> trial{principal_frame(F * G), G, {}, {}, {}};
  for (int a = 0; a < 3; ++a) trial.e[a] = log(trial.frame.stretch[a]);
  trial.log_J = trial.e[0] + trial.e[1] + trial.e[2];
  for (int a = 0; a < 3; ++a) trial.deviator[a] = trial.e[a] - (1.0 / 3.0) * trial.log_J;
  return trial;
}

/// P of Kirchhoff's stress tau_a = bulk ln J + 2 shear e'_a [Pa].
template <class T>
Mat<3, T> stress_of(const SpaceTrial<T>& trial, double bulk, const T& shear) {
  // P = (sum_a tau_a/s_a u_a (x) v_a) G^T
  Vec<3, T> first;
  for (int a = 0; a < 3; ++a)
    first[a] = (bulk * trial.log_J + 2.0 * shear * trial.deviator[a]) / trial.frame.stretch[a];
  return trial.frame.u * Mat<3, T>::diagonal(first) * transpose(trial.G * trial.frame.v);
}

/// dP/dF of the same, with dtau/de = bulk 1 (x) 1 + 2 (shear dev + turn n (x) n), n = e'/|e'| [Pa].
template <class T>
Mat<9, T> tangent_of(const SpaceTrial<T>& trial, double bulk, const T& shear, const T& turn) {
  const T inverse = 1.0 / max(trial.square(), T(1e-20));
  Mat<3, T> D;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      D(a, b) = bulk + 2.0 * (shear * ((a == b) - 1.0 / 3.0) +
                              turn * inverse * trial.deviator[a] * trial.deviator[b]);
  PrincipalResponse<T> response{.frame = trial.frame, .first = {}, .second = {}, .quotient = {}};
  differentiate(response, trial.e, shear, (bulk - 2.0 / 3.0 * shear) * trial.log_J, D);
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

/// G after a flow that leaves e' <- share e': G sum_a exp((share - 1) e'_a) v_a (x) v_a.
template <class T>
Mat<3, T> flowed(const SpaceTrial<T>& trial, const T& share) {
  Vec<3, T> shrink;
  for (int a = 0; a < 3; ++a) shrink[a] = exp((share - 1.0) * trial.deviator[a]);
  const Mat<3, T>& v = trial.frame.v;
  return trial.G * (v * Mat<3, T>::diagonal(shrink) * transpose(v));
}

}  // namespace softgrain
