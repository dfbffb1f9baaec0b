#include "softgrain/loading/loading.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

/// Strain over which the stress is averaged.
constexpr double averaging_strain = 1e-3;

/// Of the way of a stage: less is no step more.
constexpr double rounding = 1e-9;

double target_of(const Drive& drive, double time) {
  if (drive.amplitude == 0) return drive.value;
  return drive.value + drive.amplitude * wave_at(drive.wave, time, drive.period);
}

double side_of_wall(const Box<2>& box, std::size_t wall) {
  return wall <= top_wall ? box.width() : box.height();
}

/// sum_w share_w l_w [m]: what a stress on these walls presses on.
double pressed_length(const std::array<double, 4>& share, const Box<2>& box) {
  double length = 0;
  for (std::size_t w = 0; w < box.walls.size(); ++w)
    if (share[w] != 0) length += share[w] * side_of_wall(box, w);
  return length;
}

std::size_t number_of(Part part) { return static_cast<std::size_t>(part); }

std::int64_t steps_in(double time, double dt) { return std::llround(time / dt); }

}  // namespace

Loading::Loading(const std::vector<Stage>& stages, const LoadingFrame& frame, const Box<2>& box)
    : stages_(without_repeats(stages)), frame_(frame) {
  for (int c = 0; c < 2; ++c) frame_.start[c] = length_at_stage_[c] = length(box, c);
  if (frame_.measure.kind == StrainMeasure::Kind::of_box) frame_.measure.length = frame_.start[0];
  for (std::size_t k = 1; k < stages_.size(); ++k) stages_[k].set = stages_[k - 1].set.then(stages_[k].set);
  plan_stages();
}

void Loading::plan_stages() { planned_ = plan(stages_, frame_, travel_start_); }

/// The stages that are left, from where the present one began.
void Loading::plan_rest() {
  const auto planned = plan(std::span(stages_).subspan(stage_), frame_,
                            {frame_.start[0] - length_at_stage_[0], frame_.start[1] - length_at_stage_[1]});
  std::copy(planned.begin(), planned.end(), planned_.begin() + static_cast<std::ptrdiff_t>(stage_));
}

double Loading::length(const Box<2>& box, int component) const {
  return box.bounded(1 - component) ? box.length(1 - component) : frame_.start[component];
}

void Loading::begin_at(StateVisitor& visit, const Box<2>& box) {
  visit_start(visit);
  for (int c = 0; c < 2; ++c) {
    length_at_stage_[c] = length(box, c);
    travel_start_[c] = frame_.start[c] - length_at_stage_[c];
  }
  plan_stages();
}

void Loading::follow(WallMotion motion) {
  require(std::isfinite(motion.duration) && motion.duration > 0,
          "the duration of a motion must be > 0, got {} s", motion.duration);
  Stage given = stages_.front();
  if (given.drives.empty()) given.drives.push_back({});
  given.drives = {{.part = given.drives.front().part, .control = Control::velocity}};
  given.until = {.time = motion.duration};
  const Stage last = stages_.back();
  stages_ = {given};
  if (last.only_by_exit) stages_.push_back(last);
  motion_ = std::move(motion);
  plan_stages();
}

std::int64_t Loading::steps_planned(double dt) const {
  std::int64_t steps = 0;
  for (const PlannedStage& stage : planned_) steps += stage.steps(dt);
  return steps;
}

/// What was left when the present stage began falls to this one and those to come as their times are
/// foreseen now.
double Loading::progress(double time, double dt) const {
  if (finished()) return 1;
  std::int64_t rest = 0;
  for (std::size_t k = stage_; k < planned_.size(); ++k) rest += planned_[k].steps(dt);
  const double done = std::min((time - stage_start_) / dt, static_cast<double>(planned_[stage_].steps(dt)));
  return progress_at_stage_ + (1 - progress_at_stage_) * done / static_cast<double>(rest);
}

bool Loading::asks_for_rest() const { return !finished() && stage_now().until.rest.has_value(); }

void Loading::drive(Box<2>& box, const Model& model, double time, double dt) {
  last_of_stage_ = false;
  closing_ = {};
  box.presses.clear();
  for (Wall<2>& wall : box.walls) wall.velocity = {};
  if (stage_ >= stages_.size()) return;  // whoever goes on, the walls rest
  const Stage& stage = stage_now();
  if (stage.until.time) last_of_stage_ = time - stage_start_ + 1.5 * dt > *stage.until.time;
  Speeds speeds = speeds_of(stage, box, time, dt);
  for (int c = 0; c < 2; ++c) closing_[c] = closing_speed(stage, speeds, c);
  end_at_strain(stage, box, speeds, dt);
  for (std::size_t d = 0; d < stage.drives.size(); ++d) {
    const auto share = share_of(stage.drives[d].part, frame_.aspect);
    for (std::size_t w = 0; w < box.walls.size(); ++w)
      // from 0: a wall that rests has no negative zeros
      if (share[w] != 0) box.walls[w].velocity = Vec<2>{} + (share[w] * speeds[d]) * box.walls[w].normal;
    if (stage.drives[d].control == Control::stress)
      box.presses.push_back(press_of(stage.drives[d], box, model, time, dt));
  }
}

Loading::Speeds Loading::speeds_of(const Stage& stage, const Box<2>& box, double time, double dt) const {
  Speeds speeds{};
  for (std::size_t d = 0; d < stage.drives.size(); ++d) {
    const Drive& drive = stage.drives[d];
    const int component = 1 - axis_of(drive.part);
    if (drive.control == Control::velocity) speeds[d] = drive.value;
    if (drive.control == Control::rate) speeds[d] = drive.value * length(box, component);
    if (drive.control == Control::strain) speeds[d] = speed_to_strain(drive, box, time, dt);
    if (drive.control == Control::stress) speeds[d] = press_speed_[number_of(drive.part)];
    if (stage.towards && stage.until.strain[0]) {
      const double start = frame_.start[0] - length_at_stage_[0];
      speeds[d] = std::copysign(speeds[d], frame_.travel(0, *stage.until.strain[0]) - start);
    }
  }
  if (motion_.velocity && stage_ == 0) {
    speeds[0] = -motion_.velocity(time);
    require(std::isfinite(speeds[0]), "the motion asks for {} m/s at {} s", -speeds[0], time);
  }
  return speeds;
}

/// That brings the walls to l_0 e^(-A wave(t)), l_0 their distance at the start of the stage.
double Loading::speed_to_strain(const Drive& drive, const Box<2>& box, double time, double dt) const {
  const int component = 1 - axis_of(drive.part);
  const double wave = wave_at(drive.wave, time + dt - stage_start_, drive.period);
  const double aim = length_at_stage_[component] * std::exp(-drive.amplitude * wave);
  return (length(box, component) - aim) / dt;
}

/// Of the walls that are given a velocity.
double Loading::closing_speed(const Stage& stage, const Speeds& speeds, int component) const {
  double closing = 0;
  for (std::size_t d = 0; d < stage.drives.size(); ++d)
    if (stage.drives[d].is_given())
      closing += closing_share(stage.drives[d].part, component, frame_.aspect) * speeds[d];
  return closing;
}

/// In the last step of a stage walls make what is left of their way to its strain.
void Loading::end_at_strain(const Stage& stage, const Box<2>& box, Speeds& speeds, double dt) {
  for (int c = 0; c < 2; ++c) {
    if (!stage.until.strain[c] || closing_[c] == 0) continue;
    const bool alone = std::all_of(stage.drives.begin(), stage.drives.end(), [&](const Drive& drive) {
      return drive.is_given() || closing_share(drive.part, c, 1) == 0 || drive.control == Control::rest;
    });
    if (!alone) continue;
    const double to = frame_.travel(c, *stage.until.strain[c]), closing = closing_[c];
    const double way = std::abs(to - (frame_.start[c] - length_at_stage_[c]));
    double left = to - (frame_.start[c] - length(box, c));
    if (left / closing > dt + rounding * way / std::abs(closing)) continue;
    if (left * closing < 0 && !stage.towards) left = 0;  // the strain is past already
    last_of_stage_ = true;
    for (std::size_t d = 0; d < stage.drives.size(); ++d)
      if (stage.drives[d].is_given()) speeds[d] = (left / dt) * (speeds[d] / closing);
    return;
  }
}

Press Loading::press_of(const Drive& drive, const Box<2>& box, const Model& model, double time,
                        double dt) const {
  const auto share = share_of(drive.part, frame_.aspect);
  const double pressed = pressed_length(share, box);
  const PressBody body = model.press_body(box, axis_of(drive.part), dt);
  const std::size_t part = number_of(drive.part);
  return {.share = {share[0], share[1], share[2], share[3]},
          .force = target_of(drive, time + dt - stage_start_) * pressed,
          .mass = body.mass * pressed,
          .damper = body.damper * pressed,
          .most = drive.speed > 0 ? drive.speed : frame_.wall_velocity,
          .speed = press_speed_[part],
          .mean_force = press_force_[part],
          .waiting = press_waiting_[part]};
}

void Loading::keep_presses(const Box<2>& box) {
  if (stage_ >= stages_.size()) return;
  std::size_t press = 0;
  for (const Drive& drive : stage_now().drives) {
    if (drive.control != Control::stress || press >= box.presses.size()) continue;
    const std::size_t part = number_of(drive.part);
    press_speed_[part] = box.presses[press].speed;
    press_force_[part] = box.presses[press].mean_force;
    press_waiting_[part] = box.presses[press++].waiting;
  }
}

void Loading::after_step(const Box<2>& box, double time, double dt, const StepFelt& felt) {
  number_of_last_ = number_;
  keep_presses(box);
  if (box.closed()) watch(box, dt);
  if (finished()) return;
  judge_presses(box, time, dt);
  if (const Exit* exit = exit_taken(felt); exit != nullptr && exit->to_last) {
    kept_last_ = true;
    leave_stage(stages_.size() - 1, box, time, dt);
  } else if (exit != nullptr) {
    exit_ = static_cast<int>(exit - stage_now().exits.data());
    ended_ = End::exit;
  } else if (last_of_stage_ || is_over(box, felt)) {
    note_unreached();
    leave_stage(stage_ + 1, box, time, dt);
  } else if (is_at_limit(box)) {
    ended_ = End::limit;
  }
}

/// The mean lags behind a stress that changes evenly, and its own mean lags behind it as far; where the walls
/// rest there is no lag to make up for.
double Loading::present_stress(std::size_t part) const {
  const int component = 1 - axis_of(static_cast<Part>(part));
  return closing_[component] != 0 ? 2 * stress_[part] - stress_twice_[part] : stress_[part];
}

void Loading::watch(const Box<2>& box, double dt) {
  const double share = std::min(1.0, frame_.wall_velocity * dt / box.height() / averaging_strain);
  const auto on = [&](std::size_t wall) { return box.outward_impulse(wall); };
  const double below = dt * box.width(), beside = dt * box.height();
  const OfParts stress{(on(0) + on(1)) / (2 * below),
                       (on(2) + on(3)) / (2 * beside),
                       on(0) / below,
                       on(1) / below,
                       on(2) / beside,
                       on(3) / beside};
  for (std::size_t p = 0; p < parts_with_stress; ++p) {
    stress_[p] += share * (stress[p] - stress_[p]);
    stress_twice_[p] += share * (stress_[p] - stress_twice_[p]);
    largest_[p] = std::max(largest_[p], present_stress(p));
  }
}

void Loading::judge_presses(const Box<2>& box, double time, double dt) {
  const std::int64_t done = steps_in(time - stage_start_, dt) - 1;
  const std::int64_t steps = planned_[stage_].steps(dt);
  const Stage& stage = stage_now();
  for (std::size_t d = 0; d < stage.drives.size(); ++d) {
    const Drive& drive = stage.drives[d];
    if (drive.control != Control::stress || done < 0) continue;
    const auto share = share_of(drive.part, frame_.aspect);
    double impulse = 0;
    for (std::size_t w = 0; w < box.walls.size(); ++w)
      if (share[w] != 0) impulse += share[w] * box.outward_impulse(w);
    const double stress = impulse / dt / pressed_length(share, box);
    held_[d].add(stress / target_of(drive, time - stage_start_), done, steps);
  }
}

void Loading::leave_stage(std::size_t next, const Box<2>& box, double time, double dt) {
  note_unkept();
  progress_at_stage_ = progress(time, dt);
  do ++stage_;
  while (stage_ < stages_.size() && (stage_ < next || (stages_[stage_].only_by_exit && !kept_last_)));
  if (stage_ < stages_.size()) begin_stage(box, time);
}

void Loading::begin_stage(const Box<2>& box, double time) {
  ++number_;
  stage_start_ = time;
  stress_at_stage_ = stress_;
  for (int c = 0; c < 2; ++c) length_at_stage_[c] = length(box, c);
  if (!motion_.velocity) plan_rest();
  held_ = {};
  const OfParts speed = press_speed_, force = press_force_, waiting = press_waiting_;
  press_speed_ = press_force_ = press_waiting_ = {};
  for (const Drive& drive : stage_now().drives) {
    if (drive.control != Control::stress) continue;
    const std::size_t part = number_of(drive.part);
    press_speed_[part] = speed[part];  // others begin at rest
    press_waiting_[part] = waiting[part];
    press_force_[part] = force[part];
  }
}

}  // namespace softgrain
