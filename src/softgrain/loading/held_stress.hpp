#pragma once
#include <cmath>
#include <cstdint>
#include <string>

namespace softgrain {

/// How well a stress is kept over the second half of a stage: its means over 200 equal times, and what
/// becomes of them, all over the stress that is asked for.
struct HeldStress {
  double mean() const { return windows > 0 ? sum / windows : 0; }
  double deviation() const;  ///< standard
  /// Within 1 % in the mean, 3 % of standard deviation and 10 % at most.
  bool kept() const { return std::abs(mean() - 1) <= 0.01 && deviation() <= 0.03 && largest <= 1.1; }
  /// "1.002 of it in the mean, 0.013 of standard deviation, 1.05 at most".
  std::string text() const;

  /// Takes the stress over the one asked for of step k of the stage, of `steps` steps.
  void add(double stress, std::int64_t step, std::int64_t steps);

  double windows = 0, sum = 0, squares = 0, largest = 0;
  double window = 0;  ///< of the present one so far
};

}  // namespace softgrain
