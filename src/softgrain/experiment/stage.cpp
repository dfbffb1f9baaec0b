#include "softgrain/experiment/stage.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {

double StrainMeasure::travel(double strain) const {
  return kind == Kind::of_grain ? length * (1 - std::exp(-strain)) : -length * std::expm1(-strain);
}

double StrainMeasure::strain(double start, double now) const {
  return kind == Kind::of_grain ? -std::log1p(-(start - now) / length) : std::log(start / now);
}

StrainMeasure strain_measure(const Case& c, double height) {
  if (is_in_a_box(c)) return {StrainMeasure::Kind::of_box, height};
  return {StrainMeasure::Kind::of_grain, 2 * c.grain.radius};
}

double last_strain(const Case& c) {
  if (c.loading.max_packing_fraction == 0 || !is_in_a_box(c)) return c.loading.max_strain;
  const double filled = std::log(c.loading.max_packing_fraction / c.sample.packing_fraction);
  return std::min(c.loading.max_strain, filled / (is_isotropic(c) ? 2 : 1));
}

LoadingEnds ends_of(const Case& c) {
  const Case::Loading& loading = c.loading;
  if (!is_in_a_box(c)) return {};
  return {.max_stress = loading.max_stress,
          .max_overlap = loading.max_overlap,
          .hold_stress = loading.hold_stress,
          .hold = loading.hold,
          .speed = loading.wall_velocity};
}

void check_loading(const Case& c) {
  const Case::Loading& loading = c.loading;
  require(loading.wall_velocity > 0, "loading.wall_velocity must be > 0, got {} m/s", loading.wall_velocity);
  require(loading.max_strain > 0, "loading.max_strain must be > 0, got {}", loading.max_strain);
  require(loading.hold >= 0, "loading.hold must be >= 0, got {} s", loading.hold);
  require(loading.hold_stress == 0 || loading.hold > 0,
          "loading.hold_stress {} Pa needs loading.hold > 0: for how long", loading.hold_stress);
  double strain = 0;
  for (const double turn : loading.unload_at) {
    require(turn > strain && turn < loading.max_strain && loading.unload_by > 0 && loading.unload_by < turn,
            "loading.unload_at must rise and stay below loading.max_strain {}, with 0 < loading.unload_by {} "
            "< each; got {}",
            loading.max_strain, loading.unload_by, turn);
    strain = turn - loading.unload_by;
  }
}

std::vector<Stage> stages_of(const Case& c) {
  const Case::Loading& loading = c.loading;
  Stage stage;
  if (const double aspect = c.sample.aspect; is_isotropic(c))
    stage.share = {0.5, 0.5, 0.5 * aspect, 0.5 * aspect};
  std::vector<Stage> stages;
  double strain = 0;
  const auto go_to = [&](double target) {
    stage.speed = target > strain ? loading.wall_velocity : -loading.wall_velocity;
    stage.strain = strain = target;
    stages.push_back(stage);
    if (loading.hold > 0) stages.push_back({.share = stage.share, .duration = loading.hold});
  };
  const double last = last_strain(c);
  for (const double turn : loading.unload_at) {
    if (turn >= last) break;
    go_to(turn);
    go_to(turn - loading.unload_by);
  }
  go_to(last);
  return stages;
}

}  // namespace softgrain
