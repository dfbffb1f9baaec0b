#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/experiment/stages_of_case.hpp"

// How fast the stages of a case move walls.

namespace softgrain {
namespace {

/// m/s of walls that a drive moves at their fastest.
double speed_of(const Drive& drive, double length) {
  switch (drive.control) {
    case Control::velocity:
      return std::abs(drive.value);
    case Control::rate:
      return std::abs(drive.value) * length;
    case Control::stress:
      return drive.speed;
    case Control::strain:
      return drive.period > 0 ? 2 * std::numbers::pi * drive.amplitude / drive.period * length : 0;
    case Control::rest:
      break;
  }
  return 0;
}

/// Length of a box of this height [m] along which a part moves its walls; of xy the height, across which it
/// shears.
double length_along(const Case& c, Part part, double height) {
  const LoadingFrame frame = frame_of(c);
  switch (component_of(part)) {
    case 1:
      return frame.aspect_y * height;
    case 2:
      return (is_in_space(c) ? frame.aspect : 1) * height;
    default:
      return height;
  }
}

}  // namespace

double fastest_speed(const Case& c, double height) {
  double fastest = 0;
  for (const Stage& stage : c.stages)
    for (const Drive& drive : stage.drives)
      fastest = std::max(fastest, speed_of(drive, length_along(c, drive.part, height)));
  return fastest;
}

double fastest_rate(const Case& c, double height) {
  double fastest = 0;
  for (const Stage& stage : stages_of(c)) {
    const bool moves = std::any_of(stage.drives.begin(), stage.drives.end(), [](const Drive& drive) {
      return drive.control != Control::stress && drive.control != Control::rest;
    });
    for (const Drive& drive : stage.drives) {
      if (drive.control == Control::stress && moves) continue;  // it follows the others
      const double length = length_along(c, drive.part, height);
      const double speed = drive.control == Control::stress && drive.speed == 0 ? c.loading.wall_velocity
                                                                                : speed_of(drive, length);
      fastest = std::max(fastest, speed / length);
    }
  }
  return fastest;
}

}  // namespace softgrain
