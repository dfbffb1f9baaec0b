#pragma once
#include <array>

#include "softgrain/math/arsinh_ratio.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// A deviator that leaves the plane's normal its own axis: d + p_1, d - p_1 and p_2 in the plane, -2 d across
/// it.
template <class T>
struct PlaneDeviator {
  T d{};
  Vec<2, T> p;
};
template <class T>
PlaneDeviator<T> operator+(const PlaneDeviator<T>& a, const PlaneDeviator<T>& b) {
  return {a.d + b.d, a.p + b.p};
}
template <class T>
PlaneDeviator<T> operator*(const std::type_identity_t<T>& s, const PlaneDeviator<T>& a) {
  return {s * a.d, s * a.p};
}
/// a : b.
template <class T>
T contract(const PlaneDeviator<T>& a, const PlaneDeviator<T>& b) {
  return 6.0 * a.d * b.d + 2.0 * dot(a.p, b.p);
}

/// e' of ln sqrt(A), A = [[A_11, A_12], [A_12, A_22]] in the plane, and across it 1/det A.
template <class T>
PlaneDeviator<T> log_of_root(const T& A_11, const T& A_22, const T& A_12) {
  const T det = A_11 * A_22 - A_12 * A_12, inverse_root = 1.0 / sqrt(det);
  const Vec<2, T> D{{0.5 * (A_11 - A_22) * inverse_root, A_12 * inverse_root}};
  return {0.25 * log(det), (0.5 * arsinh_ratio(dot(D, D)).value) * D};
}

/// The elastic logarithmic strain e of a point in plane strain as a tensor in the axes of the flowed
/// material, e = ln sqrt(S C S), S = sqrt(C_p^-1), from F and G = C_p^-1 in the plane; across it C_p^-1 is
/// 1/det G. Where PlaneTrial knows how large e is, this knows its direction too (theory (46e)).
template <class T>
struct PlaneLogStrain {
  Mat<2, T> F;
  Mat<2, T> S;
  std::array<Mat<2, T>, 2> Q;  ///< I_k = F Q_k : F is 2 Jbar D_k
  std::array<Mat<2, T>, 2> FQ;
  T J, log_J, inverse_J;
  T scale;  ///< 1/(2 Jbar), Jbar = J sqrt(det G)
  Vec<2, T> D;
  ArsinhRatio<T> g;
  PlaneDeviator<T> e;  ///< e', p = g(D . D) D/2
};

template <class T>
PlaneLogStrain<T> plane_log_strain(const Mat<2, T>& F, const T& G_11, const T& G_22, const T& G_12) {
  PlaneLogStrain<T> of;
  of.F = F;
  const T det_G = G_11 * G_22 - G_12 * G_12, root = sqrt(det_G);
  const T inverse = 1.0 / sqrt(G_11 + G_22 + 2.0 * root);  // S = (G + root 1)/sqrt(tr G + 2 root)
  const T a = (G_11 + root) * inverse, b = (G_22 + root) * inverse, c = G_12 * inverse;
  of.S = {{a, c, c, b}};
  of.Q[0] = {{a * a - c * c, c * (a - b), c * (a - b), c * c - b * b}};
  of.Q[1] = {{2.0 * a * c, a * b + c * c, a * b + c * c, 2.0 * c * b}};
  of.J = determinant(F);
  of.inverse_J = 1.0 / of.J;
  of.log_J = log(of.J);
  of.scale = 0.5 * of.inverse_J / root;
  for (int k = 0; k < 2; ++k) {
    of.FQ[k] = F * of.Q[k];
    of.D[k] = of.scale * contract(of.FQ[k], F);
  }
  of.g = arsinh_ratio(dot(of.D, of.D));
  of.e = {(1.0 / 6.0) * of.log_J + 0.25 * log(det_G), (0.5 * of.g.value) * of.D};
  return of;
}

/// Derivatives of an energy w(e') [Pa]: by the components d and p.
template <class T>
struct PlaneLogEnergy {
  T by_d{};
  Vec<2, T> by_p;
  T by_dd{};
  Vec<2, T> by_dp;
  Mat<2, T> by_pp;
};

/// Derivatives of bulk/2 (ln J)^2 + w(e') by I_1, I_2 and J.
template <class T>
struct PlaneLogResponse {
  Vec<2, T> d_I, d_IJ;
  Mat<2, T> d_II;
  T d_J{}, d_JJ{};
};

template <class T>
PlaneLogResponse<T> respond(const PlaneLogStrain<T>& of, double bulk, const PlaneLogEnergy<T>& w) {
  const Vec<2, T>& D = of.D;
  const T& slope = of.g.first;
  const T along = dot(w.by_p, D);
  // M = dp/dD
  Mat<2, T> M;
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) M(a, b) = slope * D[a] * D[b] + (a == b ? 0.5 * of.g.value : T(0.0));
  const Vec<2, T> by_D = M * w.by_p, by_D_d = M * w.by_dp;
  Mat<2, T> by_DD = M * w.by_pp * M;
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      by_DD(a, b) += slope * (w.by_p[a] * D[b] + w.by_p[b] * D[a] + (a == b ? along : T(0.0))) +
                     2.0 * of.g.second * along * D[a] * D[b];
  // D = scale I falls with L = ln J as -D, and d rises as L/6
  const Vec<2, T> turned = by_DD * D;
  const T first = bulk * of.log_J + (1.0 / 6.0) * w.by_d - dot(by_D, D);
  const T second =
      bulk + (1.0 / 36.0) * w.by_dd - (1.0 / 3.0) * dot(by_D_d, D) + dot(turned, D) + dot(by_D, D);
  PlaneLogResponse<T> psi;
  psi.d_J = first * of.inverse_J;
  psi.d_JJ = (second - first) * (of.inverse_J * of.inverse_J);
  for (int a = 0; a < 2; ++a) {
    psi.d_I[a] = of.scale * by_D[a];
    psi.d_IJ[a] = of.scale * of.inverse_J * ((1.0 / 6.0) * by_D_d[a] - turned[a] - by_D[a]);
    for (int b = 0; b < 2; ++b) psi.d_II(a, b) = of.scale * of.scale * by_DD(a, b);
  }
  return psi;
}

/// P = sum_k 2 psi_Ik F Q_k + psi_J cof F.
template <class T>
Mat<2, T> stress_of(const PlaneLogStrain<T>& of, const PlaneLogResponse<T>& psi) {
  return (2.0 * psi.d_I[0]) * of.FQ[0] + (2.0 * psi.d_I[1]) * of.FQ[1] + psi.d_J * cofactor(of.F);
}

template <class T>
Mat<4, T> tangent_of(const PlaneLogStrain<T>& of, const PlaneLogResponse<T>& psi) {
  const Mat<2, T> cof = cofactor(of.F);
  Mat<4, T> A;
  Mat<2, T> by_J = psi.d_JJ * cof;  // dpsi_J/dF
  for (int k = 0; k < 2; ++k) {
    const Mat<2, T> by_I =
        (4.0 * psi.d_II(k, 0)) * of.FQ[0] + (4.0 * psi.d_II(k, 1)) * of.FQ[1] + (2.0 * psi.d_IJ[k]) * cof;
    add_outer(A, T(1.0), of.FQ[k], by_I);
    by_J += (2.0 * psi.d_IJ[k]) * of.FQ[k];
    for (int i = 0; i < 2; ++i)
      for (int J = 0; J < 2; ++J)
        for (int L = 0; L < 2; ++L) A(2 * i + J, 2 * i + L) += 2.0 * psi.d_I[k] * of.Q[k](J, L);
  }
  add_outer(A, T(1.0), cof, by_J);
  add_cofactor_derivative(A, psi.d_J, of.F);
  return A;
}

/// exp(s p), p the part in the plane without d.
template <class T>
Mat<2, T> exp_in_plane(const Vec<2, T>& p, double s) {
  const T size = max(sqrt(dot(p, p)), T(1e-150)), up = exp(s * size), down = 1.0 / up;
  const T cosh = 0.5 * (up + down), sinh = 0.5 * (up - down) / size;
  return {{cosh + sinh * p[0], sinh * p[1], sinh * p[1], cosh - sinh * p[0]}};
}

/// C_p^-1 in the plane (11, 22, 12) once e' has become `after` by flow, and the elastic rotation has stayed:
/// S exp(-e) exp(2 after) exp(-e) S.
template <class T>
Vec<3, T> flowed(const PlaneLogStrain<T>& of, const PlaneDeviator<T>& after) {
  const Mat<2, T> half = of.S * exp_in_plane(of.e.p, -1);
  const T squeezed = exp(2.0 * (after.d - of.e.d));
  const Mat<2, T> G = squeezed * (half * exp_in_plane(after.p, 2) * transpose(half));
  return {G(0, 0), G(1, 1), G(0, 1)};
}

}  // namespace softgrain
