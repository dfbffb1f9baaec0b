#pragma once
#include <algorithm>
#include <cmath>

#include "softgrain/math/narrow.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

// The law of one contact, Signorini's and Coulomb's, as the turn of a contact in a sweep needs it:
//   0 <= u_n _|_ p_n >= 0,  |p_t| <= mu p_n,  and u_t = -s p_t with s > 0 only where |p_t| = mu p_n.
// Every sweep takes it from here (docs/decisions/0033). T is double for one contact; or Lanes, Wide or
// Narrow::Floats for four or eight contacts that share no body. Each lane has the bits of a contact alone.

/// p_n' = max(0, p_n - omega u_n / W_nn), with gain = omega / W_nn. NaN stays NaN.
template <class T>
[[gnu::always_inline]] inline T normal_impulse(const T& p_n, const T& u_n, const T& gain) {
  return max(T{}, p_n - gain * u_n);
}

/// The nearest to p_t with |p_t| <= limit.
template <class T>
[[gnu::always_inline]] inline Vec<1, T> cut_to_length(const Vec<1, T>& p_t, const T& limit) {
  return {max(min(p_t[0], limit), -limit)};
}
template <class T>
[[gnu::always_inline]] inline Vec<2, T> cut_to_length(const Vec<2, T>& p_t, const T& limit) {
  const T length = sqrt(dot(p_t, p_t));
  return select(length > limit, limit / length, T{} + 1) * p_t;
}

/// The impulse p' of a contact whose directions do not couple, W = diag(W_nn, W_tt, ...), as of disks,
/// spheres and lumped masses, when u is its velocity under p:
///   p_n' = max(0, p_n - omega u_n / W_nn),  p_t' = p_t - omega u_t / W_tt, cut to |p_t'| <= mu p_n'.
/// gain_n = omega / W_nn and gain_t = omega / W_tt; with omega = 1 this is the solution.
template <int Dim, class T>
[[gnu::always_inline]] inline Vec<Dim, T> solve_uncoupled(const Vec<Dim, T>& p, const Vec<Dim, T>& u,
                                                          const T& gain_n, const T& gain_t, const T& mu) {
  Vec<Dim, T> solved{normal_impulse(p[0], u[0], gain_n)};
  Vec<Dim - 1, T> p_t;
  for (int k = 1; k < Dim; ++k) p_t[k - 1] = p[k] - gain_t * u[k];
  p_t = cut_to_length(p_t, mu * solved[0]);
  for (int k = 1; k < Dim; ++k) solved[k] = p_t[k - 1];
  return solved;
}

/// Projection of p on the Coulomb cone |p_t| <= mu p_n.
template <int Dim>
[[gnu::always_inline]] inline Vec<Dim> project_on_coulomb_cone(Vec<Dim> p, double mu) {
  const double tangential = Dim == 2 ? std::abs(p[1]) : std::sqrt(p[1] * p[1] + p[Dim - 1] * p[Dim - 1]);
  if (p[0] >= 0 && tangential <= mu * p[0]) return p;
  const double normal = std::max(0.0, (p[0] + mu * tangential) / (1 + mu * mu));
  p[0] = normal;
  for (int k = 1; k < Dim; ++k) p[k] *= tangential > 0 ? mu * normal / tangential : 0;
  return p;
}

/// P(p + omega (p' - p)), p' the solution of one contact; P, the projection on the Coulomb cone, acts only
/// for omega > 1.
template <int Dim>
[[gnu::always_inline]] inline Vec<Dim> relaxed_impulse(const Vec<Dim>& p, const Vec<Dim>& solved, double mu,
                                                       double omega) {
  const Vec<Dim> next = p + omega * (solved - p);
  return omega > 1 ? project_on_coulomb_cone(next, mu) : next;
}

/// How far contacts are from their law. The violation of a contact is the jump of its velocity when its own
/// impulse alone puts it right, v_c = |W_cc (p_c' - p_c)| [m/s]: zero exactly where the law holds, whatever
/// the conditioning of W_cc. Without friction v_c = |min(W_nn p_n, u_n)|.
struct Violation {
  double sum_of_squares = 0;  ///< of v_c [m^2/s^2]; NaN once a contact is
  double max_square = 0;      ///< of v_c [m^2/s^2]
  int contacts = 0;           ///< those that carry impulse or are violated

  /// Counts a contact by the jump of its velocity [m/s] and its normal impulse once put right.
  template <int Dim>
  void add(const Vec<Dim>& jump, double p_n) {
    const double square = dot(jump, jump);
    if (p_n <= 0 && square == 0) return;
    sum_of_squares += square;
    max_square = std::max(max_square, square);
    ++contacts;
  }
  Violation& operator+=(const Violation& more) {
    sum_of_squares += more.sum_of_squares;
    max_square = std::max(max_square, more.max_square);
    contacts += more.contacts;
    return *this;
  }
};

/// The violation of many contacts, lane by lane and without branches.
template <class T>
struct LaneViolation {
  T sum{}, max{}, contacts{};

  /// Counts a contact by W dp [m/s], where dp is its change of impulse in this turn, and by its p_n.
  template <int Dim>
  [[gnu::always_inline]] void add(const Vec<Dim, T>& jump, const T& p_n) {
    const T square = dot(jump, jump);
    sum += square;
    max = select(square <= max, max, square);  // keeps NaN
    contacts += select((p_n > T{}) | (square > T{}), T{} + 1, T{});
  }
  /// v_c = W dp / omega: what the contact would jump without relaxation.
  Violation total(double omega) const {
    const double scale = 1 / (omega * omega);
    Violation violation;
    double count = 0;
    for (int lane = 0; lane < lanes_of<T>; ++lane) {
      violation.sum_of_squares += scale * lane_of(sum, lane);
      const double square = scale * lane_of(max, lane);
      violation.max_square = square <= violation.max_square ? violation.max_square : square;
      count += lane_of(contacts, lane);
    }
    violation.contacts = static_cast<int>(count);
    return violation;
  }
};

}  // namespace softgrain
