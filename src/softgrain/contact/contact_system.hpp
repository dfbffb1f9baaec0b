#pragma once
#include <concepts>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// All that a contact algorithm may know of the bodies: the Delassus form u = W p + q  (theory (5)).
///
/// Component 0 of a local vector is normal (u_n > 0 opens, p_n >= 0 pushes), the others are tangential. q
/// holds the free velocity and every offset of the Signorini condition (gap over step, push-out,
/// restitution), so that the law is simply 0 <= u_n _|_ p_n >= 0 with |p_t| <= mu p_n. The system carries its
/// own p: it starts from the velocities under the impulses it was given (warm start) and is told of changes
/// dp.
template <class S, int Dim>
concept ContactSystem = requires(S& s, const S& cs, int contact, const Vec<Dim>& dp) {
  { cs.size() } -> std::convertible_to<int>;
  { cs.delassus_block(contact) } -> std::convertible_to<Mat<Dim>>;     // W_cc [1/kg]
  { cs.relative_velocity(contact) } -> std::convertible_to<Vec<Dim>>;  // u_c under all impulses so far [m/s]
  {s.apply_impulse(contact, dp)};                                      // u_b += W_bc dp for every b
};

}  // namespace softgrain
