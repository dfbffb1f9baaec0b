#pragma once
#include <cmath>

#include "softgrain/geometry/box.hpp"

namespace softgrain {

/// Raises NumericalError if a wall or an end of a periodic cell goes further in dt [s] than a tenth of the
/// smallest radius [m], or not by a number, or if walls that face each other have met: no grain is left
/// between them.
template <int Dim>
void check_wall_motion(const Box<Dim>& box, double dt, double smallest_radius);

/// The velocity that a box gives to what lies in it: linear from each wall to the one that it faces, and that
/// of a periodic cell,
///   v_d(x) = v_d + r_d (x_d - o_d) + (L x)_d, d = 1, ..., Dim; zero where neither is.
template <int Dim>
struct AffineMotion {
  Vec<Dim> origin{}, velocity{}, rate{};  // o [m], v [m/s], r [1/s]
  Mat<Dim> gradient{};                    // L [1/s]

  AffineMotion() = default;
  explicit AffineMotion(const Box<Dim>& box);
  /// v(x) [m/s]; T is double or Wide.
  template <class T>
  Vec<Dim, T> at(const Vec<Dim, T>& x) const {
    Vec<Dim, T> v;
    for (int d = 0; d < Dim; ++d) {
      v[d] = velocity[d] + rate[d] * (x[d] - origin[d]);
      for (int k = 0; k < Dim; ++k) v[d] = v[d] + gradient(d, k) * x[k];
    }
    return v;
  }
};

/// What damping by mass does in a step: f = -zeta m (v - v_walls(x)) with the velocities at its start, so
/// weakened that a free grain slows down by exp(-zeta dt) whatever dt,
///   dt f/m = -(1 - exp(-zeta dt)) (v - v_walls(x)).
template <int Dim>
struct MassDamping {
  double share = 0;  ///< 1 - exp(-zeta dt)
  AffineMotion<Dim> walls{};

  MassDamping() = default;
  /// rate: zeta [1/s]; the box at the start of the step.
  MassDamping(double rate, double dt, const Box<Dim>& at_start)
      : share(-std::expm1(-rate * dt)), walls(rate > 0 ? AffineMotion<Dim>(at_start) : AffineMotion<Dim>()) {}
  /// dt f/m [m/s]
  template <class T>
  Vec<Dim, T> velocity_change(const Vec<Dim, T>& x, const Vec<Dim, T>& v) const {
    return T(-share) * (v - walls.at(x));
  }
};

}  // namespace softgrain
