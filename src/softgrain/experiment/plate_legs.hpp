#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// How the plates come together to the last strain: at constant speed, back at given strains by a given
/// strain, and together again; they rest where they turn and at the end. A leg is a whole number of steps;
/// the last makes what is left of the way, counted from the travel really made: no error of a leg, be it a
/// rounding or a leg shorter than a step, reaches the next.
class PlateLegs {
 public:
  /// travel: of the plates towards each other [m] at a strain; `last_strain`: the end. Raises UsageError.
  PlateLegs(const Case::Loading& loading, double dt, double last_strain,
            const std::function<double(double)>& travel);

  std::int64_t steps() const { return legs_.back().end; }
  /// Number of the leg of a step: loading, (rest,) unloading, (rest,) reloading, ...
  int leg(std::int64_t step) const;
  bool approaches(std::int64_t step) const { return legs_[leg(step)].direction > 0; }
  /// Rate of the plates' distance [m/s] in a step at whose start they have come `travel` [m] together.
  double velocity(std::int64_t step, double travel) const;

 private:
  struct Leg {
    std::int64_t end;  // first step after it
    double travel;     // at its end [m]
    int direction;     // 1: together, 0: at rest, -1: apart
  };
  std::vector<Leg> legs_;
  double speed_, dt_;  // [m/s], [s]
};

}  // namespace softgrain
