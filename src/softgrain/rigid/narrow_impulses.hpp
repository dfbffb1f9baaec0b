#pragma once
#include "softgrain/rigid/narrow_sweeps.hpp"

// What an impulse does, for the sources of NarrowSweepsOf.

namespace softgrain {

/// Velocities of the bodies a and b of eight contacts, and the impulses that change them.
template <int Dim>
struct NarrowSweepsOf<Dim>::Bodies {
  [[gnu::always_inline]] Bodies(Velocity* velocity, const Eight& contact)
      : rows(velocity), of(contact), a(gather_columns(rows, of.a)), b(gather_columns(rows, of.b)) {}

  /// v_a -= P/m_a, v_b += P/m_b.
  [[gnu::always_inline]] void apply(const Vector& P) {
    for (int k = 0; k < Dim; ++k) a[k] -= of.inverse_a * P[k];
    for (int k = 0; k < Dim; ++k) b[k] += of.inverse_b * P[k];
    scatter_columns(a, rows, of.a);
    scatter_columns(b, rows, of.b);
  }

  Velocity* rows;
  const Eight& of;
  Vector a, b;
};

template <int Dim>
[[gnu::always_inline]] inline auto NarrowSweepsOf<Dim>::impulse_of(const Eight& c, const Floats& dp_n)
    -> Vector {
  Vector P;
  for (int k = 0; k < Dim; ++k) P[k] = dp_n * c.n[k];
  return P;
}
template <int Dim>
[[gnu::always_inline]] inline auto NarrowSweepsOf<Dim>::impulse_of(const FrictionalEight& c,
                                                                   const Floats& dp_n, const Tangential& dp_t)
    -> Vector {
  if constexpr (Dim == 2) {
    return {dp_n * c.n[0] - dp_t[0] * c.n[1], dp_n * c.n[1] + dp_t[0] * c.n[0]};
  } else {
    Vector P;
    for (int k = 0; k < Dim; ++k) P[k] = dp_n * c.n[k] + dp_t[0] * c.t[0][k] + dp_t[1] * c.t[1][k];
    return P;
  }
}

/// t . (du - s x n), with n x t_1 = t_2 in space.
template <int Dim>
[[gnu::always_inline]] inline auto NarrowSweepsOf<Dim>::slip_of(const FrictionalEight& c, const Vector& du,
                                                                const Turning& s) -> Tangential {
  if constexpr (Dim == 2)
    return {c.n[0] * du[1] - c.n[1] * du[0] - s[0]};
  else
    return {dot(c.t[0], du) - dot(c.t[1], s), dot(c.t[1], du) + dot(c.t[0], s)};
}

template <int Dim>
[[gnu::always_inline]] inline void NarrowSweepsOf<Dim>::turn(const FrictionalEight& c, const Turning& s_a,
                                                             const Turning& s_b, const Tangential& p_t) {
  Turning turned, a, b;
  if constexpr (Dim == 2)
    turned = p_t;
  else
    for (int k = 0; k < 3; ++k) turned[k] = p_t[0] * c.t[1][k] - p_t[1] * c.t[0][k];
  for (int k = 0; k < spin_size<Dim>; ++k) {
    a[k] = s_a[k] - inertia_ratio_ * c.inverse_a * turned[k];
    b[k] = s_b[k] - inertia_ratio_ * c.inverse_b * turned[k];
  }
  scatter_columns(a, spin_.data(), c.a);
  scatter_columns(b, spin_.data(), c.b);
}

}  // namespace softgrain
