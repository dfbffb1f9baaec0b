#pragma once
#include <cmath>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/plate_path.hpp"

namespace softgrain {

/// Uniaxial compaction: the lid of a box comes down at constant speed to the strain eps = ln(h_start/h).
class CompactionPath final : public PlatePath {
 public:
  /// height: of the box at the start [m].
  CompactionPath(const Case::Loading& loading, double height, double dt)
      : velocity_(loading.wall_velocity),
        steps_(std::llround(height * (1 - std::exp(-loading.max_strain)) / (velocity_ * dt))) {}

  std::int64_t steps() const override { return steps_; }
  double plate_velocity(std::int64_t) const override { return -velocity_; }
  int leg(std::int64_t) const override { return 0; }
  double strain(double height_start, double height) const override { return std::log(height_start / height); }

 private:
  double velocity_;
  std::int64_t steps_;
};

}  // namespace softgrain
