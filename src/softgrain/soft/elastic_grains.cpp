#include "softgrain/soft/elastic_grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/model/box_loan.hpp"
#include "softgrain/soft/history.hpp"

namespace softgrain {
namespace {

/// Of the last correction of Newton's method.
double residual_limit(const ImplicitOptions& options) { return options.tolerance; }

/// Raises IoError for numbers that cannot be.
void visit_sub_steps(ImplicitDynamics& dynamics, StateVisitor& visit) {
  visit({"sub_step", "s", Owner::run, Role::start, "the longest to try next"}, dynamics.sub_step);
  visit({"sub_step_successes", "", Owner::run, Role::start, "sub-steps of that length that succeeded"},
        dynamics.successes);
  visit({"sub_step_patience", "", Owner::run, Role::start, "how many shall before twice the length is tried"},
        dynamics.patience);
  constexpr int most = 1000;
  if (!(dynamics.successes >= 0 && dynamics.successes <= most && dynamics.patience >= 1 &&
        dynamics.patience <= most))
    throw IoError("the snapshot's arrays 'sub_step_successes' and 'sub_step_patience' cannot be");
}

/// Raises IoError for numbers of sub-steps that cannot be.
void visit_stable_step(StableStep& stable, StateVisitor& visit) {
  visit({"stable_step", "s", Owner::run, Role::start, "when the cells were last looked at"}, stable.longest);
  visit({"until_look", "", Owner::run, Role::start, "sub-steps until they are again"}, stable.until_look);
  visit({"between_looks", "", Owner::run, Role::start, "sub-steps from one look to the next"},
        stable.between_looks);
  constexpr int most = 1000000;
  if (!(stable.longest >= 0 && stable.until_look >= 0 && stable.until_look <= most &&
        stable.between_looks >= 1 && stable.between_looks <= most))
    throw IoError("the snapshot's arrays 'stable_step', 'until_look' and 'between_looks' cannot be");
}

/// sum a over sum p_n of all contacts; 0 where nothing touches.
template <int Dim>
double attraction_ratio(std::span<const Vec<Dim>> impulse, std::span<const double> attraction) {
  double pulls = 0, pushes = 0;
  for (const double a : attraction) pulls += a;
  for (const Vec<Dim>& p : impulse) pushes += p[0];
  return pushes > 0 ? pulls / pushes : 0;
}

/// Deepest overlap over the smallest radius that rigid grains alone do not reach while walls can move on.
constexpr double jammed_overlap = 0.05;

/// One step. Raises NumericalError where it fails; of rigid grains alone that shows that they are jammed.
template <class Dynamics>
SoftStepReport step_unless_jammed(const Dynamics& dynamics, const std::function<SoftStepReport()>& advance) {
  const NumericalError jammed(
      "the rigid grains are jammed: walls that go on would push them into one another; end at a stress "
      "(loading.max_stress), or at a smaller strain or packing fraction");
  const bool rigid = dynamics.grains.fastest_wave() == 0;
  try {
    const SoftStepReport report = advance();
    if (rigid && report.overlap_max > jammed_overlap) throw jammed;
    return report;
  } catch (const NumericalError&) {
    if (rigid) throw jammed;
    throw;
  }
}

}  // namespace

template <class Dynamics>
StepReport ElasticGrains<Dynamics>::step_by(Box<Dim>& box, const std::function<SoftStepReport()>& advance) {
  const BoxLoan loan(box, dynamics_.box);
  const SoftStepReport soft = step_unless_jammed(dynamics_, advance);
  if constexpr (!std::is_same_v<Dynamics, ImplicitDynamics>)
    if (const int grain = dynamics_.grains.runaway_grain(dynamics_.impulse_time); grain >= 0)
      throw NumericalError(fmt::format(
          "grain {} moves by more than half its radius in a step; use a smaller time step", grain));
  ++sums_.steps;
  sums_.iterations += soft.iterations;
  sums_.rejected += soft.rejected;
  return {.contacts = soft.contacts,
          .sweeps = soft.sweeps,
          .residual_mean = soft.residual_mean > 0 ? soft.residual_mean : soft.residual,
          .residual_max = soft.residual,
          .residual_limit = residual_limit(dynamics_.options),
          .overlap_mean = soft.overlap_mean,
          .overlap_max = soft.overlap_max,
          .converged = soft.converged};
}

template <class Dynamics>
std::vector<double> ElasticGrains<Dynamics>::radii() const {
  std::vector<double> radius;
  for (int g = 0; g < dynamics_.grains.size(); ++g) radius.push_back(dynamics_.grains.radius_of_area(g));
  return radius;
}

template <class Dynamics>
std::pair<double, double> ElasticGrains<Dynamics>::extent(int axis) const {
  std::vector<Vec<Dim>> outline;
  dynamics_.grains.gather_outline(outline);
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (const Vec<Dim>& x : outline) least = std::min(least, x[axis]), largest = std::max(largest, x[axis]);
  return {least, largest};
}

template <class Dynamics>
std::pair<double, double> ElasticGrains<Dynamics>::reach() const {
  const auto [low, high] = extent(0);
  const double margin = 0.1 * (high - low);
  return {low - margin, high + margin};
}

template <class Dynamics>
Energies ElasticGrains<Dynamics>::energies() const {
  return energies_of(dynamics_.work, dynamics_.grains.kinetic_energy(), stored_energy(dynamics_.grains));
}

template <class Dynamics>
Numbers ElasticGrains<Dynamics>::numbers(const Box<Dim>& box, const Energies& energies) const {
  const GrainsOf<Dim>& grains = dynamics_.grains;
  Numbers numbers = elastic_numbers(dynamics_.work, energies.stored);
  const std::vector<Vec<Dim>>& impulse = dynamics_.impulse;
  const auto contacts =
      std::count_if(impulse.begin(), impulse.end(), [](const Vec<Dim>& p) { return p[0] > 0; });
  numbers.emplace_back("contacts", contacts);
  if (const double J = least_J(grains); std::isfinite(J)) numbers.emplace_back("least_J", J);
  if (dynamics_.adheres()) {
    numbers.emplace_back("adhesion_energy", dynamics_.adhesion_energy);
    numbers.emplace_back("attraction_ratio", attraction_ratio<Dim>(dynamics_.impulse, dynamics_.attraction));
  }
  numbers.emplace_back("iterations", sums_.steps > 0 ? sums_.iterations / sums_.steps : 0);
  numbers.emplace_back("rejected_steps", sums_.rejected);
  if (grains.has_history()) {
    const PlasticStrain strain = plastic_strain(grains);
    numbers.emplace_back("dissipation_plastic", dynamics_.work.flow);
    numbers.emplace_back("plastic_strain", strain.mean);
    numbers.emplace_back("plastic_strain_max", strain.largest);
    numbers.emplace_back("yielding", dynamics_.last_flow.share);
  }
  if (!(dynamics_.options.gravity == Vec<Dim>{}))
    numbers.emplace_back("gravity_work", dynamics_.work.gravity);
  if (!box.closed()) {
    double size = 0;
    if constexpr (Dim == 2)
      size = outlines().area;
    else
      for (const SurfaceMeasure& of_grain : outlines()) size += of_grain.volume;
    numbers.emplace_back("area_ratio", size / grains.undeformed_area());
  }
  return numbers;
}

template <class Dynamics>
SoftViewOf<ElasticGrains<Dynamics>::Dim> ElasticGrains<Dynamics>::view() const {
  return {.grains = dynamics_.grains,
          .contacts = dynamics_.contacts,
          .impulse = dynamics_.impulse,
          .attraction = dynamics_.attraction,
          .impulse_time = dynamics_.impulse_time};
}

template <class Dynamics>
PressBody ElasticGrains<Dynamics>::press_body(const Box<Dim>& box, int axis, double dt) const {
  // no wave crosses a box of rigid grains alone: it gets the time of some steps
  constexpr double steps_of_rigid = 10;
  const double length = box.length(axis), wave = dynamics_.grains.fastest_wave();
  return critically_damped(density(), wave > 0 ? wave : length / (steps_of_rigid * dt), length, dt);
}

template <class Dynamics>
Settings ElasticGrains<Dynamics>::settings() const {
  const auto& options = dynamics_.options;
  Settings settings{
      .friction = options.friction, .wall_friction = options.wall_friction, .damping = options.damping};
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>) settings.newton_tolerance = options.tolerance;
  return settings;
}

template <class Dynamics>
void ElasticGrains<Dynamics>::set(const Settings& settings) {
  auto& options = dynamics_.options;
  options.friction = settings.friction.value_or(options.friction);
  options.wall_friction = settings.wall_friction.value_or(options.wall_friction);
  options.damping = settings.damping.value_or(options.damping);
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>)
    options.tolerance = settings.newton_tolerance.value_or(options.tolerance);
}

template <class Dynamics>
void ElasticGrains<Dynamics>::catch_problem() {
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>)
    dynamics_.caught.emplace();
  else
    ModelOf<Dim>::catch_problem();
}

template <class Dynamics>
SolvedContactProblem ElasticGrains<Dynamics>::caught_problem(double dt) {
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>)
    return *std::exchange(dynamics_.caught, std::nullopt);
  else
    return ModelOf<Dim>::caught_problem(dt);
}

template <class Dynamics>
void ElasticGrains<Dynamics>::visit(StateVisitor& visit) {
  visit_nodes(dynamics_.grains, visit);
  visit_contacts(dynamics_.grains, walls_, dynamics_.box.cell.any(), dynamics_.contacts, dynamics_.impulse,
                 visit);
  if (dynamics_.adheres())
    visit_attraction(dynamics_.contacts.size(), dynamics_.attraction, dynamics_.adhesion_energy,
                     dynamics_.work.adhesion, visit);
  visit({"impulse_time", "s", Owner::run, Role::start, "the sub-step over which impulses acted"},
        dynamics_.impulse_time);
  visit_work(dynamics_.work, visit);
  if (dynamics_.grains.has_history()) {
    visit({"work_of_flow", "J/m", Owner::run, Role::sum, "dissipated by flow of the material"},
          dynamics_.work.flow);
    visit({"yielding", "", Owner::run, Role::sum, "share of the area that flowed in the last step"},
          dynamics_.last_flow.share);
  }
  visit({"steps_of_row", "", Owner::run, Role::sum, "steps since the last row"}, sums_.steps);
  visit({"iterations_of_row", "", Owner::run, Role::sum, "iterations since the last row"}, sums_.iterations);
  visit({"rejected_steps", "", Owner::run, Role::sum, "sub-steps taken back"}, sums_.rejected);
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>) {
    visit_sub_steps(dynamics_, visit);
  } else {
    if (visit.reads()) dynamics_.forget_rows();
    visit_stable_step(dynamics_.stable, visit);
    if (Dim == 3)
      visit({"until_search", "", Owner::run, Role::start, "sub-steps until contacts are looked for again"},
            dynamics_.stable.until_search);
  }
}

template class ElasticGrains<ImplicitDynamics>;
template class ElasticGrains<ExplicitDynamics>;
template class ElasticGrains<ExplicitStep<3>>;

}  // namespace softgrain
