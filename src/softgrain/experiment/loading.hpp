#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "softgrain/experiment/held_stress.hpp"
#include "softgrain/experiment/stage.hpp"
#include "softgrain/geometry/box.hpp"
#include "softgrain/model/model.hpp"

namespace softgrain {

/// Whether a finished loading did what its case asks for.
struct LoadingOutcome {
  /// It ended at the last strain or packing fraction, or at another end that the case names.
  bool completed = true;
  /// What was not reached, or not kept, and why, for the user; "" if nothing. A completed loading may have
  /// one: it ended at its last strain, and a stress that would have ended it before was not reached.
  std::string shortfall;
};

/// Moves the walls of a box through the stages of a case, one after the other, and watches the stress. It
/// speaks of times and strains, not of steps. A stage that ends at a strain is over in the step that makes
/// what is left of the way, counted from the travel really made: no error of a stage, be it a rounding or a
/// stage shorter than a step, reaches the next.
class Loading {
 public:
  /// Why a loading ends before its last stage; the numbers stand in snapshots.
  enum class End : int { none, max_stress, max_overlap, exhausted };

  /// height: of the box at the start [m].
  Loading(std::vector<Stage> stages, StrainMeasure measure, LoadingEnds ends, double height);

  /// Goes through its stages from the present state of the box, which a loading of another run left: strains
  /// count from where that run began. `visit` reads its arrays.
  void begin_at(StateVisitor& visit, const Box<2>& box);
  /// The walls leave the stages for this motion, with the shares of the first stage. Raises UsageError for a
  /// duration that is not positive.
  void follow(WallMotion motion);

  bool finished() const { return ended_ != End::none || stage_ >= stages_.size(); }
  /// Share of what is planned that is over, at a time [s] with so many planned steps of dt [s]; 1 when
  /// finished.
  double progress(double time, double dt, std::int64_t planned) const;
  /// Steps of dt of all stages; the hold of a stress ends before.
  std::int64_t steps_planned(double dt) const;
  /// Number of the stage of the last step: 0 the first, then one more after every turn.
  int number() const { return number_of_last_; }
  /// True if the coming step is the first of a stage but the first one.
  bool at_turning_point() const { return !finished() && number_ != number_of_last_; }
  double last_strain() const { return stages_.back().strain.value_or(0); }
  double strain(const Box<2>& box) const { return measure_.strain(height_, box.height()); }

  /// Rate at which bottom and top shall come together in the coming step [m/s]. Raises UsageError where a
  /// motion gives no number.
  double approach_speed(const Box<2>& box, double time, double dt);
  /// Gives the walls their velocities for that rate.
  void drive(Box<2>& box, double approach_speed) const;
  /// The vertical stress that walls may not exceed in the coming step [Pa]; 0: any.
  double stress_limit() const { return holds_ || approaches_ ? ends_.hold_stress : 0; }
  bool holds() const { return holds_; }
  double largest_speed() const { return ends_.speed; }

  /// Takes the step that was just made, up to `time` [s]; stress: vertical, of the walls in it [Pa].
  void after_step(const Box<2>& box, double time, double dt, double stress, double overlap_mean);
  /// The stress was met: the walls keep it from the coming step on, first at this speed [m/s].
  void begin_hold(double time, double speed);
  void end(End why) { ended_ = why; }

  /// Why it ends before its last stage, for the user; "" if it does not, or the model says it.
  std::string early_end() const;
  /// Which stresses of the case were not reached, or not kept.
  LoadingOutcome outcome() const;
  End ended() const { return ended_; }

  void visit(StateVisitor& visit);

  WallBody body;     ///< of walls that keep a stress
  double speed = 0;  ///< of these walls towards each other [m/s]
  double slope = 0;  ///< d sigma/dv that the search for their speed met last [Pa s/m]

 private:
  struct Way {
    double from = 0, to = 0;  // travel at the start and end of a stage [m]
  };
  void watch(double stress, double time, double dt, double height);
  void keep_stress(double stress, double dt);
  void next_stage(double time);
  std::int64_t steps_of(std::size_t stage, double dt) const;
  void visit_start(StateVisitor& visit);
  void plan_from(double travel);

  std::vector<Stage> stages_;
  std::vector<Way> ways_;
  StrainMeasure measure_;
  LoadingEnds ends_;
  WallMotion motion_;
  double height_ = 0;  // where strains count from [m]
  double start_ = 0;   // travel at the start of the first stage [m]

  std::size_t stage_ = 0;   // of the coming step
  double stage_start_ = 0;  // [s]
  int number_ = 0, number_of_last_ = 0;
  End ended_ = End::none;
  bool holds_ = false;
  bool approaches_ = false, last_of_stage_ = false;  // of the coming step
  double stress_ = 0,
         stress_twice_ = 0;    // mean of sigma over 0.1 % of strain at the full speed, and its mean [Pa]
  double largest_stress_ = 0;  // so far [Pa]
  double open_ = 0;            // t for which sigma has been below half of sigma_h [s]
  double lent_ = 0;            // s [Pa]
  HeldStress held_;
};

}  // namespace softgrain
