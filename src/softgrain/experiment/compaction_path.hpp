#pragma once
#include <algorithm>
#include <cmath>

#include "softgrain/experiment/plate_legs.hpp"
#include "softgrain/experiment/plate_path.hpp"

namespace softgrain {

/// Uniaxial compaction: the lid of a box comes down at constant speed, back and down again as the case says,
/// to the strain eps = ln(h_start/h), or to the packing fraction of undeformed grains Phi_0 = Phi_start
/// e^(d eps), where the box shrinks in d directions: 1, the lid's.
class CompactionPath : public PlatePath {
 public:
  /// height [m] and packing fraction of the box at the start.
  CompactionPath(const Case::Loading& loading, double height, double dt, double packing_fraction,
                 int directions = 1)
      : legs_(loading, dt, last_strain(loading, packing_fraction, directions),
              [=](double strain) { return -height * std::expm1(-strain); }) {}

  std::int64_t steps() const override { return legs_.steps(); }
  double plate_velocity(std::int64_t step, double travel) const override {
    return legs_.velocity(step, travel);
  }
  bool approaches(std::int64_t step) const override { return legs_.approaches(step); }
  int leg(std::int64_t step) const override { return legs_.leg(step); }
  double strain(double height_start, double height) const override { return std::log(height_start / height); }

  static double last_strain(const Case::Loading& loading, double packing_fraction, int directions = 1) {
    if (loading.max_packing_fraction == 0) return loading.max_strain;
    const double filled = std::log(loading.max_packing_fraction / packing_fraction) / directions;
    return std::min(loading.max_strain, filled);
  }

 private:
  PlateLegs legs_;
};

}  // namespace softgrain
