#include "softgrain/experiment/advice.hpp"

#include <algorithm>
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

/// <a0> of one grain [m]: primaries of equal size that fill pi R^2 at a packing fraction of 0.84, in space
/// 4/3 pi R^3 at 0.65.
double mean_distance(const Case& c) {
  return 2 * c.grain.radius *
         (is_in_space(c) ? std::cbrt(0.65 / c.bpm.primaries) : std::sqrt(0.84 / c.bpm.primaries));
}

/// sigma_I [Pa] of bonded grains.
double bond_stress(const Case& c) {
  if (is_in_a_box(c)) return c.bpm.cohesive_pressure;
  return is_in_space(c) ? cohesive_pressure<3>(c.bpm.force, mean_distance(c))
                        : cohesive_pressure<2>(c.bpm.attraction, mean_distance(c));
}

bool flows(const Case& c) { return is_elastic(c) && law_choice(c.mpm.law).flows(); }

/// At which grains deform as a whole [Pa].
double own_stress(const Case& c) {
  if (!c.kinds.empty()) return least_of_kinds(c, own_stress);
  if (flows(c)) return c.mpm.material.yield_stress;
  if (is_elastic(c)) return c.mpm.material.young_modulus;
  if (is_rigid(c)) return std::numeric_limits<double>::infinity();
  return bond_stress(c);
}

/// Of a grain's own, at which a packing whose case names no stress is judged: a little above jamming.
constexpr double packing_share = 0.01;

double stress_of(const Case& c) {
  if (!is_in_a_box(c)) return own_stress(c);
  if (c.loading.hold_stress > 0) return c.loading.hold_stress;
  if (c.loading.max_stress > 0) return c.loading.max_stress;
  if (const double named = largest_named_stress(c); named > 0) return named;
  return packing_share * own_stress(c);
}

double blow_of(const Case& c) {
  if (!c.kinds.empty()) return largest_of_kinds(c, blow_of);
  if (!flows(c)) return 0;
  const double c_wave = wave_speed(make_law(c.mpm.law, c.mpm.material), c.grain.density);
  return c.grain.density * c_wave * c.loading.wall_velocity / c.mpm.material.yield_stress;
}

double imbalance_of(const Case& c) {
  if (!c.kinds.empty()) return largest_of_kinds(c, imbalance_of);
  if (!flows(c) || c.mpm.integrator != Integrator::backward_euler) return 0;
  return c.mpm.tolerance * c.mpm.material.young_modulus / c.mpm.material.yield_stress;
}

/// c [m/s], of bonded grains as stiff as their bonds, 10 sigma_I; 0 of rigid ones.
double wave_of(const Case& c) {
  if (!c.kinds.empty()) return largest_of_kinds(c, wave_of);
  if (is_rigid(c)) return 0;
  if (!is_elastic(c)) return std::sqrt(10 * bond_stress(c) / c.grain.density);
  return wave_speed(make_law(c.mpm.law, c.mpm.material), c.grain.density);
}

double diameter_of(const Case& c) {
  if (!is_in_a_box(c)) return 2 * c.grain.radius;
  return sum_of_kinds(
             c,
             [](const Case& kind) { return kind.sample.grains * mean_diameter(diameter_law(kind.sample)); }) /
         c.sample.grains;
}

/// Height of the box, or of the grain between walls, at the start [m].
double height_of(const Case& c) { return is_in_a_box(c) ? box_height(c) : 2 * c.grain.radius; }

double hold_of(const Case& c) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Stage& stage : stages_of(c))
    if (stage.until.time && std::any_of(stage.drives.begin(), stage.drives.end(),
                                        [](const Drive& drive) { return drive.control == Control::stress; }))
      shortest = std::min(shortest, *stage.until.time);
  const double wave = wave_of(c);
  return wave > 0 ? shortest * wave / height_of(c) : std::numeric_limits<double>::infinity();
}

double density_of(const Case& c) {
  return largest_of_kinds(c, [](const Case& kind) { return kind.grain.density; });
}

/// d sqrt(rho/p) [s]: I over the rate. 0 of rigid grains that no stress presses.
double inertial_time(const Case& c) { return diameter_of(c) * std::sqrt(density_of(c) / stress_of(c)); }

}  // namespace

double quasi_static_rate(const Case& c) { return c.loading.inertial_number / inertial_time(c); }

bool set_quasi_static_speeds(Case& c) {
  const bool known = std::isfinite(quasi_static_rate(c));
  const double rate = known ? quasi_static_rate(c) : 1;
  const bool shears = c.experiment.loading == LoadingPath::shear && c.stages.empty();
  const auto set = [&](double& value, double quasi_static) {
    value = quasi_static;
    c.loading.quasi_static = true;
  };
  for (Stage& stage : c.stages)
    for (Drive& drive : stage.drives)
      if (drive.quasi_static) set(drive.value, rate);
  if (shears && c.loading.shear_rate == 0) set(c.loading.shear_rate, rate);
  if (c.loading.wall_velocity == 0) set(c.loading.wall_velocity, rate * height_of(c));
  return known || !c.loading.quasi_static;
}

Advice advise(const Case& c) {
  Advice advice;
  advice.time_step = first_time_step(c);
  advice.longest_step = is_bonded(c) ? critical_bond_step(c) : longest_time_step(c);
  advice.stress = stress_of(c);
  const double rate = fastest_rate(c, height_of(c));
  if (std::isinf(advice.stress)) {  // of rigid grains that no stress presses: that of their inertia
    advice.stress = density_of(c) * c.loading.wall_velocity * c.loading.wall_velocity;
    advice.inertial_number = rate * diameter_of(c) / c.loading.wall_velocity;
  } else {
    advice.inertial_number = rate * inertial_time(c);
  }
  advice.blow = blow_of(c);
  if (const double wave = wave_of(c); wave > 0) advice.mach = c.loading.wall_velocity / wave;
  advice.imbalance = imbalance_of(c);
  advice.hold = hold_of(c);
  return advice;
}

}  // namespace softgrain
