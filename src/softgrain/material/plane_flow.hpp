#pragma once
#include "softgrain/math/log_ratio.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// Elastic logarithmic strains e of a point in plane strain, F = F_e F_p, from F and G = C_p^-1 in the plane;
/// across it C_p^-1 is 1/det G, as flow keeps the volume (theory (46a)). Without eigenvectors: the trace and
/// determinant of B = F G F^T in the plane say all.
template <class T>
struct PlaneTrial {
  Mat<2, T> F, FG;
  Vec<3, T> G;  ///< G_11, G_22, G_12
  T J, inverse_J, log_J;
  T root;         ///< sqrt(det G)
  T sinh_square;  ///< sinh^2 x
  T s;            ///< cosh x, x = e_1 - e_2 = I/(2 J root), I = FG : F
  T f, df, ddf;   ///< x^2/2, and its derivatives by s
  T d;            ///< e'_1 = d + x/2, e'_2 = d - x/2, e'_33 = -2 d

  /// |e'|^2
  T square() const { return f + 6.0 * d * d; }
};

template <class T>
[[gnu::always_inline]] inline PlaneTrial<T> plane_trial(const Mat<2, T>& F, const Vec<3, T>& G) {
  PlaneTrial<T> e;
  e.F = F;
  e.G = G;
  e.FG = F * Mat<2, T>{{G[0], G[2], G[2], G[1]}};
  e.J = determinant(F);
  e.inverse_J = 1.0 / e.J;
  e.log_J = log(e.J);
  const T det_G = G[0] * G[1] - G[2] * G[2];
  e.root = sqrt(det_G);
  e.d = (1.0 / 6.0) * e.log_J + 0.25 * log(det_G);
  // sinh^2 x = ((B_11 - B_22)^2 + 4 B_12^2)/(4 det B), without cancellation
  const T B_11 = e.FG(0, 0) * F(0, 0) + e.FG(0, 1) * F(0, 1);
  const T B_22 = e.FG(1, 0) * F(1, 0) + e.FG(1, 1) * F(1, 1);
  const T B_12 = e.FG(0, 0) * F(1, 0) + e.FG(0, 1) * F(1, 1);
  const T a = 0.5 * (B_11 - B_22);
  e.sinh_square = (a * a + B_12 * B_12) * (e.inverse_J * e.inverse_J) / det_G;
  e.s = sqrt(1.0 + e.sinh_square);
  // x as in Hencky's law: z = tanh^2(x/2), x = 2 sqrt(z) phi(z)
  const T y = e.sinh_square / (1.0 + e.s), z = y / (2.0 + y), rest = 1.0 - z;
  const LogRatio<T> phi = log_ratio(z);
  e.f = 2.0 * z * phi.value * phi.value;
  e.df = phi.value * rest;
  e.ddf = 0.5 * (phi.derivative * rest - phi.value) * rest * rest;
  return e;
}

/// Derivatives of psi = bulk/2 (ln J)^2 + W(u), u = |e'|^2, by I = FG : F and J, from W' and W'' [Pa].
template <class T>
struct PlaneFlowResponse {
  T d_I, d_J, d_II, d_IJ, d_JJ;
};

template <class T>
[[gnu::always_inline]] inline PlaneFlowResponse<T> respond(const PlaneTrial<T>& e, double bulk, const T& dW,
                                                           const T& ddW) {
  const T s_I = 0.5 * e.inverse_J / e.root, twice_d = 2.0 * e.d;  // u_L = 2 d by L = ln J, u_LL = 1/3
  const T by_s = dW * e.df, by_L = bulk * e.log_J + dW * twice_d;
  const T by_ss = ddW * e.df * e.df + dW * e.ddf, by_sL = ddW * e.df * twice_d;
  const T by_LL = bulk + ddW * twice_d * twice_d + (1.0 / 3.0) * dW;
  const T first = by_L - e.s * by_s;  // dpsi/dL at I, as s_L = -s
  return {
      .d_I = by_s * s_I,
      .d_J = first * e.inverse_J,
      .d_II = by_ss * s_I * s_I,
      .d_IJ = (by_sL - e.s * by_ss - by_s) * s_I * e.inverse_J,
      .d_JJ = (by_LL - 2.0 * e.s * by_sL + e.s * (by_s + e.s * by_ss) - first) * e.inverse_J * e.inverse_J};
}

/// P = 2 psi_I FG + psi_J cof F.
template <class T>
Mat<2, T> stress_of(const PlaneTrial<T>& e, const PlaneFlowResponse<T>& psi) {
  return (2.0 * psi.d_I) * e.FG + psi.d_J * cofactor(e.F);
}

/// dP/dF = 2 psi_I 1 (x) G + 4 psi_II FG (x) FG + 2 psi_IJ (FG (x) cof F + cof F (x) FG)
///         + psi_JJ cof F (x) cof F + psi_J d(cof F)/dF.
template <class T>
Mat<4, T> tangent_of(const PlaneTrial<T>& e, const PlaneFlowResponse<T>& psi) {
  const Mat<2, T> cof = cofactor(e.F);
  Mat<4, T> A;
  for (int i = 0; i < 4; i += 2) {
    A(i, i) = 2.0 * psi.d_I * e.G[0];
    A(i + 1, i + 1) = 2.0 * psi.d_I * e.G[1];
    A(i, i + 1) = A(i + 1, i) = 2.0 * psi.d_I * e.G[2];
  }
  add_outer(A, T(1.0), e.FG, (4.0 * psi.d_II) * e.FG + (2.0 * psi.d_IJ) * cof);
  add_outer(A, T(1.0), cof, (2.0 * psi.d_IJ) * e.FG + psi.d_JJ * cof);
  add_cofactor_derivative(A, psi.d_J, e.F);
  return A;
}

/// G after a flow that leaves e' <- share e': B = rho (cosh x_n 1 + sinh x_n N) with its own axes N.
template <class T>
Vec<3, T> flowed(const PlaneTrial<T>& e, const T& share) {
  const T x = share * sqrt(2.0 * e.f), up = exp(x), down = 1.0 / up;
  const T sinh_before = sqrt(max(e.sinh_square, T(1e-300)));
  const T ratio = 0.5 * (up - down) / sinh_before, squeezed = exp((2.0 * (share - 1.0)) * e.d);
  // G_n = F^-1 B_n F^-T = a G + b C^-1, C^-1 = (cof F)^T cof F/J^2
  const T a = squeezed * ratio;
  const T b = squeezed * (0.5 * (up + down) - e.s * ratio) * e.root * e.inverse_J;
  const Mat<2, T> cof = cofactor(e.F);
  return {a * e.G[0] + b * (cof(0, 0) * cof(0, 0) + cof(1, 0) * cof(1, 0)),
          a * e.G[1] + b * (cof(0, 1) * cof(0, 1) + cof(1, 1) * cof(1, 1)),
          a * e.G[2] + b * (cof(0, 0) * cof(0, 1) + cof(1, 0) * cof(1, 1))};
}

}  // namespace softgrain
