#pragma once
#include <array>
#include <numbers>
#include <type_traits>
#include <utility>

#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// An eight-node cell of eight grains, in its own coordinates u, v, w from 0 to 1, from its edges: dx/du at
/// (v, w) is bilinear between the four edges along u, and so on. Point (i, j, k) lies at (u_i, v_j, w_k), and
/// its volume now is
///   V_p J_p = dx/du . (dx/dv x dx/dw)/8.
/// With laws P = mu F + h cof F the force is
///   f_a = sum_p V_p P_p dN_a/dX = mu sum_b L_ab x_b + sum_p h_p d(V_p J_p)/dx_a;
/// this is the second part, and LaplaceRows has the first one for the grain as a whole.
class BrickInLanes {
 public:
  [[gnu::always_inline]] BrickInLanes(const WidePlaces<3>& x, const std::array<int, 8>& nodes) {
    const auto edge = [&](int from, int to) {
      return x[static_cast<std::size_t>(nodes[static_cast<std::size_t>(to)])] -
             x[static_cast<std::size_t>(nodes[static_cast<std::size_t>(from)])];
    };
    along_u_ = {edge(0, 1), edge(3, 2), edge(4, 5), edge(7, 6)};
    along_v_ = {edge(0, 3), edge(1, 2), edge(4, 7), edge(5, 6)};
    along_w_ = {edge(0, 4), edge(1, 5), edge(3, 7), edge(2, 6)};
    interpolate(along_u_), interpolate(along_v_), interpolate(along_w_);
  }

  /// 8 V_p J_p of the eight points [m^3].
  [[gnu::always_inline]] std::array<Wide, 8> determinants() const {
    std::array<Wide, 8> det;
    for_each_point([&](auto p) {
      const Vector normal = cross(v(p), w(p)), &a = u(p);
      det[p] = a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2];
    });
    return det;
  }

  /// Adds sum_p h_p d(V_p J_p)/dx_a, from h of the eight points.
  [[gnu::always_inline]] void add_force(const std::array<Wide, 8>& h, const std::array<int, 8>& nodes,
                                        WidePlaces<3>& force) const {
    std::array<Vector, 4> t_u{}, t_v{}, t_w{};  // on the interpolated edges
    for_each_point([&](auto p) {
      const Wide eighth = 0.125 * h[p];
      const Vector &a = u(p), b = eighth * v(p), c = eighth * w(p);
      add_to(t_u[p / 2], cross(v(p), c));
      add_to(t_v[of_v(p)], cross(c, a));
      add_to(t_w[p % 4], cross(a, b));
    });
    interpolate(t_u), interpolate(t_v), interpolate(t_w);  // its own transpose
    const auto add = [&](std::size_t a, const Vector& f) { force[static_cast<std::size_t>(nodes[a])] += f; };
    add(0, -(t_u[0] + t_v[0] + t_w[0]));
    add(1, t_u[0] - t_v[1] - t_w[1]);
    add(2, t_u[1] + t_v[1] - t_w[3]);
    add(3, t_v[0] - t_u[1] - t_w[2]);
    add(4, t_w[0] - t_u[2] - t_v[2]);
    add(5, t_u[2] + t_w[1] - t_v[3]);
    add(6, t_u[3] + t_v[3] + t_w[3]);
    add(7, t_v[2] + t_w[2] - t_u[3]);
  }

 private:
  using Vector = Vec<3, Wide>;
  static constexpr double u_0 = (1 - std::numbers::inv_sqrt3) / 2;

  static std::size_t of_v(std::size_t p) { return p % 2 + 2 * (p / 4); }
  const Vector& u(std::size_t p) const { return along_u_[p / 2]; }    // at (v_j, w_k)
  const Vector& v(std::size_t p) const { return along_v_[of_v(p)]; }  // at (u_i, w_k)
  const Vector& w(std::size_t p) const { return along_w_[p % 4]; }    // at (u_i, v_j)

  /// work(p) for the eight points, unrolled: p is a constant.
  template <class Work>
  [[gnu::always_inline]] static void for_each_point(const Work& work) {
    [&]<std::size_t... P>(std::index_sequence<P...>) {
      (work(std::integral_constant<std::size_t, P>{}), ...);
    }
    (std::make_index_sequence<8>{});
  }
  [[gnu::always_inline]] static void add_to(Vector& sum, const Vector& more) {
    sum[0] += more[0], sum[1] += more[1], sum[2] += more[2];
  }
  [[gnu::always_inline]] static Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  /// From the ends of an interval to its two Gauss positions.
  [[gnu::always_inline]] static void interpolate(Vector& first, Vector& last) {
    const Vector change = Wide(u_0) * (last - first);
    first += change;
    last -= change;
  }
  [[gnu::always_inline]] static void interpolate(std::array<Vector, 4>& edge) {
    interpolate(edge[0], edge[1]), interpolate(edge[2], edge[3]);
    interpolate(edge[0], edge[2]), interpolate(edge[1], edge[3]);
  }

  std::array<Vector, 4> along_u_, along_v_, along_w_;
};

}  // namespace softgrain
