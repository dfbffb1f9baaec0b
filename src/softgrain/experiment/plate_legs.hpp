#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// How the top plate goes to the last strain: down at constant speed, back at given strains by a given
/// strain, and down again; it rests where it turns and at the end. Every leg is a whole number of steps, so
/// the path is exact after a restart.
class PlateLegs {
 public:
  /// travel: of the plate [m] at a strain; `last_strain`: the end. Raises UsageError.
  PlateLegs(const Case::Loading& loading, double dt, double last_strain,
            const std::function<double(double)>& travel);

  std::int64_t steps() const { return legs_.back().end; }
  /// Number of the leg of a step: loading, (rest,) unloading, (rest,) reloading, ...
  int leg(std::int64_t step) const;
  double velocity(std::int64_t step) const { return legs_[leg(step)].velocity; }

 private:
  struct Leg {
    std::int64_t end;  // first step after it
    double velocity;   // [m/s]
  };
  std::vector<Leg> legs_;
};

}  // namespace softgrain
