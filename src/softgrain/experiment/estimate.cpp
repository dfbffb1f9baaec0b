#include "softgrain/experiment/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/lattice_case.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/experiment/shape_of_case.hpp"
#include "softgrain/experiment/stages_of_case.hpp"
#include "softgrain/material/any_law.hpp"
#include "softgrain/soft/reference_grid.hpp"

namespace softgrain {
namespace {

bool is_implicit(const Case& c) {
  return (is_lattice(c) ? c.mpm.lattice_integrator : c.mpm.integrator) == Integrator::backward_euler;
}
double grains(const Case& c) { return !is_in_a_box(c) ? 1 : c.sample.grains; }
double smallest_radius(const Case& c) {
  return !is_in_a_box(c) ? c.grain.radius : c.sample.smallest_diameter / 2;
}

/// rho c^2 of pressure waves in elastic grains [Pa]; 0 in rigid ones.
double wave_modulus(const Case& c) {
  if (is_rigid(c)) return 0;
  const double nu = c.mpm.material.poisson_ratio;
  return c.mpm.material.young_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
}

/// Of all grains, undeformed, in the mean [m^2]; in space their volume [m^3].
double grain_area(const Case& c) {
  if (is_in_space(c)) {
    if (!is_in_a_box(c)) return 4 * std::numbers::pi / 3 * std::pow(c.grain.radius, 3);
    if (!c.sample.placed.empty()) return c.sample.packing_fraction * c.box.width * c.box.depth * c.box.height;
    if (!c.kinds.empty()) return sum_of_kinds(c, grain_area);
    return c.sample.grains * std::numbers::pi / 6 * mean_cube_diameter(diameter_law(c.sample, 3));
  }
  if (!is_in_a_box(c)) return std::numbers::pi * c.grain.radius * c.grain.radius;
  if (!c.sample.placed.empty()) return c.sample.packing_fraction * c.box.width * c.box.height;
  if (!c.kinds.empty()) return sum_of_kinds(c, grain_area);
  const double a = c.sample.smallest_diameter, b = c.sample.largest_diameter;
  if (c.sample.sizes == SizeLaw::uniform)  // in the digits that snapshots have always had
    return c.sample.grains * std::numbers::pi / 12 * (a * a + a * b + b * b);
  return c.sample.grains * std::numbers::pi / 4 * mean_square_diameter(diameter_law(c.sample));
}

/// Of the circles of the grains of a kind [m^2], about: placed ones know only how many they are.
double area_of_kind(const Case& kind) {
  const double a = kind.sample.smallest_diameter, b = kind.sample.largest_diameter;
  return kind.sample.placed.empty() ? grain_area(kind) : kind.sample.grains * (a * a + a * b + b * b);
}

/// Of all stages [s].
double loading_time(const Case& c) {
  LoadingFrame frame = frame_of(c);
  const double height = box_height(c);
  if (is_in_a_box(c)) {
    frame.start = {height, frame.aspect_y * height, is_in_space(c) ? frame.aspect * height : 0};
    frame.measure.length = height;
  }
  double time = 0;
  for (const PlannedStage& stage : plan(without_repeats(stages_of(c)), frame, {})) time += stage.time;
  return time;
}

/// Primaries of all grains.
double primaries(const Case& c) {
  if (!c.kinds.empty()) return sum_of_kinds(c, primaries);
  if (is_rigid(c)) return grains(c);
  if (!is_in_a_box(c) || c.bpm.equal == EqualPrimaries::count) return grains(c) * c.bpm.primaries;
  const double R = smallest_radius(c);
  return c.bpm.primaries * grain_area(c) /
         (is_in_space(c) ? 4 * std::numbers::pi / 3 * R * R * R : std::numbers::pi * R * R);
}

}  // namespace

int points_of_grain(const Case& c) {
  const int n = c.mpm.cells;
  if (is_rigid(c)) return is_in_space(c) ? 6 * n * n + 2 : 4 * n;
  return is_in_space(c) ? 8 * (n * n * n + n / 2 * 6 * n * n) : 4 * (n * n + disk_rings(n) * 4 * n);
}

double box_height(const Case& c) {
  if (is_in_space(c)) {
    if (!is_in_a_box(c)) return 2 * c.grain.radius;
    if (!c.sample.placed.empty()) return c.box.height;
    return std::cbrt(grain_area(c) / c.sample.packing_fraction / (c.sample.aspect * c.sample.aspect));
  }
  return std::sqrt(grain_area(c) / c.sample.packing_fraction / c.sample.aspect);
}

double first_packing_fraction(const Case& c) {
  const double filled =
      sum_of_kinds(c, [](const Case& kind) { return area_share(kind) * area_of_kind(kind); });
  const double circles = sum_of_kinds(c, area_of_kind);
  return c.sample.packing_fraction * (filled / circles);
}

double implicit_time_step(const Case& c, double R) {
  constexpr double way_share = 0.01;
  const double step = way_share * R / c.loading.wall_velocity;
  const double p = stress_beside_motion(c);
  return p > 0 ? std::min(step, R * std::sqrt(c.grain.density / p)) : step;
}

namespace {

/// That of other implicit steps, but at most 20 times what a wave needs through the smallest radius: in
/// longer ones A has hardly any inertia, which alone holds a grain that touches none.
double implicit_lattice_step(const Case& c) {
  constexpr double most_waves = 20;
  const double R = smallest_radius(c), wave = std::sqrt(wave_modulus(c) / c.grain.density);
  return std::min(implicit_time_step(c, R), most_waves * R / wave);
}

}  // namespace

double first_time_step(const Case& c) {
  if (is_bonded(c)) return c.time.step > 0 ? c.time.step : stable_bond_step(c);
  if (c.time.step > 0) return c.time.step;
  if (is_in_space(c) && !c.kinds.empty()) return least_of_kinds(c, first_time_step);
  if (is_in_space(c) && !is_rigid(c))
    return 0.36 * smallest_radius(c) / c.mpm.cells / std::sqrt(wave_modulus(c) / c.grain.density);
  if (is_lattice(c) && is_implicit(c)) return implicit_lattice_step(c);
  if (is_implicit(c) || is_rigid(c)) return implicit_time_step(c, smallest_radius(c));
  if (!c.kinds.empty()) return least_of_kinds(c, first_time_step);
  // a share of the time in which a pressure wave crosses a cell; pi R^2 = 3.5 cells^2 h^2
  const double cell = smallest_radius(c) * std::sqrt(std::numbers::pi / 3.5) / c.mpm.cells * cell_share(c);
  return (is_lattice(c) ? 0.2 : 0.26) * cell / std::sqrt(wave_modulus(c) / c.grain.density);
}

namespace {

/// Speed of pressure waves in an elastic grain [m/s].
double wave_speed(const Case& c) {
  return largest_of_kinds(
      c, [](const Case& kind) { return std::sqrt(wave_modulus(kind) / kind.grain.density); });
}

bool remembers(const Case& c) {
  return largest_of_kinds(c, [](const Case& kind) {
           return is_elastic(kind) && law_choice(kind.mpm.law).remembers() ? 1.0 : 0.0;
         }) > 0;
}

/// Of all grains that are not bonded.
double points(const Case& c) {
  if (is_lattice(c) && is_in_a_box(c)) {  // on one lattice, the cell that of the smallest grain
    const double R = smallest_radius(c);
    return points_of_grain(c) * grain_area(c) / (std::numbers::pi * R * R);
  }
  return sum_of_kinds(c, [](const Case& kind) { return grains(kind) * points_of_grain(kind); });
}

/// CPU time of an implicit step for each point [s]. In a box it grows with s = dt c/R, the wave times of a
/// grain that the step lasts, more so among many grains, with the root of the cells and where grains are
/// pressed beyond phi_0 = 0.95: 20 and 80 grains of 6 cells took 1.0 and 5.4 s to a strain of 0.25 and 0.22
/// at 0.5 m/s, and 4.3 and 53 s at 1 mm/s. One grain between walls costs the same at any speed.
double implicit_seconds_of_point(const Case& c) {
  if (!is_in_a_box(c)) return 5.2e-7;
  const double s = first_time_step(c) * wave_speed(c) / smallest_radius(c);
  const double phi = c.sample.packing_fraction * std::exp((is_isotropic(c) ? 2 : 1) * last_strain(c));
  const double pressed = 1 + 4 * std::max(0.0, phi - 0.95);
  const double slow = s / (s + 20), crowd = std::pow(std::max(1.0, grains(c) / 20), 0.4 * slow);
  return 1.7e-7 * (1 + 6 * crowd * slow) * std::sqrt(c.mpm.cells / 6.0) * pressed;
}

/// How much more grains that flow take: fresh tangents in more iterations; a return to the yield surface.
constexpr double flow_factor_implicit = 5, flow_factor_explicit = 14;

/// CPU time of a step [s], as measured on one core of a server of 2024 (docs/performance.md).
double seconds_of_step(const Case& c, const Estimate& e) {
  constexpr int usual_sweeps = 17;
  const int sweeps =
      std::clamp(usual_sweeps, c.solver.min_sweeps, std::max(c.solver.min_sweeps, c.solver.max_sweeps));
  if (is_bonded(c)) return e.contacts * sweeps * (c.solver.precision == Precision::single ? 4.1e-9 : 5.5e-9);
  if (is_lattice(c)) return e.particles * (is_implicit(c) ? 2e-7 * c.mpm.cells : 1.1e-7);
  if (is_in_space(c)) {
    // contacts cost as much again with 6 cells; 216 and 27 grains, 4 to 8 cells: experiments/compaction_3d
    const double of_contacts = is_in_a_box(c) ? 6.0 / c.mpm.cells : 0;
    return std::ceil(grains(c) / 8) * 8 / grains(c) * e.particles * 1.6e-8 * (1 + of_contacts);
  }
  const double batches = std::ceil(grains(c) / 8);  // a batch of 8 grains costs the same when it is not full
  const double flow = !remembers(c) ? 1 : is_implicit(c) ? flow_factor_implicit : flow_factor_explicit;
  return batches * 8 * e.particles / grains(c) * flow *
         (is_implicit(c) ? implicit_seconds_of_point(c) : 5.5e-9);
}

/// CPU time of all rows of series.csv [s]: in a box each looks at every grain, whose outline must be found if
/// it is bonded.
double seconds_of_rows(const Case& c, const Estimate& e) {
  if (!is_in_a_box(c)) return 0;
  return std::min<double>(c.output.samples, e.steps) * grains(c) * (is_bonded(c) ? 75e-6 : 17e-6);
}

/// Each ends with a snapshot.
std::size_t stages_written(const Case& c) {
  return c.stages.empty() ? 1 + 2 * c.loading.unload_at.size() : without_repeats(c.stages).size();
}

/// Snapshots and ParaView's files of a whole run [bytes], as measured by primary, by bonded grain (outlines)
/// and by material point. A step writes one snapshot at most.
double disk(const Case& c, const Estimate& e) {
  const bool bpm = is_bonded(c);
  const double by_the_clock = c.output.snapshot_every > 0 ? 3600 * e.hours / c.output.snapshot_every : 0;
  const double frames =
      std::min(c.output.snapshots + by_the_clock, e.steps) + static_cast<double>(stages_written(c));
  if (is_in_space(c) && !bpm) return frames * (20e3 + 25 * e.particles);
  const double of_bonded = is_in_space(c) ? 430 : 280, of_surface = is_in_space(c) ? 10e3 : 900;
  const double bytes_of_particle = (bpm ? of_bonded : 150) + (c.output.vtk ? 75 : 0);
  return frames * (20e3 + bytes_of_particle * e.particles + (bpm ? of_surface * grains(c) : 0));
}

/// Of the program alone [bytes].
constexpr double program_memory = 30e6;

/// Of a point of implicit elastic grains in the plane [bytes]: factors, in single precision where steps are
/// short, and what iterations keep.
double implicit_bytes_of_point(const Case& c) {
  constexpr double short_steps = 30;  // in times of a wave through a cell
  const double wave_time = smallest_radius(c) / c.mpm.cells / wave_speed(c);
  return first_time_step(c) < short_steps * wave_time ? 140 + 2.8 * c.mpm.cells : 185 + 8.1 * c.mpm.cells;
}

/// Of a point [bytes]: while the page is made, which reads whole snapshots; or a file for ParaView; or a part
/// of a snapshot.
double bytes_of_files(const Case& c) { return c.output.report ? 170 : c.output.vtk ? 55 : 4; }

/// Sets the peak of a whole run, as measured: the program, its state, and a file while it is written or read.
/// A batch of 8 elastic grains takes the same when it is not full.
void set_memory(const Case& c, Estimate& e) {
  e.memory = program_memory;
  if (is_bonded(c)) {
    e.shared_memory = 550 * e.particles;
    e.memory += 2300 * e.particles + 7000 * grains(c);
  } else if (is_in_space(c)) {
    e.memory += 100 * e.particles + 1e6 * c.mpm.cells;
  } else if (is_lattice(c)) {
    e.memory += 500 * e.particles;
  } else {
    const double in_batches = std::ceil(grains(c) / 8) * 8 * e.particles / grains(c);
    e.shared_memory = is_implicit(c) && !is_rigid(c) ? implicit_bytes_of_point(c) * in_batches : 0;
    e.memory += e.shared_memory + (remembers(c) ? 69 : 14) * in_batches + bytes_of_files(c) * e.particles;
  }
}

}  // namespace

double least_energy(const Case& c) {
  constexpr double strain = 1e-3;
  if (!c.kinds.empty() && c.sample.placed.empty()) return sum_of_kinds(c, least_energy);
  const double v = c.loading.wall_velocity, kinetic = c.grain.density * v * v / 2;
  const bool implicit = !is_bonded(c) && is_implicit(c);
  const double elastic = implicit ? wave_modulus(c) * strain * strain / 2 : 0;
  return grain_area(c) * std::max(kinetic, elastic);
}

namespace {

/// Of grains of one engine.
Estimate estimate_in(double steps, const Case& the_case) {
  constexpr double second = 1.0 / 3600;  // [h]
  const bool bpm = is_bonded(the_case);
  Estimate result;
  result.particles = bpm ? primaries(the_case) : points(the_case);
  const double contacts_of_primary = is_in_space(the_case) ? 4.2 : 2.2;
  result.contacts =
      bpm ? contacts_of_primary * result.particles : grains(the_case) * 3.3 * the_case.mpm.cells;
  result.steps = steps;
  set_memory(the_case, result);
  result.hours =
      (result.steps * seconds_of_step(the_case, result) + seconds_of_rows(the_case, result)) * second;
  result.disk = disk(the_case, result);
  return result;
}

}  // namespace

Estimate estimate(const Case& the_case) {
  const double steps = std::round(loading_time(the_case) / first_time_step(the_case));
  if (!is_mixed(the_case)) return estimate_in(steps, the_case);
  PartOfCase bonded = part_of(the_case, GrainModel::bpm);
  bonded.the_case.solver.precision = Precision::full;
  Estimate both = estimate_in(steps, part_of(the_case, GrainModel::mpm).the_case);
  const Estimate more = estimate_in(steps, bonded.the_case);
  both.particles += more.particles;
  both.contacts += more.contacts;
  both.memory += more.memory - program_memory;
  both.shared_memory += more.shared_memory;
  both.hours += more.hours;
  both.disk += more.disk;
  return both;
}

}  // namespace softgrain
