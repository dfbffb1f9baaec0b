#include "softgrain/experiment/plate_legs.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

/// The fewest steps, at least one, in which a way of so many is made; less than a rounding is no step more.
std::int64_t whole_steps(double way) {
  constexpr double rounding = 1e-9;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(way * (1 - rounding))));
}

}  // namespace

PlateLegs::PlateLegs(const Case::Loading& loading, double dt, double last_strain,
                     const std::function<double(double)>& travel)
    : speed_(loading.wall_velocity), dt_(dt) {
  require(loading.wall_velocity > 0, "loading.wall_velocity must be > 0, got {} m/s", loading.wall_velocity);
  require(loading.max_strain > 0, "loading.max_strain must be > 0, got {}", loading.max_strain);
  require(loading.hold >= 0, "loading.hold must be >= 0, got {} s", loading.hold);
  double strain = 0;
  std::int64_t step = 0;
  const auto go_to = [&](double target) {
    const double distance = travel(target) - travel(strain);
    step += whole_steps(std::abs(distance) / (loading.wall_velocity * dt));
    legs_.push_back({step, travel(target), distance > 0 ? 1 : -1});
    strain = target;
    if (loading.hold == 0) return;
    step += std::max<std::int64_t>(1, std::llround(loading.hold / dt));
    legs_.push_back({step, travel(target), 0});
  };
  for (const double turn : loading.unload_at) {
    require(turn > strain && turn < loading.max_strain && loading.unload_by > 0 && loading.unload_by < turn,
            "loading.unload_at must rise and stay below loading.max_strain {}, with 0 < loading.unload_by {} "
            "< each; got {}",
            loading.max_strain, loading.unload_by, turn);
    if (turn >= last_strain) break;
    go_to(turn);
    go_to(turn - loading.unload_by);
  }
  go_to(last_strain);
}

int PlateLegs::leg(std::int64_t step) const {
  const auto after = std::upper_bound(legs_.begin(), legs_.end(), step,
                                      [](std::int64_t value, const Leg& leg) { return value < leg.end; });
  return static_cast<int>(std::min(after, legs_.end() - 1) - legs_.begin());
}

double PlateLegs::velocity(std::int64_t step, double travel) const {
  const Leg& now = legs_[leg(step)];
  if (now.direction == 0) return 0;
  return step == now.end - 1 ? (travel - now.travel) / dt_ : -now.direction * speed_;
}

}  // namespace softgrain
