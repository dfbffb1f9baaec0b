#pragma once
#include <cmath>
#include <limits>

namespace softgrain {

/// x <- x + b (x - x'), x' the number or vector when this was last done; it becomes the x of now.
template <class T>
void extrapolate(T& now, T& before, double b) {
  const T last = now;
  if (b > 0) now += b * (last - before);
  before = last;
}

/// How far the sweeps of Nesterov's method go ahead:
///   b = (t_k - 1)/t_k+1,  t_k+1 = (1 + sqrt(1 + 4 t_k^2))/2,  t_1 = 1 at the start and once the violation
///   has grown.
class Momentum {
 public:
  /// b of the next sweep.
  double next() {
    const double t = 0.5 * (1 + std::sqrt(1 + 4 * t_ * t_)), b = (t_ - 1) / t;
    t_ = t;
    return b;
  }
  /// The sum of squares of the violation that a sweep found [m^2/s^2].
  void see(double sum_of_squares) {
    if (sum_of_squares > last_) t_ = 1;
    last_ = sum_of_squares;
  }

 private:
  double t_ = 1, last_ = std::numeric_limits<double>::infinity();
};

}  // namespace softgrain
