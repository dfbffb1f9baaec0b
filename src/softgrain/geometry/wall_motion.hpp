#pragma once
#include <cmath>

#include "softgrain/geometry/box.hpp"

namespace softgrain {

/// Raises NumericalError if a wall or an end of a periodic cell goes further in dt [s] than a tenth of the
/// smallest radius [m], or not by a number, or if walls that face each other have met: no grain is left
/// between them.
void check_wall_motion(const Box<2>& box, double dt, double smallest_radius);

/// The velocity that a box gives to what lies in it: linear from each wall to the one that it faces, and that
/// of a periodic cell,
///   v_d(x) = v_d + r_d (x_d - o_d) + (L x)_d, d = 1, 2; zero where neither is.
struct AffineMotion {
  Vec<2> origin{}, velocity{}, rate{};  // o [m], v [m/s], r [1/s]
  Mat<2> gradient{};                    // L [1/s]

  AffineMotion() = default;
  explicit AffineMotion(const Box<2>& box);
  /// v(x) [m/s]; T is double or Wide.
  template <class T>
  Vec<2, T> at(const Vec<2, T>& x) const {
    return {velocity[0] + rate[0] * (x[0] - origin[0]) + gradient(0, 0) * x[0] + gradient(0, 1) * x[1],
            velocity[1] + rate[1] * (x[1] - origin[1]) + gradient(1, 0) * x[0] + gradient(1, 1) * x[1]};
  }
};

/// What damping by mass does in a step: f = -zeta m (v - v_walls(x)) with the velocities at its start, so
/// weakened that a free grain slows down by exp(-zeta dt) whatever dt,
///   dt f/m = -(1 - exp(-zeta dt)) (v - v_walls(x)).
struct MassDamping {
  double share = 0;  ///< 1 - exp(-zeta dt)
  AffineMotion walls{};

  MassDamping() = default;
  /// rate: zeta [1/s]; the box at the start of the step.
  MassDamping(double rate, double dt, const Box<2>& at_start)
      : share(-std::expm1(-rate * dt)), walls(rate > 0 ? AffineMotion(at_start) : AffineMotion()) {}
  /// dt f/m [m/s]
  template <class T>
  Vec<2, T> velocity_change(const Vec<2, T>& x, const Vec<2, T>& v) const {
    return T(-share) * (v - walls.at(x));
  }
};

}  // namespace softgrain
