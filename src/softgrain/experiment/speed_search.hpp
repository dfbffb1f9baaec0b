#pragma once

namespace softgrain {

/// Seeks within [-v_max, v_max] the speed at which an excess that rises with it vanishes: by steps that grow
/// until it lies between two speeds, then by regula falsi (Illinois).
class SpeedSearch {
 public:
  /// slope: of the excess over the speed, as far as it is known; 0: it is not.
  SpeedSearch(double v_max, double accuracy, double slope)
      : v_max_(v_max), accuracy_(accuracy), slope_(slope) {}

  /// Takes the excess at a speed. True if that is the speed: the excess is small enough, or it is still
  /// negative at v_max or positive at -v_max, or the best of many tries.
  bool found(double v, double excess);
  /// The speed to try next.
  double next() const;
  double slope() const { return slope_; }

 private:
  struct Point {
    double v = 0, excess = 0;
    bool known = false;
  };
  double v_max_, accuracy_, slope_;
  Point low_, high_, best_;             // with excess < 0, > 0, least |excess|
  double rise_ = 0, excess_above_ = 0;  // slope between the last two with excess > 0, and the last excess
  int tries_ = 0, last_side_ = 0;
};

}  // namespace softgrain
