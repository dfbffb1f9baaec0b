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
  if (!holds()) return -path_->plate_velocity(step, travel);
  const double lack = (loading_.hold_stress - state.stress) / loading_.hold_stress;
  return loading_.wall_velocity * std::clamp(lack, -1.0, 1.0);
}

Vec<2> WallDrive::velocity(const Wall<2>& wall, int index, double approach_speed) const {
  // from 0: a wall that rests has no negative zeros
  return Vec<2>{} + (path_->shares()[index] * approach_speed) * wall.normal;
}

void WallDrive::watch(double stress, double height, std::int64_t steps_done) {
  const double strain = loading_.wall_velocity * dt_ / height;
  state.stress += std::min(1.0, strain / averaging_strain) * (stress - state.stress);
  state.largest = std::max(state.largest, state.stress);
  if (loading_.max_stress > 0 && state.stress >= loading_.max_stress) state.ended = End::max_stress;
  const bool comes_down = path_->approaches(steps_done - 1);
  if (loading_.hold_stress > 0 && !holds() && comes_down && state.stress >= loading_.hold_stress)
    state.hold_start = steps_done;
}

std::string WallDrive::early_end(std::int64_t step) const {
  if (!finished(step)) return "";
  if (state.ended == End::max_stress) return "loading.max_stress is reached";
  if (state.ended == End::max_overlap) return "loading.max_overlap is reached";
  return holds() && step >= end() ? "loading.hold_stress was kept for loading.hold" : "";
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
  return {};
}

void WallDrive::save(Checkpoint& checkpoint) const {
  checkpoint.arrays["drive"] = {1, std::vector<double>{state.largest}};
  if (holds()) checkpoint.arrays["hold_start"] = {1, std::vector<std::int64_t>{state.hold_start}};
}

void WallDrive::restore(const Checkpoint& checkpoint) {
  state.hold_start = -1;
  if (checkpoint.arrays.contains("drive")) {
    std::vector<Vec<1>> numbers(1);
    from_array<1>(checkpoint, "drive", numbers);
    state.largest = numbers[0][0];
  }
  const auto found = checkpoint.arrays.find("hold_start");
  if (found == checkpoint.arrays.end()) return;
  const auto* steps = std::get_if<std::vector<std::int64_t>>(&found->second.values);
  if (steps == nullptr || steps->size() != 1)
    throw IoError("the checkpoint's array 'hold_start' is not one number");
  state.hold_start = steps->front();
}

}  // namespace softgrain
