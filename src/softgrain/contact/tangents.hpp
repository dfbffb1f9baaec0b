#pragma once
#include <array>
#include <cmath>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Unit tangents of a contact with normal n: t = e_z x n in the plane; two in space.
inline std::array<Vec<2>, 1> tangents(const Vec<2>& n) { return {perpendicular(n)}; }
inline std::array<Vec<3>, 2> tangents(const Vec<3>& n) {
  // Duff et al. 2017: continuous but at n_z = 0
  const double sign = std::copysign(1.0, n[2]);
  const double a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
  return {Vec<3>{1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]},
          Vec<3>{b, sign + n[1] * n[1] * a, -n[1]}};
}

/// p_n n + p_t t, of the components (p_n, p_t) along a normal and its tangents.
template <int Dim>
[[gnu::always_inline]] inline Vec<Dim> from_local(const Vec<Dim>& n, const Vec<Dim>& p) {
  Vec<Dim> world = p[0] * n;
  if constexpr (Dim == 3)
    if (p[1] == 0 && p[2] == 0) return world;
  const auto t = tangents(n);
  for (int k = 1; k < Dim; ++k) world += p[k] * t[static_cast<std::size_t>(k - 1)];
  return world;
}

/// The components of a vector along a normal and its tangents.
template <int Dim>
[[gnu::always_inline]] inline Vec<Dim> to_local(const Vec<Dim>& n, const Vec<Dim>& world) {
  Vec<Dim> p{dot(n, world)};
  const auto t = tangents(n);
  for (int k = 1; k < Dim; ++k) p[k] = dot(t[static_cast<std::size_t>(k - 1)], world);
  return p;
}

}  // namespace softgrain
