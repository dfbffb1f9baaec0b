#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "softgrain/geometry/box.hpp"
#include "softgrain/loading/held_stress.hpp"
#include "softgrain/loading/plan.hpp"
#include "softgrain/loading/stage.hpp"
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

/// What a step made of the grains, besides the walls.
struct StepFelt {
  double overlap_mean = 0;
  double unrest = 0;  ///< kinetic over stored energy
};

/// Moves the walls of a box, or a periodic cell, through the stages of a case, one after the other, and
/// watches the stress. It speaks of times and strains, not of steps. A stage that ends at a strain is over in
/// the step that makes what is left of the way, counted from the travel really made: no error of a stage, be
/// it a rounding or a stage shorter than a step, reaches the next. Walls that keep a stress are presses,
/// which the model moves.
template <int Dim>
class LoadingOf {
 public:
  /// Why a loading ends before its last stage; the numbers stand in snapshots.
  enum class End : int { none, exit, limit, exhausted };

  /// Strains count from this box.
  LoadingOf(const std::vector<Stage>& stages, const LoadingFrame& frame, const Box<Dim>& box);

  /// Goes through its stages from the present state of the box, which a loading of another run left: strains
  /// count from where that run began. `visit` reads its arrays.
  void begin_at(StateVisitor& visit, const Box<Dim>& box);
  /// The walls leave the stages for this motion of the part that the first stage moves. Raises UsageError for
  /// a duration that is not positive.
  void follow(WallMotion motion);

  bool finished() const { return ended_ != End::none || stage_ >= stages_.size(); }
  /// Share of what is planned that is over, at a time [s] in steps of dt [s]; 1 when finished. It never goes
  /// back, whenever stages end.
  double progress(double time, double dt) const;
  /// Steps of dt that all stages are expected to take.
  std::int64_t steps_planned(double dt) const;
  /// Number of the stage of the last step: 0 the first, then one more after every turn.
  int number() const { return number_of_last_; }
  /// True if the coming step is the first of a stage but the first one.
  bool at_turning_point() const { return !finished() && number_ != number_of_last_; }
  double strain(const Box<Dim>& box) const { return frame_.strain(0, box.height()); }
  /// What the stages up to the one of the coming step have changed.
  const Settings& settings() const { return stages_[std::min(stage_, stages_.size() - 1)].set; }
  /// Whether a stage waits for the grains to come to rest.
  bool asks_for_rest() const;

  /// Gives the walls their velocities, and the box its presses, for the coming step. Raises UsageError where
  /// a motion gives no number.
  void drive(Box<Dim>& box, const ModelOf<Dim>& model, double time, double dt);
  /// Takes the step that was just made, up to `time` [s].
  void after_step(const Box<Dim>& box, double time, double dt, const StepFelt& felt);
  void end(End why) { ended_ = why; }

  /// Why it ends before its last stage, for the user; "" if it does not, or the model says it.
  std::string early_end() const;
  /// Where it is when it cannot go on: "before loading.max_strain 0.3", "in stage 'press'".
  std::string where() const;
  /// Which stresses of the case were not reached, or not kept.
  LoadingOutcome outcome() const;
  End ended() const { return ended_; }

  void visit(StateVisitor& visit);

 private:
  using OfParts = std::array<double, parts_with_stress>;
  using Speeds = std::array<double, 4>;

  double length(const Box<Dim>& box, int component) const;
  const Stage& stage_now() const { return stages_[stage_]; }
  Speeds speeds_of(const Stage& stage, const Box<Dim>& box, double time, double dt) const;
  double closing_speed(const Stage& stage, const Speeds& speeds, int component) const;
  double speed_to_strain(const Drive& drive, const Box<Dim>& box, double time, double dt) const;
  void end_at_strain(const Stage& stage, const Box<Dim>& box, Speeds& speeds, double dt);
  Press press_of(const Drive& drive, const Box<Dim>& box, const ModelOf<Dim>& model, double time,
                 double dt) const;
  std::size_t first_to_move_top() const;
  bool moves_cell(const Drive& drive, const Box<Dim>& box) const;
  double pressed_length(const Drive& drive, const Box<Dim>& box) const;
  double impulse_of(const Drive& drive, const Box<Dim>& box) const;
  double push_cell(const Drive& drive, const Box<Dim>& box, const ModelOf<Dim>& model, double time,
                   double dt);
  void move_cell(const Stage& stage, const Speeds& speeds, Box<Dim>& box) const;
  void keep_presses(const Box<Dim>& box);
  void keep_press(const Drive& drive, const Press& press);

  void watch(const Box<Dim>& box, double dt);
  double present_stress(std::size_t part) const;
  void judge_presses(const Box<Dim>& box, double time, double dt);
  const Exit* exit_taken(const StepFelt& felt) const;
  bool is_over(const Box<Dim>& box, const StepFelt& felt) const;
  bool is_at_strain(const Box<Dim>& box, int component, double strain) const;
  bool is_at_stress(std::size_t part, double stress) const;
  bool is_at_limit(const Box<Dim>& box) const;
  std::array<double, 3> strains_at_stage() const;

  void leave_stage(std::size_t next, const Box<Dim>& box, double time, double dt);
  void note_unkept();
  void note_unreached();
  void note_past();
  bool opens() const;
  double packing_fraction(const std::array<double, 3>& length) const;
  void begin_stage(const Box<Dim>& box, double time);
  void visit_start(StateVisitor& visit);
  void visit_stage(StateVisitor& visit);
  void visit_stresses(StateVisitor& visit);
  void visit_held(StateVisitor& visit);
  void plan_stages();
  void plan_rest();

  LoadingOutcome outcome_of_limit() const;
  LoadingOutcome outcome_of_exits() const;
  LoadingOutcome outcome_of_stresses() const;
  std::string not_reached(std::string_view what, double stress, std::size_t part) const;

  std::vector<Stage> stages_;
  LoadingFrame frame_;
  std::vector<PlannedStage> planned_;
  WallMotion motion_;
  std::array<double, 3> travel_start_{};  // where the first stage began [m]

  std::size_t stage_ = 0;                    // of the coming step
  std::size_t closing_stage_ = 0;            // that moves the top wall first
  double stage_start_ = 0;                   // [s]
  std::array<double, 3> length_at_stage_{};  // of the box where it began [m]
  int number_ = 0, number_of_last_ = 0;
  double progress_at_stage_ = 0;  // when it began
  End ended_ = End::none;
  int exit_ = -1;                    // of the stage's exits, that ended the loading
  bool kept_last_ = false;           // an exit led to the last stage
  bool last_of_stage_ = false;       // of the coming step
  std::array<double, 3> closing_{};  // speed at which walls come together, but for presses

  OfParts stress_{},
      stress_twice_{};         // mean of sigma over 0.1 % of strain at wall_velocity, and its mean [Pa]
  OfParts largest_{};          // so far [Pa]
  OfParts stress_at_stage_{};  // the mean where the stage began [Pa]
  OfParts press_speed_{}, press_mean_speed_{}, press_force_{},
      press_waiting_{};  // of Press [m/s], [N/m], [s]

  std::array<HeldStress, 4> held_{};  // by drive of the stage
  HeldStress unkept_;                 // of the first that was not kept
  int unkept_stage_ = -1, unkept_part_ = 0;
  // the first stress that did not end its stage; a part without one: the stage's strain was past as it began
  int unreached_stage_ = -1, unreached_part_ = 0;
};
using Loading = LoadingOf<2>;

}  // namespace softgrain
