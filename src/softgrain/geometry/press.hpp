#pragma once
#include <algorithm>
#include <array>

namespace softgrain {

/// Walls that keep a stress: one body that contact with the grains moves, solved together with all contacts.
/// Wall w of those that belong to it moves at share_w v along its normal, and v obeys
///   m dv/dt = F - sum_w share_w f_w - Z v,   |v| <= v_most,
/// f_w the force of the grains on wall w, outwards [N/m]: at rest sum_w share_w f_w = F. Over a step, with
/// backward Euler and p_w the impulse on wall w [N s/m],
///   v+ = (m v + dt F - sum_w share_w p_w)/(m + dt Z), cut to |v+| <= v_most.
/// Lengths, forces and masses in 2D, per metre of depth.
struct Press {
  std::array<double, 4> share{};  ///< by BoxWall; 0: the wall does not belong to it
  double force = 0;               ///< F [N/m]
  double mass = 0;                ///< m [kg/m]
  double damper = 0;              ///< Z [N s/m^2]
  double most = 0;                ///< v_most [m/s]
  double speed = 0;               ///< v [m/s], > 0: the walls come together

  /// d v+/d(-impulse) [m/kg]
  double mobility(double dt) const { return 1 / (mass + dt * damper); }
  /// v+ under this impulse sum_w share_w p_w [N s/m]; v is that of the start of the step.
  double speed_under(double impulse, double dt) const {
    return std::clamp((mass * speed + dt * force - impulse) * mobility(dt), -most, most);
  }
};

}  // namespace softgrain
