#pragma once
#include <span>
#include <vector>

namespace softgrain {

/// Anderson's method for a = f(a) (Anderson 1965):
///   a <- a + r - sum_j (q_j . r)(q_j + s_j),  r = f(a) - a,
/// where q_j are orthonormal combinations of how r changed over the last iterations, and s_j those of how a
/// did. It begins anew where r has grown.
class FixedPoint {
 public:
  /// From a and r to the next a.
  void improve(std::span<double> a, std::span<const double> r);

 private:
  std::vector<double> a_, r_;  // of the iteration before
  std::vector<std::vector<double>> q_, s_;
};

}  // namespace softgrain
