#pragma once
#include <cstdint>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/plate_path.hpp"

namespace softgrain {

/// Travel of the top plate [m] at which a grain of radius R has the strain eps = -ln(1 - d/R), where d, the
/// approach of its centre to a plate, is half the travel.
double plate_travel(double strain, double grain_radius);
double grain_strain(double plate_travel, double grain_radius);

/// Diametral compression: the top plate goes down at constant speed, turns back at given strains by a given
/// strain, comes down again, and stops at the last strain. Every leg is a whole number of steps, so the path
/// is exact after a restart.
class DiametralPath final : public PlatePath {
 public:
  DiametralPath(const Case::Loading& loading, double grain_radius, double dt);

  std::int64_t steps() const override { return legs_.back().end; }
  double plate_velocity(std::int64_t step) const override;
  int leg(std::int64_t step) const override;
  double strain(double height_start, double height) const override {
    return grain_strain(height_start - height, radius_);
  }

 private:
  struct Leg {
    std::int64_t end;  // first step after it
    double velocity;   // [m/s]
  };
  double radius_;
  std::vector<Leg> legs_;
};

}  // namespace softgrain
