#include "softgrain/experiment/plate_legs.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {

PlateLegs::PlateLegs(const Case::Loading& loading, double dt, double last_strain,
                     const std::function<double(double)>& travel) {
  require(loading.wall_velocity > 0, "loading.wall_velocity must be > 0, got {} m/s", loading.wall_velocity);
  require(loading.max_strain > 0, "loading.max_strain must be > 0, got {}", loading.max_strain);
  require(loading.hold >= 0, "loading.hold must be >= 0, got {} s", loading.hold);
  double strain = 0;
  std::int64_t step = 0;
  const auto go_to = [&](double target) {
    const double distance = travel(target) - travel(strain);
    step += std::max<std::int64_t>(1, std::llround(std::abs(distance) / (loading.wall_velocity * dt)));
    legs_.push_back({step, distance > 0 ? -loading.wall_velocity : loading.wall_velocity});
    strain = target;
    if (loading.hold == 0) return;
    step += std::max<std::int64_t>(1, std::llround(loading.hold / dt));
    legs_.push_back({step, 0});
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

}  // namespace softgrain
