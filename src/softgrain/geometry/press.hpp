#pragma once
#include <algorithm>
#include <array>

namespace softgrain {

/// Walls that keep a stress: one body that contact with the grains moves, solved together with all contacts.
/// Wall w of those that belong to it moves at share_w v along its normal, and v obeys
///   m dv/dt = F - sum_w share_w f_w - Z (v - v_back),   |v| <= v_most,
/// f_w the force of the grains on wall w, outwards [N/m], v_back <= 0 the speed at which they push it back
/// evenly: at rest, and where it gives way to grains that other walls move, sum_w share_w f_w = F. Over a
/// step, with backward Euler and p_w the impulse on wall w [N s/m],
///   v+ = (m v + dt (F + Z v_back) - sum_w share_w p_w)/(m + dt Z), cut to |v+| <= v_most.
/// Lengths, forces and masses in 2D, per metre of depth.
struct Press {
  std::array<double, 6> share{};  ///< by BoxWall; 0: the wall does not belong to it
  double force = 0;               ///< F [N/m]
  double mass = 0;                ///< m [kg/m]
  double damper = 0;              ///< Z [N s/m^2]
  double most = 0;                ///< v_most [m/s]
  double speed = 0;               ///< v [m/s], > 0: the walls come together
  double mean_force = 0;          ///< sum_w share_w f_w, its mean over tau [N/m]
  double mean_speed = 0;          ///< of v over 10 tau; 0 while the press brakes [m/s]; v_back if < 0
  double waiting = 0;             ///< t: how long that has been on one side of F [s], see end_step

  /// tau = 2 m/Z [s]
  double time() const { return 2 * mass / damper; }
  /// d v+/d(-impulse) [m/kg]
  double mobility(double dt) const;
  /// v+ without impulses, not cut [m/s]; v is that of the start of the step.
  double free_speed(double dt) const {
    return (mass * speed + dt * (force + faded_damper() * std::min(mean_speed, 0.0))) * mobility(dt);
  }
  /// t grows while the mean force stays on one side of F. It is halved in a step that takes it to the other
  /// side, or from below so near that it would be there within 5 tau at the rate of the step: the press
  /// brakes. A step of dt [s] is over, with v+ [m/s] and sum_w share_w p_w [N s/m].
  void end_step(double v, double impulse, double dt);

 private:
  double faded_damper() const { return damper / (1 + waiting / time()); }
};

}  // namespace softgrain
