#include "softgrain/experiment/wall_drive.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/arrays.hpp"
#include "softgrain/experiment/given_path.hpp"

namespace softgrain {
namespace {

/// Strain over which the stress is averaged.
constexpr double averaging_strain = 1e-3;

/// What a damper bears of the stress while grains creep is lent to the plates, up to this share of it, within
/// so many times the patience.
constexpr double lent_share = 0.2;
constexpr double lending_times = 10;

}  // namespace

WallDrive::WallDrive(const Case::Loading& loading, std::unique_ptr<PlatePath> path, double dt)
    : loading_(loading),
      path_(std::move(path)),
      dt_(dt),
      hold_steps_(std::max<std::int64_t>(1, std::llround(loading.hold / dt))) {
  require(loading.hold_stress == 0 || loading.hold > 0,
          "loading.hold_stress {} Pa needs loading.hold > 0: for how long", loading.hold_stress);
}

void WallDrive::follow(PlateMotion motion) {
  path_ = std::make_shared<GivenPath>(std::move(path_), std::move(motion), dt_);
}

int WallDrive::leg(std::int64_t step) const {
  return holds() && step >= state.hold_start ? path_->leg(state.hold_start - 1) + 1 : path_->leg(step);
}

double WallDrive::approach_speed(std::int64_t step, double travel) const {
  return holds() ? state.speed : -path_->plate_velocity(step, travel);
}

Vec<2> WallDrive::velocity(const Wall<2>& wall, int index, double approach_speed) const {
  // from 0: a wall that rests has no negative zeros
  return Vec<2>{} + (path_->shares()[index] * approach_speed) * wall.normal;
}

void WallDrive::begin_hold(std::int64_t step) {
  state.hold_start = step;
  state.speed = loading_.wall_velocity;
}

/// The mean lags behind a stress that rises evenly, and its own mean lags behind it as far; where the plates
/// rest there is no lag to make up for.
void WallDrive::watch(double stress, double height, std::int64_t steps_done) {
  const double share = std::min(1.0, loading_.wall_velocity * dt_ / height / averaging_strain);
  state.stress += share * (stress - state.stress);
  state.stress_twice += share * (state.stress - state.stress_twice);
  const double present =
      path_->approaches(steps_done - 1) ? 2 * state.stress - state.stress_twice : state.stress;
  state.largest = std::max(state.largest, present);
  if (loading_.max_stress > 0 && present >= loading_.max_stress) state.ended = End::max_stress;
  if (loading_.hold_stress == 0) return;
  if (!holds() && path_->approaches(steps_done - 1) && present >= loading_.hold_stress)
    begin_hold(steps_done);
  if (!holds()) return;
  if (steps_done > state.hold_start)
    state.held.add(stress / loading_.hold_stress, steps_done - 1 - state.hold_start, hold_steps_);
  if (plates.mass == 0) return;
  // the shocks of single steps leave most of it
  state.open +=
      stress < loading_.hold_stress / 2 ? dt_ : -state.open * std::min(1.0, 4 * dt_ / plates.patience);
  const double lack = loading_.hold_stress - stress, most = lent_share * loading_.hold_stress;
  state.lent = std::clamp(state.lent + lack * dt_ / (lending_times * plates.patience), -most, most);
  // m (v+ - v)/dt = sigma_h + s - sigma - Z v+/(1 + t/tau)
  const double damper = plates.damper / (1 + state.open / plates.patience);
  const double v = (plates.mass * state.speed + dt_ * (state.lent + lack)) / (plates.mass + dt_ * damper);
  state.speed = std::clamp(v, -loading_.wall_velocity, loading_.wall_velocity);
}

std::string HeldStress::text() const {
  return fmt::format("{:.3f} of it in the mean, {:.2g} of standard deviation, {:.3g} at most", mean(),
                     deviation(), largest);
}

std::string WallDrive::early_end(std::int64_t step) const {
  if (!finished(step)) return "";
  if (state.ended == End::max_stress) return "loading.max_stress is reached";
  if (state.ended == End::max_overlap) return "loading.max_overlap is reached";
  if (!holds() || step < end()) return "";
  return fmt::format("loading.hold_stress was {} for loading.hold: over the second half {}",
                     state.held.kept() ? "kept" : "asked for, but not kept,", state.held.text());
}

PathOutcome WallDrive::outcome(std::int64_t step) const {
  if (!finished(step)) return {};
  const auto not_reached = [&](const char* key, double stress) {
    return fmt::format("loading.{} of {:.3g} Pa was not reached: the largest stress was {:.3g} Pa", key,
                       stress, state.largest);
  };
  if (loading_.hold_stress > 0 && !holds())
    return {.completed = state.ended != End::none,
            .shortfall = not_reached("hold_stress", loading_.hold_stress) + ", so nothing was held"};
  if (loading_.max_stress > 0 && state.ended == End::none && !holds())
    return {.completed = true, .shortfall = not_reached("max_stress", loading_.max_stress)};
  if (holds() && step >= end() && !state.held.kept())
    return {.completed = false,
            .shortfall =
                "loading.hold_stress was not kept: over the second half of loading.hold the stress was " +
                state.held.text()};
  return {};
}

void WallDrive::save(Checkpoint& checkpoint) const {
  const HeldStress& held = state.held;
  checkpoint.arrays["drive"] = {
      1, std::vector<double>{state.largest, state.stress_twice, state.speed, held.windows, held.sum,
                             held.squares, held.largest, held.window, state.slope, state.open, state.lent}};
  if (holds()) checkpoint.arrays["hold_start"] = {1, std::vector<std::int64_t>{state.hold_start}};
}

void WallDrive::restore(const Checkpoint& checkpoint) {
  state.hold_start = -1;
  state.stress_twice = state.stress;
  if (checkpoint.arrays.contains("drive")) {
    std::vector<Vec<1>> numbers(11);
    from_array<1>(checkpoint, "drive", numbers, 1);
    state.largest = numbers[0][0];
    state.stress_twice = numbers[1][0];
    state.speed = numbers[2][0];
    state.held = {numbers[3][0], numbers[4][0], numbers[5][0], numbers[6][0], numbers[7][0]};
    state.slope = numbers[8][0];
    state.open = numbers[9][0];
    state.lent = numbers[10][0];
  }
  const auto found = checkpoint.arrays.find("hold_start");
  if (found == checkpoint.arrays.end()) return;
  const auto* steps = std::get_if<std::vector<std::int64_t>>(&found->second.values);
  if (steps == nullptr || steps->size() != 1)
    throw IoError("the checkpoint's array 'hold_start' is not one number");
  state.hold_start = steps->front();
}

}  // namespace softgrain
