#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/held_stress.hpp"
#include "softgrain/experiment/plate_path.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/geometry/wall.hpp"

namespace softgrain {

/// Plates that keep a stress sigma_h are bodies of mass m and damper Z: they come together at the speed v of
///   m dv/dt = sigma_h + s - sigma - Z v/(1 + t/tau),  ds/dt = (sigma_h - sigma)/(10 tau),
/// with |v| <= loading.wall_velocity and |s| <= sigma_h/5. While sigma is below sigma_h/2 t grows, and plates
/// that touch nothing speed up; above, it falls within tau/4.
struct PlateBody {
  double mass = 0;      ///< m, over the area of a plate [kg/m^2]
  double damper = 0;    ///< Z, over the area of a plate [Pa s/m]
  double patience = 1;  ///< tau [s]
};

/// Drives the walls of an experiment along a path. In a box it watches the vertical stress:
/// loading.max_stress ends the run; from loading.hold_stress on the walls leave the path, keep that stress
/// for loading.hold, and the run ends.
class WallDrive {
 public:
  /// Why a run ends before the end of path and hold; the numbers stand in checkpoints.
  enum class End : int { none, max_stress, max_overlap, close_packing };
  /// With the position of the walls all that a checkpoint needs.
  struct State {
    double stress = 0;        ///< mean of sigma over 0.1 % of strain at the full speed [Pa]
    double stress_twice = 0;  ///< the same mean of that mean [Pa]
    End ended = End::none;
    std::int64_t hold_start = -1;  ///< first step of the hold; -1: none yet
    double largest = 0;            ///< sigma so far [Pa]
    double speed = 0;              ///< v of plates that keep a stress [m/s]
    double slope = 0;              ///< d sigma/dv that the search for it met last [Pa s/m]
    double open = 0;               ///< t for which sigma has been below half of sigma_h [s]
    double lent = 0;               ///< s [Pa]
    HeldStress held;
  };

  /// Raises UsageError for a stress that is held for no time.
  WallDrive(const Case::Loading& loading, std::unique_ptr<PlatePath> path, double dt);

  /// The walls leave the path for this motion, each with its share; what a strain is stays. Raises
  /// UsageError.
  void follow(PlateMotion motion);

  /// Steps of the whole path; the hold of a stress ends before.
  std::int64_t steps_planned() const { return path_->steps(); }
  bool finished(std::int64_t step) const { return state.ended != End::none || step >= end(); }
  double progress(std::int64_t step) const {
    return finished(step) ? 1 : static_cast<double>(step) / static_cast<double>(end());
  }
  /// Number of the leg of a step; the hold of a stress is one.
  int leg(std::int64_t step) const;
  bool at_turning_point(std::int64_t step) const { return step > 0 && leg(step) != leg(step - 1); }
  /// Speed of the plates towards each other in the coming step [m/s], after they have come `travel` [m].
  double approach_speed(std::int64_t step, double travel) const;
  /// Velocity of a wall [m/s] for that speed.
  Vec<2> velocity(const Wall<2>& wall, int index, double approach_speed) const;
  double strain(double height_start, double height) const { return path_->strain(height_start, height); }

  bool holds() const { return state.hold_start >= 0; }
  /// sigma_h if it is kept in this step, or kept from it on where it is reached [Pa]; 0: neither.
  double stress_limit(std::int64_t step) const {
    return holds() || path_->approaches(step) ? loading_.hold_stress : 0;
  }
  double largest_speed() const { return loading_.wall_velocity; }
  /// The walls leave the path from this step on.
  void begin_hold(std::int64_t step);

  /// Takes the vertical stress [Pa] in a box of this height [m] that was found in the last of `steps_done`.
  void watch(double stress, double height, std::int64_t steps_done);
  /// Why the run ends before its last planned step; "" if that has other reasons.
  std::string early_end(std::int64_t step) const;
  /// Which stresses of the case were not reached, or not kept.
  PathOutcome outcome(std::int64_t step) const;
  /// What of the state stands in no other array of a checkpoint; one without it is of an earlier version.
  void save(Checkpoint& checkpoint) const;
  void restore(const Checkpoint& checkpoint);

  State state;
  PlateBody plates;

 private:
  std::int64_t end() const { return holds() ? state.hold_start + hold_steps_ : path_->steps(); }

  Case::Loading loading_;
  std::shared_ptr<const PlatePath> path_;  // shared by copies
  double dt_ = 0;
  std::int64_t hold_steps_ = 0;
};

}  // namespace softgrain
