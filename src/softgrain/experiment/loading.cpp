#include "softgrain/experiment/loading.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

/// Strain over which the stress is averaged.
constexpr double averaging_strain = 1e-3;

/// What a damper bears of the stress while grains creep is lent to the walls, up to this share of it, within
/// so many times the patience.
constexpr double lent_share = 0.2;
constexpr double lending_times = 10;

/// Of the way of a stage: less is no step more.
constexpr double rounding = 1e-9;

/// Of dt, in a time [s], at least one.
std::int64_t whole_steps(double time, double dt) {
  return std::max<std::int64_t>(1, std::llround(time / dt));
}

}  // namespace

Loading::Loading(std::vector<Stage> stages, StrainMeasure measure, LoadingEnds ends, double height)
    : stages_(std::move(stages)), measure_(measure), ends_(ends), height_(height) {
  plan_from(0);
}

void Loading::plan_from(double travel) {
  start_ = travel;
  ways_.clear();
  for (Stage& stage : stages_) {
    const double to = stage.strain ? measure_.travel(*stage.strain) : travel;
    if (stage.strain) stage.speed = std::copysign(stage.speed, to - travel);
    ways_.push_back({travel, to});
    travel = to;
  }
}

void Loading::begin_at(StateVisitor& visit, const Box<2>& box) {
  visit_start(visit);
  plan_from(height_ - box.height());
}

void Loading::visit_start(StateVisitor& visit) {
  visit({"height_start", "m", Owner::run, Role::state, "of the box where strains count from"}, height_);
  if (measure_.kind == StrainMeasure::Kind::of_box) measure_.length = height_;
}

void Loading::follow(WallMotion motion) {
  require(std::isfinite(motion.duration) && motion.duration > 0,
          "the duration of a motion must be > 0, got {} s", motion.duration);
  stages_ = {{.share = stages_.front().share, .duration = motion.duration}};
  ways_ = {{}};
  motion_ = std::move(motion);
}

std::int64_t Loading::steps_of(std::size_t stage, double dt) const {
  if (const auto& duration = stages_[stage].duration) return whole_steps(*duration, dt);
  const double way = std::abs(ways_[stage].to - ways_[stage].from);
  const double steps = way / (std::abs(stages_[stage].speed) * dt);
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(steps * (1 - rounding))));
}

std::int64_t Loading::steps_planned(double dt) const {
  std::int64_t steps = 0;
  for (std::size_t k = 0; k < stages_.size(); ++k) steps += steps_of(k, dt);
  return steps;
}

double Loading::progress(double time, double dt, std::int64_t planned) const {
  if (finished()) return 1;
  const double end = holds_ ? stage_start_ + static_cast<double>(whole_steps(ends_.hold, dt)) * dt
                            : static_cast<double>(planned) * dt;
  return time / end;
}

double Loading::approach_speed(const Box<2>& box, double time, double dt) {
  last_of_stage_ = false;
  if (holds_) return speed;
  if (stage_ >= stages_.size()) return approaches_ = false, 0;  // whoever goes on, the walls rest
  const Stage& stage = stages_[stage_];
  double speed_now = stage.speed;
  if (stage.duration) last_of_stage_ = time - stage_start_ + 1.5 * dt > *stage.duration;
  if (motion_.velocity) {
    speed_now = -motion_.velocity(time);
    require(std::isfinite(speed_now), "the motion asks for {} m/s at {} s", -speed_now, time);
  }
  approaches_ = speed_now > 0;
  if (!stage.strain) return speed_now;
  const double left = ways_[stage_].to - (height_ - box.height());
  const double way = std::abs(ways_[stage_].to - ways_[stage_].from);
  last_of_stage_ = left / speed_now <= dt + rounding * way / std::abs(speed_now);
  return last_of_stage_ ? left / dt : speed_now;
}

void Loading::drive(Box<2>& box, double approach_speed) const {
  const auto& share = stages_[std::min(stage_, stages_.size() - 1)].share;
  for (std::size_t w = 0; w < box.walls.size(); ++w)
    // from 0: a wall that rests has no negative zeros
    box.walls[w].velocity = Vec<2>{} + (share[w] * approach_speed) * box.walls[w].normal;
}

void Loading::next_stage(double time) {
  ++number_;
  stage_start_ = time;
}

void Loading::begin_hold(double time, double first_speed) {
  holds_ = true;
  speed = first_speed;
  next_stage(time);
}

void Loading::after_step(const Box<2>& box, double time, double dt, double stress, double overlap_mean) {
  const bool held_before = holds_ && time > stage_start_;  // not from this step's end on
  number_of_last_ = holds_ && !held_before ? number_ - 1 : number_;
  if (!holds_ && last_of_stage_ && stage_ < stages_.size()) {
    ++stage_;
    if (stage_ < stages_.size()) next_stage(time);
  }
  if (!box.closed()) return;
  watch(stress, time, dt, box.height());
  if (ends_.max_overlap > 0 && overlap_mean >= ends_.max_overlap) ended_ = End::max_overlap;
}

/// The mean lags behind a stress that rises evenly, and its own mean lags behind it as far; where the walls
/// rest there is no lag to make up for.
void Loading::watch(double stress, double time, double dt, double height) {
  const double share = std::min(1.0, ends_.speed * dt / height / averaging_strain);
  stress_ += share * (stress - stress_);
  stress_twice_ += share * (stress_ - stress_twice_);
  const double present = approaches_ ? 2 * stress_ - stress_twice_ : stress_;
  largest_stress_ = std::max(largest_stress_, present);
  if (ends_.max_stress > 0 && present >= ends_.max_stress) ended_ = End::max_stress;
  if (ends_.hold_stress == 0) return;
  if (!holds_ && approaches_ && present >= ends_.hold_stress) begin_hold(time, ends_.speed);
  if (!holds_) return;
  const std::int64_t steps = whole_steps(ends_.hold, dt);
  const std::int64_t done = std::llround((time - stage_start_) / dt);
  if (done > 0) held_.add(stress / ends_.hold_stress, done - 1, steps);
  if (done >= steps) stage_ = stages_.size();
  if (body.mass > 0) keep_stress(stress, dt);
}

/// m (v+ - v)/dt = sigma_h + s - sigma - Z v+/(1 + t/tau)
void Loading::keep_stress(double stress, double dt) {
  const double asked = ends_.hold_stress, lack = asked - stress, most = lent_share * asked;
  // the shocks of single steps leave most of it
  open_ += stress < asked / 2 ? dt : -open_ * std::min(1.0, 4 * dt / body.patience);
  lent_ = std::clamp(lent_ + lack * dt / (lending_times * body.patience), -most, most);
  const double damper = body.damper / (1 + open_ / body.patience);
  const double v = (body.mass * speed + dt * (lent_ + lack)) / (body.mass + dt * damper);
  speed = std::clamp(v, -ends_.speed, ends_.speed);
}

std::string Loading::early_end() const {
  if (!finished()) return "";
  if (ended_ == End::max_stress) return "loading.max_stress is reached";
  if (ended_ == End::max_overlap) return "loading.max_overlap is reached";
  if (!holds_) return "";
  return fmt::format("loading.hold_stress was {} for loading.hold: over the second half {}",
                     held_.kept() ? "kept" : "asked for, but not kept,", held_.text());
}

LoadingOutcome Loading::outcome() const {
  if (!finished()) return {};
  const auto not_reached = [&](const char* key, double stress) {
    return fmt::format("loading.{} of {:.3g} Pa was not reached: the largest stress was {:.3g} Pa", key,
                       stress, largest_stress_);
  };
  if (ends_.hold_stress > 0 && !holds_)
    return {.completed = ended_ != End::none,
            .shortfall = not_reached("hold_stress", ends_.hold_stress) + ", so nothing was held"};
  if (ends_.max_stress > 0 && ended_ == End::none && !holds_)
    return {.completed = true, .shortfall = not_reached("max_stress", ends_.max_stress)};
  if (holds_ && ended_ == End::none && !held_.kept())
    return {.completed = false,
            .shortfall =
                "loading.hold_stress was not kept: over the second half of loading.hold the stress was " +
                held_.text()};
  return {};
}

void Loading::visit(StateVisitor& visit) {
  visit_start(visit);
  visit({"travel_start", "m", Owner::run, Role::state, "of the walls where the first stage began"}, start_);
  if (visit.reads() && !motion_.velocity) plan_from(start_);
  const auto number = [&](std::string_view name, std::string_view unit, std::string_view text, auto& value) {
    visit({name, unit, Owner::run, Role::state, text}, value);
  };
  number("stage", "", "of the coming step", stage_);
  number("stage_start", "s", "when it began", stage_start_);
  number("stage_number", "", "how many stages came before it", number_);
  number("stage_number_of_last", "", "before that of the last step", number_of_last_);
  number("loading_end", "", "0: none, 1: stress, 2: overlap, 3: the grains are exhausted", ended_);
  number("holds_stress", "", "1 while a stress is held", holds_);
  number("stress_mean", "Pa", "vertical, over 0.1 % of strain", stress_);
  number("stress_mean_of_mean", "Pa", "the same mean of that mean", stress_twice_);
  number("stress_largest", "Pa", "so far", largest_stress_);
  number("wall_speed", "m/s", "of walls that keep a stress", speed);
  number("wall_slope", "Pa s/m", "of the stress over that speed", slope);
  number("wall_open_time", "s", "for which the stress was below half of that asked for", open_);
  number("wall_lent_stress", "Pa", "lent to the walls for what their damper bears", lent_);
  held_.visit(visit);
  if (stage_ > stages_.size() || ended_ < End::none || ended_ > End::exhausted)
    throw IoError("the snapshot's arrays 'stage' or 'loading_end' belong to no stage of this case");
}

}  // namespace softgrain
