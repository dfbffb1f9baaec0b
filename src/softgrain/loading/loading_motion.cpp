#include <algorithm>
#include <cmath>
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/loading/loading.hpp"

namespace softgrain {
namespace {

/// The force on a cell is that of the step before: it must not answer within a few steps.
constexpr double steps_behind = 30;

/// Times the speed of the loading at which walls come in at most for a stress that they do not bear yet,
/// where others move.
constexpr double beside_motion = 50;

/// Of its stress: a press that bears so much has met the grains.
constexpr double bears = 0.5;

/// Of the time tau of a press, beside walls that others move: there its own mass and damper are what its
/// stress errs by (docs/decisions/0082).
constexpr double membrane_share = 0.02;
/// Of a step: a lighter press takes NLGS more sweeps.
constexpr double membrane_share_of_step = 1.0 / 30;

/// Of the way of a stage: less is no step more.
constexpr double rounding = 1e-9;

/// k as before, tau a fiftieth of before, or a thirtieth of a step if that is more: hardly more than a
/// membrane.
PressBody membrane(const PressBody& body, double dt) {
  const double tau = 2 * body.mass / body.damper;
  const double share = std::max(membrane_share, membrane_share_of_step * dt / tau);
  return {.mass = share * share * body.mass, .damper = share * body.damper};
}

template <int Dim>
double side_of_wall(const Box<Dim>& box, std::size_t wall) {
  return box.face(Dim - 1 - static_cast<int>(wall / 2));
}

}  // namespace

template <int Dim>
bool LoadingOf<Dim>::moves_cell(const Drive& drive, const Box<Dim>& box) const {
  return (Dim == 2 && drive.part == Part::xy) || box.repeats(axis_in<Dim>(drive.part));
}

/// At which these parts move the cell: no contact moves it within a step.
template <int Dim>
void LoadingOf<Dim>::move_cell(const Stage& stage, const Speeds& speeds, Box<Dim>& box) const {
  PeriodicCell<Dim>& cell = box.cell;
  std::array<double, 3> closing{};
  for (std::size_t d = 0; d < stage.drives.size(); ++d)
    for (int c = 0; c < 3; ++c) closing[c] += frame_.closing_share(stage.drives[d].part, c) * speeds[d];
  for (int axis = 0; axis < Dim; ++axis)
    if (box.repeats(axis)) cell.rate(axis, axis) = 0 - closing[static_cast<std::size_t>(Dim - 1 - axis)];
  if (Dim == 2)
    cell.rate(0, 1) = cell.rate(0, 0) / cell.edges(0, 0) * cell.edges(0, 1) + closing[2] * cell.edges(1, 1);
}

/// sum_w share_w l_w [m]: what a stress presses on.
template <int Dim>
double LoadingOf<Dim>::pressed_length(const Drive& drive, const Box<Dim>& box) const {
  if (Dim == 2 && drive.part == Part::xy) return box.width();
  const auto share = frame_.template shares<Dim>(drive.part);
  double length = 0;
  for (std::size_t w = 0; w < box.faces(); ++w)
    if (share[w] != 0) length += share[w] * side_of_wall(box, w);
  return length;
}

/// sum_w share_w p_w of the last step [N s/m]; of xy the impulse along x on what lies higher.
template <int Dim>
double LoadingOf<Dim>::impulse_of(const Drive& drive, const Box<Dim>& box) const {
  if (Dim == 2 && drive.part == Part::xy) return -box.moment(0, 1) / box.height();
  const auto share = frame_.template shares<Dim>(drive.part);
  double impulse = 0;
  for (std::size_t w = 0; w < box.faces(); ++w)
    if (share[w] != 0) impulse += share[w] * box.outward_impulse(w);
  return impulse;
}

/// The cell as a press, with the impulses of the last step (docs/decisions/0043).
template <int Dim>
double LoadingOf<Dim>::push_cell(const Drive& drive, const Box<Dim>& box, const ModelOf<Dim>& model,
                                 double time, double dt) {
  const double unit = drive.part == Part::xy ? box.height() : 1;  // of a speed
  Press press = press_of(drive, box, model, time, dt);
  const double impulse = impulse_of(drive, box);
  const double v = std::clamp(press.free_speed(dt) - press.mobility(dt) * impulse, -press.most, press.most);
  press.end_step(v, impulse, dt);
  keep_press(drive, press);
  return v / unit;
}

template <int Dim>
typename LoadingOf<Dim>::Speeds LoadingOf<Dim>::speeds_of(const Stage& stage, const Box<Dim>& box,
                                                          double time, double dt) const {
  Speeds speeds{};
  for (std::size_t d = 0; d < stage.drives.size(); ++d) {
    const Drive& drive = stage.drives[d];
    const int component = component_of(drive.part);
    if (drive.control == Control::velocity) speeds[d] = drive.value;
    if (drive.control == Control::rate)
      speeds[d] = drive.value * (frame_.is_shear(component) ? 1 : length(box, component));
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
template <int Dim>
double LoadingOf<Dim>::speed_to_strain(const Drive& drive, const Box<Dim>& box, double time,
                                       double dt) const {
  const int component = component_of(drive.part);
  const double wave = wave_at(drive.wave, time + dt - stage_start_, drive.period);
  const double start = length_at_stage_[component];
  const double aim =
      frame_.is_shear(component) ? start - drive.amplitude * wave : start * std::exp(-drive.amplitude * wave);
  return (length(box, component) - aim) / dt;
}

/// Of the walls that are given a velocity.
template <int Dim>
double LoadingOf<Dim>::closing_speed(const Stage& stage, const Speeds& speeds, int component) const {
  double closing = 0;
  for (std::size_t d = 0; d < stage.drives.size(); ++d)
    if (stage.drives[d].is_given())
      closing += frame_.closing_share(stage.drives[d].part, component) * speeds[d];
  return closing;
}

/// In the last step of a stage walls make what is left of their way to its strain.
template <int Dim>
void LoadingOf<Dim>::end_at_strain(const Stage& stage, const Box<Dim>& box, Speeds& speeds, double dt) {
  for (int c = 0; c < 3; ++c) {
    if (!stage.until.strain[c] || closing_[c] == 0) continue;
    const bool alone = std::all_of(stage.drives.begin(), stage.drives.end(), [&](const Drive& drive) {
      return drive.is_given() || frame_.closing_share(drive.part, c) == 0 || drive.control == Control::rest;
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

template <int Dim>
Press LoadingOf<Dim>::press_of(const Drive& drive, const Box<Dim>& box, const ModelOf<Dim>& model,
                               double time, double dt) const {
  const auto share = frame_.template shares<Dim>(drive.part);
  const bool of_cell = moves_cell(drive, box);
  const double pressed = pressed_length(drive, box);
  PressBody body = model.press_body(box, axis_in<Dim>(drive.part), (of_cell ? steps_behind : 1) * dt);
  const std::size_t part = number_of(drive.part);
  const Stage& stage = stage_now();
  const bool alone = std::none_of(stage.drives.begin(), stage.drives.end(), [](const Drive& other) {
    return (other.is_given() && other.value != 0) || other.control == Control::strain;
  });
  const double force = drive.target(time + dt - stage_start_) * pressed;
  double most = frame_.wall_velocity * (alone ? 1 : beside_motion);
  if (!alone && !of_cell) {
    body = membrane(body, dt);
    // it goes where the grains go that it has met
    if (press_force_[part] >= bears * force) most = std::numeric_limits<double>::infinity();
  }
  std::array<double, 6> of_walls{};
  std::copy(share.begin(), share.end(), of_walls.begin());
  return {.share = of_walls,
          .force = force,
          .mass = body.mass * pressed,
          .damper = body.damper * pressed,
          .most = drive.speed > 0 ? drive.speed : most,
          .speed = press_speed_[part],
          .mean_force = press_force_[part],
          .mean_speed = press_mean_speed_[part],
          .waiting = press_waiting_[part]};
}

template <int Dim>
void LoadingOf<Dim>::keep_press(const Drive& drive, const Press& press) {
  const std::size_t part = number_of(drive.part);
  press_speed_[part] = press.speed;
  press_mean_speed_[part] = press.mean_speed;
  press_force_[part] = press.mean_force;
  press_waiting_[part] = press.waiting;
}

template <int Dim>
void LoadingOf<Dim>::keep_presses(const Box<Dim>& box) {
  if (stage_ >= stages_.size()) return;
  std::size_t press = 0;
  for (const Drive& drive : stage_now().drives)
    if (drive.control == Control::stress && !moves_cell(drive, box) && press < box.presses.size())
      keep_press(drive, box.presses[press++]);
}

template class LoadingOf<2>;
template class LoadingOf<3>;

}  // namespace softgrain
