#include "softgrain/experiment/diametral_path.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {

double plate_travel(double strain, double grain_radius) { return 2 * grain_radius * (1 - std::exp(-strain)); }

double grain_strain(double travel, double grain_radius) { return -std::log1p(-travel / (2 * grain_radius)); }

DiametralPath::DiametralPath(const Case::Loading& loading, double grain_radius, double dt)
    : radius_(grain_radius) {
  require(loading.wall_velocity > 0, "loading.wall_velocity must be > 0, got {} m/s", loading.wall_velocity);
  require(loading.max_strain > 0, "loading.max_strain must be > 0, got {}", loading.max_strain);
  double strain = 0;
  std::int64_t step = 0;
  const auto go_to = [&](double target) {
    const double distance = plate_travel(target, grain_radius) - plate_travel(strain, grain_radius);
    step += std::max<std::int64_t>(1, std::llround(std::abs(distance) / (loading.wall_velocity * dt)));
    legs_.push_back({step, distance > 0 ? -loading.wall_velocity : loading.wall_velocity});
    strain = target;
  };
  for (const double turn : loading.unload_at) {
    require(turn > strain && turn < loading.max_strain && loading.unload_by > 0 && loading.unload_by < turn,
            "loading.unload_at must rise and stay below loading.max_strain {}, with 0 < loading.unload_by {} "
            "< each; got {}",
            loading.max_strain, loading.unload_by, turn);
    go_to(turn);
    go_to(turn - loading.unload_by);
  }
  go_to(loading.max_strain);
}

int DiametralPath::leg(std::int64_t step) const {
  const auto after = std::upper_bound(legs_.begin(), legs_.end(), step,
                                      [](std::int64_t value, const Leg& leg) { return value < leg.end; });
  return static_cast<int>(std::min(after, legs_.end() - 1) - legs_.begin());
}

double DiametralPath::plate_velocity(std::int64_t step) const { return legs_[leg(step)].velocity; }

}  // namespace softgrain
