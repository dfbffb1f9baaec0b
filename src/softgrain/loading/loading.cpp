#include "softgrain/loading/loading.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

/// Strain over which the stress is averaged.
constexpr double averaging_strain = 1e-3;

std::int64_t steps_in(double time, double dt) { return std::llround(time / dt); }

/// Have the walls of a stage that move as given gone as far as to its limit, where others give way before
/// them?
bool has_gone_to_limit(const Stage& stage, const LoadingFrame& frame,
                       const std::array<double, 3>& length_at_start, double time) {
  constexpr double rounding = 1e-6;
  const auto strain_at = [&](int c, double length) { return frame.strain(c, length); };
  const auto limit = limit_of(stage, {strain_at(0, length_at_start[0]), strain_at(1, length_at_start[1]),
                                      strain_at(2, length_at_start[2])});
  if (!limit) return false;
  const int c = limit->component;
  const double start = strain_at(c, length_at_start[c]), way = limit->strain - start;
  for (const Drive& drive : stage.drives) {
    if (!drive.is_given() || component_of(drive.part) != c) continue;
    const double left = length_at_start[c] - drive.value * time;
    if (drive.control == Control::velocity && !frame.is_shear(c) && left <= 0) return true;
    const double gone = drive.control == Control::rate ? drive.value * time : strain_at(c, left) - start;
    return std::abs(gone) >= (1 + rounding) * std::abs(way);
  }
  return false;
}

}  // namespace

template <int Dim>
LoadingOf<Dim>::LoadingOf(const std::vector<Stage>& stages, const LoadingFrame& frame, const Box<Dim>& box)
    : stages_(without_repeats(stages)), frame_(frame) {
  for (int c = 0; c < 3; ++c) frame_.start[c] = length_at_stage_[c] = length(box, c);
  if (frame_.measure.kind == StrainMeasure::Kind::of_box) frame_.measure.length = frame_.start[0];
  for (std::size_t k = 1; k < stages_.size(); ++k) stages_[k].set = stages_[k - 1].set.then(stages_[k].set);
  plan_stages();
}

template <int Dim>
void LoadingOf<Dim>::plan_stages() {
  planned_ = plan(stages_, frame_, travel_start_);
  closing_stage_ = first_to_move_top();
}

template <int Dim>
std::size_t LoadingOf<Dim>::first_to_move_top() const {
  const auto moves_top = [&](const Drive& drive) {
    return drive.control != Control::rest && frame_.template shares<Dim>(drive.part)[top_wall] != 0;
  };
  const auto first = std::find_if(stages_.begin(), stages_.end(), [&](const Stage& stage) {
    return std::any_of(stage.drives.begin(), stage.drives.end(), moves_top);
  });
  return static_cast<std::size_t>(first - stages_.begin());
}

/// The stages that are left, from where the present one began.
template <int Dim>
void LoadingOf<Dim>::plan_rest() {
  const auto planned = plan(std::span(stages_).subspan(stage_), frame_,
                            {frame_.start[0] - length_at_stage_[0], frame_.start[1] - length_at_stage_[1],
                             frame_.start[2] - length_at_stage_[2]});
  std::copy(planned.begin(), planned.end(), planned_.begin() + static_cast<std::ptrdiff_t>(stage_));
}

template <int Dim>
double LoadingOf<Dim>::length(const Box<Dim>& box, int component) const {
  if (frame_.is_shear(component)) return -box.shear;
  const int axis = Dim - 1 - component;
  return box.bounded(axis) || box.repeats(axis) ? box.length(axis) : frame_.start[component];
}

template <int Dim>
void LoadingOf<Dim>::begin_at(StateVisitor& visit, const Box<Dim>& box) {
  visit_start(visit);
  for (int c = 0; c < 3; ++c) {
    length_at_stage_[c] = length(box, c);
    travel_start_[c] = frame_.start[c] - length_at_stage_[c];
  }
  plan_stages();
}

template <int Dim>
void LoadingOf<Dim>::follow(WallMotion motion) {
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

template <int Dim>
std::int64_t LoadingOf<Dim>::steps_planned(double dt) const {
  std::int64_t steps = 0;
  for (const PlannedStage& stage : planned_) steps += stage.steps(dt);
  return steps;
}

/// What was left when the present stage began falls to this one and those to come as their times are
/// foreseen now.
template <int Dim>
double LoadingOf<Dim>::progress(double time, double dt) const {
  if (finished()) return 1;
  std::int64_t rest = 0;
  for (std::size_t k = stage_; k < planned_.size(); ++k) rest += planned_[k].steps(dt);
  const double done = std::min((time - stage_start_) / dt, static_cast<double>(planned_[stage_].steps(dt)));
  return progress_at_stage_ + (1 - progress_at_stage_) * done / static_cast<double>(rest);
}

template <int Dim>
bool LoadingOf<Dim>::asks_for_rest() const {
  return !finished() && stage_now().until.rest.has_value();
}

template <int Dim>
void LoadingOf<Dim>::drive(Box<Dim>& box, const ModelOf<Dim>& model, double time, double dt) {
  last_of_stage_ = false;
  closing_ = {};
  box.presses.clear();
  for (Wall<Dim>& wall : box.walls) wall.velocity = {};
  box.cell.remap();
  box.cell.rate = {};
  if (box.open_top) box.walls[top_wall].open = stage_ < closing_stage_;
  if (stage_ >= stages_.size()) return;  // whoever goes on, the walls rest
  const Stage& stage = stage_now();
  if (stage.until.time) last_of_stage_ = time - stage_start_ + 1.5 * dt > *stage.until.time;
  Speeds speeds = speeds_of(stage, box, time, dt);
  for (int c = 0; c < 3; ++c) closing_[c] = closing_speed(stage, speeds, c);
  end_at_strain(stage, box, speeds, dt);
  for (std::size_t d = 0; d < stage.drives.size(); ++d)
    if (stage.drives[d].control == Control::stress && moves_cell(stage.drives[d], box))
      speeds[d] = push_cell(stage.drives[d], box, model, time, dt);
  if (box.cell.any()) move_cell(stage, speeds, box);
  for (std::size_t d = 0; d < stage.drives.size(); ++d) {
    const auto share = frame_.template shares<Dim>(stage.drives[d].part);
    for (std::size_t w = 0; w < box.walls.size(); ++w)
      // from 0: a wall that rests has no negative zeros
      if (share[w] != 0) box.walls[w].velocity = Vec<Dim>{} + (share[w] * speeds[d]) * box.walls[w].normal;
    if (stage.drives[d].control == Control::stress && !moves_cell(stage.drives[d], box))
      box.presses.push_back(press_of(stage.drives[d], box, model, time, dt));
  }
}

template <int Dim>
void LoadingOf<Dim>::after_step(const Box<Dim>& box, double time, double dt, const StepFelt& felt) {
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
    note_past();
    note_unreached();
    leave_stage(stage_ + 1, box, time, dt);
  } else if (is_at_limit(box) ||
             has_gone_to_limit(stage_now(), frame_, length_at_stage_, time - stage_start_)) {
    ended_ = End::limit;
  }
}

/// The mean lags behind a stress that changes evenly, and its own mean lags behind it as far; where the walls
/// rest there is no lag to make up for.
template <int Dim>
double LoadingOf<Dim>::present_stress(std::size_t part) const {
  const int component = component_of(static_cast<Part>(part));
  return closing_[component] != 0 ? 2 * stress_[part] - stress_twice_[part] : stress_[part];
}

template <int Dim>
void LoadingOf<Dim>::watch(const Box<Dim>& box, double dt) {
  const double share = std::min(1.0, frame_.wall_velocity * dt / box.height() / averaging_strain);
  const auto on = [&](std::size_t wall) { return box.outward_impulse(wall); };
  const double below = dt * box.face(Dim - 1), beside = dt * box.face(Dim - 2);
  double last = 0;  // xy, in space xx
  if (Dim == 3)
    last = (on(4) + on(5)) / (2 * dt * box.face(0));
  else if (box.cell.any())
    last = -box.moment(0, 1) / (dt * box.volume());
  const OfParts stress{(on(0) + on(1)) / (2 * below),
                       (on(2) + on(3)) / (2 * beside),
                       on(0) / below,
                       on(1) / below,
                       on(2) / beside,
                       on(3) / beside,
                       last};
  for (std::size_t p = 0; p < parts_with_stress; ++p) {
    stress_[p] += share * (stress[p] - stress_[p]);
    stress_twice_[p] += share * (stress_[p] - stress_twice_[p]);
    largest_[p] = std::max(largest_[p], present_stress(p));
  }
}

template <int Dim>
void LoadingOf<Dim>::judge_presses(const Box<Dim>& box, double time, double dt) {
  const std::int64_t done = steps_in(time - stage_start_, dt) - 1;
  const std::int64_t steps = planned_[stage_].steps(dt);
  const Stage& stage = stage_now();
  for (std::size_t d = 0; d < stage.drives.size(); ++d) {
    const Drive& drive = stage.drives[d];
    if (drive.control != Control::stress || done < 0) continue;
    if (const double target = drive.target(time - stage_start_); target != 0)
      held_[d].add(impulse_of(drive, box) / dt / pressed_length(drive, box) / target, done, steps);
  }
}

template <int Dim>
void LoadingOf<Dim>::leave_stage(std::size_t next, const Box<Dim>& box, double time, double dt) {
  note_unkept();
  progress_at_stage_ = progress(time, dt);
  do ++stage_;
  while (stage_ < stages_.size() && (stage_ < next || (stages_[stage_].only_by_exit && !kept_last_)));
  if (stage_ < stages_.size()) begin_stage(box, time);
}

template <int Dim>
void LoadingOf<Dim>::begin_stage(const Box<Dim>& box, double time) {
  ++number_;
  stage_start_ = time;
  stress_at_stage_ = stress_;
  for (int c = 0; c < 3; ++c) length_at_stage_[c] = length(box, c);
  if (!motion_.velocity) plan_rest();
  held_ = {};
  const OfParts speed = press_speed_, mean_speed = press_mean_speed_, force = press_force_,
                waiting = press_waiting_;
  press_speed_ = press_mean_speed_ = press_force_ = press_waiting_ = {};
  for (const Drive& drive : stage_now().drives) {
    if (drive.control != Control::stress) continue;
    const std::size_t part = number_of(drive.part);
    press_speed_[part] = speed[part];  // others begin at rest
    press_mean_speed_[part] = mean_speed[part];
    press_waiting_[part] = waiting[part];
    press_force_[part] = force[part];
  }
}

template class LoadingOf<2>;
template class LoadingOf<3>;

}  // namespace softgrain
