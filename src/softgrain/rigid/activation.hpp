#pragma once

namespace softgrain {

/// When a contact is active, which decides where restitution acts (trajectories depend on it).
enum class Activation {
  anticipated,            ///< always: u_n + max(g, 0)/dt >= 0 lets a gap close but not cross; needs e = 0
  closed_at_mid_step,     ///< only if g <= 0 at mid-step, g = g^- + dt/2 u_n^-: u_n + e u_n^- >= 0 (Moreau)
  closed_at_end_of_step,  ///< only if g + dt/2 u_n^- <= 0: closed at the end, if it goes on as it started
};

}  // namespace softgrain
