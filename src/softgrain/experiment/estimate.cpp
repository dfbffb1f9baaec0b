#include "softgrain/experiment/estimate.hpp"

#include <cmath>
#include <numbers>

#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/compaction_path.hpp"
#include "softgrain/experiment/diametral_path.hpp"

namespace softgrain {
namespace {

bool is_diametral(const Case& c) { return c.experiment.loading == "diametral"; }
bool is_updated_lagrangian(const Case& c) { return c.mpm.formulation == "updated_lagrangian"; }
bool is_implicit(const Case& c) { return c.mpm.integrator == "implicit" && !is_updated_lagrangian(c); }
double grains(const Case& c) { return is_diametral(c) ? 1 : c.sample.grains; }
double smallest_radius(const Case& c) {
  return is_diametral(c) ? c.grain.radius : c.sample.smallest_diameter / 2;
}

/// Travel of the plate, there and back [m].
double travel(const Case& c) {
  const double mean_diameter = (c.sample.smallest_diameter + c.sample.largest_diameter) / 2;
  const double grain_area = std::numbers::pi / 4 * mean_diameter * mean_diameter;
  const double height = std::sqrt(grains(c) * grain_area / c.sample.packing_fraction / c.sample.aspect);
  const auto travel_to = [&](double strain) {
    return is_diametral(c) ? plate_travel(strain, c.grain.radius) : -height * std::expm1(-strain);
  };
  const double last = is_diametral(c)
                          ? c.loading.max_strain
                          : CompactionPath::last_strain(c.loading, c.sample.packing_fraction,
                                                        c.experiment.loading == "isotropic" ? 2 : 1);
  double path = travel_to(last);
  for (const double turn : c.loading.unload_at)
    if (turn < last) path += 2 * (travel_to(turn) - travel_to(turn - c.loading.unload_by));
  return path;
}

/// Time in which the plate rests [s].
double rest(const Case& c) {
  return c.loading.hold * (1 + 2 * static_cast<double>(c.loading.unload_at.size()));
}

/// Primaries of all grains.
double primaries(const Case& c) {
  if (is_diametral(c) || c.bpm.equal == "count") return grains(c) * c.bpm.primaries;
  // mean of (R / R_min)^2 over radii spread evenly
  const double ratio = c.sample.largest_diameter / c.sample.smallest_diameter;
  return grains(c) * c.bpm.primaries * (1 + ratio + ratio * ratio) / 3;
}

double time_step(const Case& c) {
  if (c.experiment.model == "bpm") return c.time.step > 0 ? c.time.step : stable_bond_step(c);
  if (c.mpm.time_step > 0) return c.mpm.time_step;
  if (is_implicit(c)) return 0.01 * smallest_radius(c) / c.loading.wall_velocity;
  // a share of the time in which a pressure wave crosses a cell; pi R^2 = 3.5 cells^2 h^2
  const double nu = c.mpm.poisson_ratio;
  const double modulus = c.mpm.young_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  const double cell = smallest_radius(c) * std::sqrt(std::numbers::pi / 3.5) / c.mpm.cells;
  return (is_updated_lagrangian(c) ? 0.2 : 0.26) * cell / std::sqrt(modulus / c.grain.density);
}

/// CPU time of a step [s], as measured on one core of a server of 2024 (docs/performance.md).
double seconds_of_step(const Case& c, const Estimate& e) {
  constexpr int usual_sweeps = 17;
  const int sweeps =
      std::clamp(usual_sweeps, c.solver.min_sweeps, std::max(c.solver.min_sweeps, c.solver.max_sweeps));
  if (c.experiment.model == "bpm")
    return e.contacts * sweeps * (c.solver.precision == "single" ? 4.1e-9 : 5.5e-9);
  if (is_updated_lagrangian(c)) return e.particles * 1.1e-7;
  const double batches = std::ceil(grains(c) / 8);  // a batch of 8 grains costs the same when it is not full
  return batches * 8 * e.particles / grains(c) * (is_implicit(c) ? 2.7e-7 : 5.5e-9);
}

/// Snapshots and ParaView's files of a whole run [bytes], as measured by primary and by material point.
double disk(const Case& c, double particles) {
  const double frames = c.output.snapshots + 1 + 2 * static_cast<double>(c.loading.unload_at.size());
  const double bytes_of_particle = (c.experiment.model == "bpm" ? 280 : 150) + (c.output.vtk ? 75 : 0);
  return frames * (20e3 + bytes_of_particle * particles);
}

}  // namespace

Estimate estimate(const Case& the_case) {
  constexpr double second = 1.0 / 3600;  // [h]
  const bool bpm = the_case.experiment.model == "bpm";
  const double cells = the_case.mpm.cells;
  Estimate result;
  result.particles = bpm ? primaries(the_case) : grains(the_case) * 14 * cells * cells;
  result.contacts = bpm ? 2.2 * result.particles : grains(the_case) * 3.3 * cells;
  result.steps =
      std::round((travel(the_case) / the_case.loading.wall_velocity + rest(the_case)) / time_step(the_case));
  result.memory = 50e6 + 1000 * result.particles + 200 * result.contacts;
  result.disk = disk(the_case, result.particles);
  result.hours = result.steps * seconds_of_step(the_case, result) * second;
  return result;
}

}  // namespace softgrain
