#include "softgrain/experiment/given_path.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {

GivenPath::GivenPath(std::shared_ptr<const PlatePath> own, PlateMotion motion, double dt)
    : own_(std::move(own)), motion_(std::move(motion)), dt_(dt) {
  require(std::isfinite(motion_.duration) && motion_.duration > 0,
          "the duration of a motion must be > 0, got {} s", motion_.duration);
  steps_ = std::max<std::int64_t>(1, std::llround(motion_.duration / dt));
}

double GivenPath::plate_velocity(std::int64_t step, double) const {
  if (step == asked_for_) return answer_;
  const double time = static_cast<double>(step) * dt_;
  answer_ = motion_.velocity(time);
  require(std::isfinite(answer_), "the motion asks for {} m/s at {} s", answer_, time);
  asked_for_ = step;
  return answer_;
}

}  // namespace softgrain
