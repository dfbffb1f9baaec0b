#include "softgrain/experiment/mpm_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/experiment/speed_search.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/mpm/equilibrium.hpp"

namespace softgrain {
namespace {

/// Beyond this root mean square of a grain's motion in a step, over its radius, the step was far too long.
constexpr double largest_motion = 0.5;

/// Of a stress that is kept: so far from it the search for the speed of the plates ends.
constexpr double stress_accuracy = 2e-3;

/// First grain that moves further than that in dt, or not by a number; -1 if none does.
int runaway_grain(const SoftGrains& grains, double dt) {
  std::vector<int> runaway(grains.batches.size(), -1);
  parallel_for(static_cast<int>(runaway.size()), [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    Wide sum = 0.0;
    for (const Vec<2, Wide>& v : batch.velocity) sum += dot(v, v);
    const double nodes = static_cast<double>(batch.velocity.size());
    for (int lane = Wide::size - 1; lane >= 0; --lane)
      if (batch.grain[lane] >= 0 &&
          !(dt * std::sqrt(sum[lane] / nodes) < largest_motion * batch.radius[lane]))
        runaway[b] = batch.grain[lane];
  });
  for (const int grain : runaway)
    if (grain >= 0) return grain;
  return -1;
}

/// Of the last correction of Newton's method.
double residual_limit(const ImplicitOptions& options) { return options.tolerance; }

}  // namespace

template <class Dynamics>
MpmSimulation<Dynamics>::MpmSimulation(Dynamics dynamics, WallDrive drive, double dt)
    : dynamics_(std::move(dynamics)), drive_(std::move(drive)), dt_(dt), height_start_(plate_distance()) {}

template <class Dynamics>
double MpmSimulation<Dynamics>::plate_distance() const {
  return dynamics_.walls[top_wall].point[1] - dynamics_.walls[bottom_wall].point[1];
}

template <class Dynamics>
double MpmSimulation<Dynamics>::box_width() const {
  return dynamics_.walls[right_wall].point[0] - dynamics_.walls[left_wall].point[0];
}

template <class Dynamics>
StepReport MpmSimulation<Dynamics>::step() {
  const double limit = std::is_same_v<Dynamics, ImplicitDynamics> ? drive_.stress_limit(step_) : 0;
  const SoftStepReport soft =
      limit > 0 ? step_under(limit) : step_at(drive_.approach_speed(step_, height_start_ - plate_distance()));
  if (const int grain = runaway_grain(dynamics_.grains, dynamics_.impulse_time); grain >= 0)
    throw NumericalError(
        fmt::format("grain {} moves by more than half its radius in a step; use a smaller time step", grain));
  ++step_;
  for (std::size_t w = 0; w < dynamics_.walls.size(); ++w)
    sums_.impulse[w] -= dot(dynamics_.wall_impulse(static_cast<int>(w)), dynamics_.walls[w].normal);
  sums_.duration += dt_;
  sums_.iterations += soft.iterations;
  sums_.rejected += soft.rejected;
  if (box()) drive_.watch(box_stress(), plate_distance(), step_);
  return {.contacts = soft.contacts,
          .sweeps = soft.sweeps,
          .residual_mean = soft.residual_mean > 0 ? soft.residual_mean : soft.residual,
          .residual_max = soft.residual,
          .residual_limit = residual_limit(dynamics_.options),
          .overlap_mean = 0,
          .overlap_max = soft.penetration_max,
          .converged = soft.converged};
}

/// Of the last step: the mean of lid and bottom [Pa].
template <class Dynamics>
double MpmSimulation<Dynamics>::box_stress() const {
  const double force = dynamics_.wall_impulse(top_wall)[1] - dynamics_.wall_impulse(bottom_wall)[1];
  return force / (2 * dt_ * box_width());
}

template <class Dynamics>
SoftStepReport MpmSimulation<Dynamics>::step_at(double approach_speed) {
  for (int w = 0; w < static_cast<int>(dynamics_.walls.size()); ++w)
    dynamics_.walls[w].velocity = drive_.velocity(dynamics_.walls[w], w, approach_speed);
  return dynamics_.step(dt_);
}

/// A step of plates that bear at most sigma_h. Before they hold it, they go their way unless they would bear
/// more; then, and from there on, they go at the speed v, sought by trial and error, at which
///   sigma(v) + Z v = sigma_h,  |v| <= loading.wall_velocity.
template <class Dynamics>
SoftStepReport MpmSimulation<Dynamics>::step_under(double sigma_h) {
  const Dynamics start = dynamics_;
  const auto excess_at = [&](double v, SoftStepReport& report) {
    report = step_at(v);
    return box_stress() + drive_.plates.damper * v - sigma_h;
  };
  SoftStepReport report;
  SpeedSearch search(drive_.largest_speed(), stress_accuracy * sigma_h, drive_.state.slope);
  double v = drive_.approach_speed(step_, height_start_ - plate_distance());
  double excess = excess_at(v, report);
  if (!drive_.holds() && excess < drive_.plates.damper * v) return report;  // sigma < sigma_h
  while (!search.found(v, excess)) {
    v = search.next();
    dynamics_ = Dynamics(start);
    excess = excess_at(v, report);
  }
  if (!drive_.holds()) drive_.begin_hold(step_ + 1);
  drive_.state.speed = v;
  drive_.state.slope = search.slope();
  return report;
}

template <class Dynamics>
SolvedContactProblem MpmSimulation<Dynamics>::step_and_catch_problem() {
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>) {
    dynamics_.caught.emplace();
    step();
    return *std::exchange(dynamics_.caught, std::nullopt);
  } else {
    return Simulation::step_and_catch_problem();
  }
}

/// Outward force on a wall [N/m], mean since the last row.
template <class Dynamics>
double MpmSimulation<Dynamics>::wall_force(int wall) const {
  return sums_.impulse[wall] / (sums_.duration > 0 ? sums_.duration : dt_);
}

template <class Dynamics>
double MpmSimulation<Dynamics>::stored_energy() const {
  double energy = 0;
  for (const GrainBatch& batch : dynamics_.grains.batches) {
    const Wide elastic = elastic_energy(dynamics_.grains, batch);
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) energy += elastic[lane];
  }
  return energy;
}

template <class Dynamics>
std::vector<Quantity> MpmSimulation<Dynamics>::energies() const {
  return soft_energies(dynamics_.work, dynamics_.grains.kinetic_energy(), stored_energy());
}

template <class Dynamics>
SoftView MpmSimulation<Dynamics>::view() const {
  return {.grains = dynamics_.grains,
          .walls = dynamics_.walls,
          .contacts = dynamics_.contacts,
          .impulse = dynamics_.impulse,
          .impulse_time = dynamics_.impulse_time > 0 ? dynamics_.impulse_time : dt_};
}

template <class Dynamics>
std::vector<Quantity> MpmSimulation<Dynamics>::observe() {
  const SoftGrains& grains = dynamics_.grains;
  std::vector<Vec<2>> outline;
  grains.gather_outline(outline);
  double x_least = std::numeric_limits<double>::infinity(), x_largest = -x_least, least_J = x_least;
  for (const Vec<2>& x : outline) x_least = std::min(x_least, x[0]), x_largest = std::max(x_largest, x[0]);
  double start_area = 0;
  for (int g = 0; g < grains.size(); ++g) start_area += grains.mass(g) / grains.density;
  for (const GrainBatch& batch : grains.batches) {
    const Wide J = softgrain::least_J(batch);
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      least_J = std::min(least_J, J[lane]);
  }
  const double width = box() ? box_width() : x_largest - x_least;
  const double height = plate_distance();
  const auto contacts =
      std::ranges::count_if(dynamics_.impulse, [](const Vec<2>& impulse) { return impulse[0] > 0; });
  std::vector<Quantity> row{
      {"step", "", static_cast<double>(step_)},
      {"time", "s", time()},
      {"strain", "", strain()},
      {"leg", "", static_cast<double>(drive_.leg(std::max<std::int64_t>(step_ - 1, 0)))},
      {"wall_height", "m", height},
      {"width", "m", width},
      {"stress_bottom", "Pa", wall_force(bottom_wall) / width},
      {"stress_top", "Pa", wall_force(top_wall) / width},
      {"force_bottom", "N/m", wall_force(bottom_wall)},
      {"force_top", "N/m", wall_force(top_wall)},
  };
  const auto append = [&row](const std::vector<Quantity>& more) {
    row.insert(row.end(), more.begin(), more.end());
  };
  if (box()) {
    row.push_back({"stress_side", "Pa", (wall_force(left_wall) + wall_force(right_wall)) / 2 / height});
    const double approach = dynamics_.walls[top_wall].velocity[1] - dynamics_.walls[bottom_wall].velocity[1];
    append(soft_packing_row(view(), approach / height));
  } else {
    row.push_back({"area_ratio", "", grain_area(grains) / start_area});
  }
  row.push_back({"least_J", "", least_J});
  row.push_back({"contacts", "", static_cast<double>(contacts)});
  append(energies());
  row.push_back({"iterations", "", sums_.duration > 0 ? sums_.iterations * dt_ / sums_.duration : 0});
  row.push_back({"rejected_steps", "", sums_.rejected});
  sums_.impulse = {};
  sums_.duration = sums_.iterations = 0;
  return row;
}

template class MpmSimulation<ImplicitDynamics>;
template class MpmSimulation<ExplicitDynamics>;

}  // namespace softgrain
