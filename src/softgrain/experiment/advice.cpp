#include "softgrain/experiment/advice.hpp"

#include <cmath>
#include <limits>

#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/experiment/stages_of_case.hpp"
#include "softgrain/material/any_law.hpp"

namespace softgrain {
namespace {

/// <a0> of one grain [m]: primaries of equal size that fill pi R^2 at a packing fraction of 0.84.
double mean_distance(const Case& c) { return 2 * c.grain.radius * std::sqrt(0.84 / c.bpm.primaries); }

bool flows(const Case& c) { return is_elastic(c) && law_choice(c.mpm.law).flows(); }

double stress_of(const Case& c) {
  if (!c.kinds.empty()) return least_of_kinds(c, stress_of);
  if (is_in_a_box(c) && c.loading.hold_stress > 0) return c.loading.hold_stress;
  if (is_in_a_box(c) && c.loading.max_stress > 0) return c.loading.max_stress;
  if (const double named = largest_named_stress(c); is_in_a_box(c) && named > 0) return named;
  if (flows(c)) return c.mpm.material.yield_stress;
  if (is_elastic(c)) return c.mpm.material.young_modulus;
  if (is_rigid(c)) return std::numeric_limits<double>::infinity();
  return !is_in_a_box(c) ? c.bpm.attraction / mean_distance(c) : c.bpm.cohesive_pressure;
}

double blow_of(const Case& c) {
  if (!c.kinds.empty()) return largest_of_kinds(c, blow_of);
  if (!flows(c)) return 0;
  const double c_wave = wave_speed(make_law(c.mpm.law, c.mpm.material), c.grain.density);
  return c.grain.density * c_wave * c.loading.wall_velocity / c.mpm.material.yield_stress;
}

/// |d eps/dt| d at the start [m/s].
double rate_times_diameter(const Case& c) {
  if (!is_in_a_box(c)) return c.loading.wall_velocity;  // v/(2 R) 2 R
  const double diameter =
      sum_of_kinds(
          c, [](const Case& kind) { return kind.sample.grains * mean_diameter(diameter_law(kind.sample)); }) /
      c.sample.grains;
  return c.loading.wall_velocity / box_height(c) * diameter;
}

}  // namespace

Advice advise(const Case& c) {
  Advice advice;
  advice.time_step = first_time_step(c);
  advice.longest_step = is_bonded(c) ? critical_bond_step(c) : longest_time_step(c);
  const double density = largest_of_kinds(c, [](const Case& kind) { return kind.grain.density; });
  advice.stress = stress_of(c);
  if (std::isinf(advice.stress))  // of rigid grains that no stress presses: that of their inertia
    advice.stress = density * c.loading.wall_velocity * c.loading.wall_velocity;
  advice.inertial_number = rate_times_diameter(c) * std::sqrt(density / advice.stress);
  advice.blow = blow_of(c);
  return advice;
}

}  // namespace softgrain
