#pragma once
#include <array>
#include <cstdint>

namespace softgrain {

/// Walls of an experiment in the order of every list of them: bottom and top, then left and right of a box.
enum BoxWall : int { bottom_wall, top_wall, left_wall, right_wall };

/// How the plates approach each other, step by step, and what their travel means as a strain.
class PlatePath {
 public:
  virtual ~PlatePath() = default;
  virtual std::int64_t steps() const = 0;
  /// Rate of the distance of the plates during step k [m/s], negative while loading. At its start they have
  /// come `travel` [m] together since the start of the path.
  virtual double plate_velocity(std::int64_t step, double travel) const = 0;
  /// True for a step in which the plates come together.
  virtual bool approaches(std::int64_t step) const = 0;
  /// Share of it that each wall makes along its normal, by BoxWall.
  virtual std::array<double, 4> shares() const { return {0, 1, 0, 0}; }
  /// Number of the leg of step k: 0 loading, 1 unloading, 2 reloading, ...; a rest is a leg of its own.
  virtual int leg(std::int64_t step) const = 0;
  /// Strain for the distance of the plates at the start and now [m].
  virtual double strain(double height_start, double height) const = 0;
};

}  // namespace softgrain
