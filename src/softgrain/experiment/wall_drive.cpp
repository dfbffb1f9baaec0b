#include "softgrain/experiment/wall_drive.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
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

double WallDrive::plate_velocity(std::int64_t step) const {
  if (!holds()) return path_->plate_velocity(step);
  const double lack = (loading_.hold_stress - state.stress) / loading_.hold_stress;
  return -loading_.wall_velocity * std::clamp(lack, -1.0, 1.0);
}

Vec<2> WallDrive::velocity(const Wall<2>& wall, int index, std::int64_t step) const {
  // from 0: a wall that rests has no negative zeros
  return Vec<2>{} - (path_->shares()[index] * plate_velocity(step)) * wall.normal;
}

void WallDrive::watch(double stress, double height, std::int64_t steps_done) {
  const double strain = loading_.wall_velocity * dt_ / height;
  state.stress += std::min(1.0, strain / averaging_strain) * (stress - state.stress);
  if (loading_.max_stress > 0 && state.stress >= loading_.max_stress) state.ended = true;
  const bool comes_down = path_->plate_velocity(steps_done - 1) < 0;
  if (loading_.hold_stress > 0 && !holds() && comes_down && state.stress >= loading_.hold_stress)
    state.hold_start = steps_done;
}

std::string WallDrive::early_end(std::int64_t step) const {
  if (!finished(step)) return "";
  if (loading_.max_stress > 0 && state.stress >= loading_.max_stress) return "loading.max_stress is reached";
  return holds() && step >= end() ? "loading.hold_stress was kept for loading.hold" : "";
}

void WallDrive::save_hold(Checkpoint& checkpoint) const {
  if (holds()) checkpoint.arrays["hold_start"] = {1, std::vector<std::int64_t>{state.hold_start}};
}

void WallDrive::restore_hold(const Checkpoint& checkpoint) {
  const auto found = checkpoint.arrays.find("hold_start");
  state.hold_start = -1;
  if (found == checkpoint.arrays.end()) return;
  const auto* steps = std::get_if<std::vector<std::int64_t>>(&found->second.values);
  if (steps == nullptr || steps->size() != 1)
    throw IoError("the checkpoint's array 'hold_start' is not one number");
  state.hold_start = steps->front();
}

}  // namespace softgrain
