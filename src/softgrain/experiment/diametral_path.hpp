#pragma once
#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/plate_legs.hpp"
#include "softgrain/experiment/plate_path.hpp"

namespace softgrain {

/// Travel of the top plate [m] at which a grain of radius R has the strain eps = -ln(1 - d/R), where d, the
/// approach of its centre to a plate, is half the travel.
double plate_travel(double strain, double grain_radius);
double grain_strain(double plate_travel, double grain_radius);

/// Diametral compression: the top plate goes down at constant speed, turns back at given strains by a given
/// strain, comes down again, and stops at the last strain.
class DiametralPath final : public PlatePath {
 public:
  DiametralPath(const Case::Loading& loading, double grain_radius, double dt);

  std::int64_t steps() const override { return legs_.steps(); }
  double plate_velocity(std::int64_t step, double travel) const override {
    return legs_.velocity(step, travel);
  }
  bool approaches(std::int64_t step) const override { return legs_.approaches(step); }
  int leg(std::int64_t step) const override { return legs_.leg(step); }
  double strain(double height_start, double height) const override {
    return grain_strain(height_start - height, radius_);
  }

 private:
  double radius_;
  PlateLegs legs_;
};

}  // namespace softgrain
