#pragma once
#include <algorithm>
#include <cmath>
#include <utility>

#include "softgrain/contact/law.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

namespace detail {

/// One contact with u_n = 0, seen from its tangential impulse. Elimination of p_n leaves
///   u_t = T p_t + b,  T = W_tt - W_tn W_nt / W_nn,  b = q_t - W_tn q_n / W_nn,
/// and both stick (s = 0) and slip (s > 0) are u_t = -s p_t, that is p_t(s) = -(T + s)^-1 b.
template <int Dim>
struct ClosedContact {
  double W_nn, q_n;
  Vec<Dim - 1> W_nt, b;
  Mat<Dim - 1> T;

  ClosedContact(const Mat<Dim>& W, const Vec<Dim>& q) : W_nn(W(0, 0)), q_n(q[0]) {
    for (int i = 0; i < Dim - 1; ++i) {
      W_nt[i] = W(0, i + 1);
      b[i] = q[i + 1] - W(i + 1, 0) / W_nn * q_n;
      for (int j = 0; j < Dim - 1; ++j) T(i, j) = W(i + 1, j + 1) - W(i + 1, 0) / W_nn * W(0, j + 1);
    }
  }
  double normal_impulse(const Vec<Dim - 1>& p_t) const { return -(q_n + dot(W_nt, p_t)) / W_nn; }
  Vec<Dim> impulse(const Vec<Dim - 1>& p_t) const {
    Vec<Dim> p{normal_impulse(p_t)};
    for (int k = 1; k < Dim; ++k) p[k] = p_t[k - 1];
    return p;
  }
};

inline double smallest_eigenvalue(const Mat<1>& T) { return T(0, 0); }
inline double smallest_eigenvalue(const Mat<2>& T) {
  const double shear = (T(0, 1) + T(1, 0)) / 2;
  return (T(0, 0) + T(1, 1)) / 2 - std::hypot((T(0, 0) - T(1, 1)) / 2, shear);
}

/// (T + s)^-1 a
inline Vec<1> solve_shifted(const Mat<1>& T, double s, const Vec<1>& a) { return {a[0] / (T(0, 0) + s)}; }
inline Vec<2> solve_shifted(const Mat<2>& T, double s, const Vec<2>& a) {
  const double T_11 = T(0, 0) + s, T_22 = T(1, 1) + s;
  const double det = T_11 * T_22 - T(0, 1) * T(1, 0);
  return {(T_22 * a[0] - T(0, 1) * a[1]) / det, (T_11 * a[1] - T(1, 0) * a[0]) / det};
}

/// Slip in 2D: p_t = side mu p_n with side = -sign(b), in closed form.
inline Vec<2> slide(const ClosedContact<2>& contact, double mu) {
  for (const double side : {contact.b[0] > 0 ? -1.0 : 1.0, contact.b[0] > 0 ? 1.0 : -1.0}) {
    const double W_slip = contact.W_nn + side * mu * contact.W_nt[0];
    if (W_slip <= 0) continue;  // would push the bodies apart by pulling: only the other side is left
    const double p_n = -contact.q_n / W_slip;
    return {p_n, side * mu * p_n};
  }
  return {-contact.q_n / contact.W_nn, 0};  // not reached: the two W_slip sum to 2 W_nn > 0
}

/// Slip in 3D: the root s > 0 of mu p_n(s) / |p_t(s)| = 1, which is nearly linear in s. Newton inside a
/// bracket.
inline Vec<3> slide(const ClosedContact<3>& contact, double mu) {
  const double b = norm(contact.b), T_min = smallest_eigenvalue(contact.T);
  if (b == 0) return contact.impulse({});
  // |p_t| <= b / (T_min + s), so that |p_t| <= mu p_n at the upper end; T + s is positive definite between
  // the ends.
  const double p_t_safe = -contact.q_n / (contact.W_nn / mu + norm(contact.W_nt));
  double low = std::max(0.0, -T_min), high = std::max(low, b / p_t_safe - T_min);
  double s = low > 0 ? (low + high) / 2 : low;
  Vec<2> p_t;
  for (int iteration = 0; iteration < 100; ++iteration) {
    p_t = -solve_shifted(contact.T, s, contact.b);
    const double tangential = norm(p_t);
    const double ratio = mu * contact.normal_impulse(p_t) / tangential;
    (ratio < 1 ? low : high) = s;
    if (std::abs(ratio - 1) < 1e-14) break;
    const Vec<2> dp_t = -solve_shifted(contact.T, s, p_t);  // d p_t / ds
    const double dratio = -mu * dot(contact.W_nt, dp_t) / (contact.W_nn * tangential) -
                          ratio * dot(p_t, dp_t) / (tangential * tangential);
    const double newton = s + (1 - ratio) / dratio;
    const double next = newton > low && newton < high ? newton : (low + high) / 2;
    if (next == s) break;
    s = next;
  }
  return project_on_coulomb_cone(contact.impulse(p_t), mu);
}

}  // namespace detail

/// The impulse p [N s] of one contact with u = W p + q under Signorini's and Coulomb's laws,
///   0 <= u_n _|_ p_n >= 0,  |p_t| <= mu p_n,  and u_t = -s p_t with s > 0 only where |p_t| = mu p_n.
///
/// W [1/kg] is the contact's own Delassus block, q [m/s] its velocity under everything but p. A contact that
/// would open by itself (q_n >= 0) stays free. Exact to round-off for every W with W_nn > 0 whose sliding
/// root exists, which is every positive definite W; it stays bounded for indefinite ones. W_nn <= 0 cannot
/// carry an impulse: p = 0. Source: De Saxce & Feng (1998); the one-parameter form of slip follows Bonnefon &
/// Daviet (2011).
template <int Dim>
Vec<Dim> solve_signorini_coulomb(const Mat<Dim>& W, const Vec<Dim>& q, double mu) {
  if (q[0] >= 0 || W(0, 0) <= 0) return {};
  if (mu == 0) return {-q[0] / W(0, 0)};
  const detail::ClosedContact<Dim> contact(W, q);
  if (detail::smallest_eigenvalue(contact.T) > 0) {
    const auto p_t = -detail::solve_shifted(contact.T, 0, contact.b);
    if (norm(p_t) <= mu * contact.normal_impulse(p_t)) return contact.impulse(p_t);
  }
  return detail::slide(contact, mu);
}

}  // namespace softgrain
