#pragma once
#include <array>
#include <concepts>
#include <numbers>

#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// Laws with P = mu F + h cof F, which give h of the four points of a cell from their J and the mean J.
template <class Law>
concept HasCofactorFactors = requires(const Law& law, const std::array<Wide, 4>& J, const Wide& mean_J) {
  { law.mu } -> std::convertible_to<double>;
  { law.cofactor_factors(J, mean_J) } -> std::same_as<std::array<Wide, 4>>;
};

/// A cell of eight grains, in its own coordinates u, v from 0 to 1 (node 0 at (0, 0), 1 at (1, 0), 2 at
/// (1, 1), 3 at (0, 1)):
///   dx/du = (1 - v) e_01 + v e_32,  dx/dv = (1 - u) e_03 + u e_12,  e_ab = x_b - x_a.
/// Point p lies at (u_(p mod 2), v_(p div 2)) and has the volume V_p J_p = (dx/du x dx/dv)/4 now. With laws
/// P = mu F + h cof F the force is
///   f_a = sum_p V_p P_p dN_a/dX = mu sum_b L_ab x_b + sum_p h_p d(V_p J_p)/dx_a,
/// half of the operations that F, P and V P dN_a/dX take.
class CellInLanes {
 public:
  [[gnu::always_inline]] CellInLanes(const WideVectors& x, const std::array<int, 4>& nodes)
      : e_01_(x[nodes[1]] - x[nodes[0]]), e_03_(x[nodes[3]] - x[nodes[0]]), e_02_(x[nodes[2]] - x[nodes[0]]) {
    const Vector e_32 = x[nodes[2]] - x[nodes[3]], e_12 = x[nodes[2]] - x[nodes[1]];
    const Vector twist = Wide(u_0) * (e_32 - e_01_);  // = u_0 (e_12 - e_03)
    along_u_ = {e_01_ + twist, e_32 - twist};
    along_v_ = {e_03_ + twist, e_12 - twist};
  }

  /// J of the four points.
  [[gnu::always_inline]] std::array<Wide, 4> J(const CellShape& shape,
                                               const Wide& inverse_square_radius) const {
    std::array<Wide, 4> J;
    for (int p = 0; p < 4; ++p)
      J[p] = cross(along_u_[p / 2], along_v_[p % 2]) * (shape.inverse_area[p] * inverse_square_radius);
    return J;
  }

  /// Mean J, weighted by volume: the area now, (e_02 x e_13)/2, over that at rest.
  [[gnu::always_inline]] Wide mean_J(const CellShape& shape, const Wide& inverse_square_radius) const {
    return cross(e_02_, e_03_ - e_01_) * (Wide(0.5 * shape.inverse_volume) * inverse_square_radius);
  }

  /// Adds f_a, from h of the four points.
  [[gnu::always_inline]] void add_force(const CellShape& L, double mu, const std::array<Wide, 4>& h,
                                        const std::array<int, 4>& nodes, WideVectors& force) const {
    // sum_p h_p d(V_p J_p) = du_0 x t_01 + du_1 x t_32 - dv_0 x t_03 - dv_1 x t_12, du_q = d(dx/du at v_q)
    Vector t_01 = quarter(h[0]) * along_v_[0] + quarter(h[1]) * along_v_[1];
    Vector t_32 = quarter(h[2]) * along_v_[0] + quarter(h[3]) * along_v_[1];
    Vector t_03 = quarter(h[0]) * along_u_[0] + quarter(h[2]) * along_u_[1];
    Vector t_12 = quarter(h[1]) * along_u_[0] + quarter(h[3]) * along_u_[1];
    // = de_01 x t_01 + de_32 x t_32 - de_03 x t_03 - de_12 x t_12
    const Vector across_v = Wide(u_0) * (t_32 - t_01), across_u = Wide(u_0) * (t_12 - t_03);
    t_01 += across_v, t_32 -= across_v, t_03 += across_u, t_12 -= across_u;

    const Vector f_1 = Wide(mu) * linear(L.L_11, L.L_12, L.L_13) + turned(t_01 + t_12);
    const Vector f_2 = Wide(mu) * linear(L.L_12, L.L_22, L.L_23) + turned(t_32 - t_12);
    const Vector f_3 = Wide(mu) * linear(L.L_13, L.L_23, L.L_33) - turned(t_32 + t_03);
    force[nodes[1]] += f_1;
    force[nodes[2]] += f_2;
    force[nodes[3]] += f_3;
    force[nodes[0]] -= f_1 + f_2 + f_3;
  }

 private:
  using Vector = Vec<2, Wide>;
  static constexpr double u_0 = (1 - std::numbers::inv_sqrt3) / 2;  // = v_0 = 1 - u_1 = 1 - v_1

  /// sum_b L_ab x_b, the row of node a without its L_a0
  [[gnu::always_inline]] Vector linear(double L_a1, double L_a2, double L_a3) const {
    return Wide(L_a1) * e_01_ + Wide(L_a2) * e_02_ + Wide(L_a3) * e_03_;
  }
  static Wide quarter(const Wide& h) { return 0.25 * h; }
  static Wide cross(const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; }
  /// The vector f with dx x t = f . dx.
  static Vector turned(const Vector& t) { return {t[1], -t[0]}; }

  Vector e_01_, e_03_, e_02_;
  std::array<Vector, 2> along_u_, along_v_;
};

}  // namespace softgrain
