#include "softgrain/soft/implicit_step.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/contact/adhesive_contacts.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/pressed_walls.hpp"
#include "softgrain/soft/stable_step.hpp"

namespace softgrain {
namespace {

/// Iterations after which the tangent is made anew.
constexpr int refactor_every = 8;

/// Tolerance of NLGS over that of Newton's method: looser, and Newton needs more iterations; tighter, and
/// NLGS sweeps in vain (docs/decisions/0013).
constexpr double contact_share = 0.25;

/// The same in a slow step while hardly any force holds the grains: what NLGS leaves would push them about by
/// more than Newton's tolerance (docs/decisions/0031).
constexpr double floppy_share = 0.1;

/// A vertex may be this many tolerances deep: the worst contact that NLGS allows, and Newton's last move.
constexpr double deepest = 10;

/// Proximal term of a quasi-static step over that of others (docs/decisions/0023).
constexpr double quasi_static_proximal = 2;

/// After so many sub-steps that succeeded, at most, longer ones are tried again.
constexpr int most_patience = 4;

/// A step that needs more sub-steps, those taken back included, is not of this motion.
constexpr int most_sub_steps = 2000;

/// Where a matrix is indefinite or a correction too large, a slow step takes the inertia of half the step,
/// down to this one [R/c].
constexpr double most_inertia = 2;

/// A grain that touches others may leave its place by so much more in a slow step than in others.
constexpr double further_in_slow_steps = 4;

/// Contact force over rho c^2 R from which on it is the measure of unbalanced ones.
constexpr double least_force = 1e-3;

/// Sub-steps shorter than this share of the explicit step are not tried.
constexpr double shortest_step = 1.0 / 64;

}  // namespace

ImplicitDynamics::ImplicitDynamics(SoftGrains soft_grains, Box<2> box_of_grains,
                                   const ImplicitOptions& implicit_options)
    : grains(std::move(soft_grains)), box(std::move(box_of_grains)), options(implicit_options) {
  require(grains.size() > 0, "there is no grain");
  friction_by_kind();  // says what is wrong with it
  adhesion_ = {grains, options.adhesion};
  if (adheres())
    neighbours_.keep(adhesion_.range(),
                     [law = adhesion_](int kind, int other) { return law.adhere(kind, other); });
  smallest_radius_ = grains.radius(0);
  for (int g = 0; g < grains.size(); ++g) {
    mean_radius_ += grains.radius(g) / grains.size();
    smallest_radius_ = std::min(smallest_radius_, grains.radius(g));
  }
  explicit_step_ = stable_time_step(grains, 1);
  wave_time_ = smallest_radius_ / grains.fastest_wave();
  for (int k = 0; k < grains.kinds(); ++k) {
    const GrainMaterial& material = grains.material(k);
    if (material.rigid) continue;
    const double wave = wave_speed(material.law, material.density);
    const double speed = smallest_radius_ / (smallest_radius_ / wave);  // in old digits
    const double force = least_force * material.density * speed * speed * mean_radius_;
    least_contact_force_ = least_contact_force_ == 0 ? force : std::min(least_contact_force_, force);
  }
  for (const GrainBatch& batch : grains.batches) {
    matrix_.emplace_back(batch.topology->pattern);
    compliance_.emplace_back(batch.topology->rigid() ? compliance_size(batch) : 0);
  }
  for (auto* vectors : {&start_, &velocity_start_, &half_solved_, &force_, &kept_, &correction_, &moved_})
    vectors->resize(grains.batches.size());
  for (auto* of_batches : {&pace_, &size_, &halvings_}) of_batches->resize(grains.batches.size());
  rigid_.resize(grains.batches.size());
}

SoftStepReport ImplicitDynamics::step(double dt) {
  SoftStepReport report;
  box.impulse.assign(box.walls.size(), {});
  if (sub_step <= 0) sub_step = dt;
  slow_ = slow(dt);
  const double shortest = shortest_step * std::min(dt, explicit_step_);
  int tried = 0;
  for (double done = 0; done < dt * (1 - 1e-9);) {
    if (++tried > most_sub_steps)
      throw NumericalError(fmt::format(
          "the implicit step of {:.3g} s is {:.2g} of it through after {} sub-steps; use a smaller "
          "time.step",
          dt, done / dt, most_sub_steps));
    const double part = std::min(sub_step, dt - done);
    const Failure failure = try_step(part, report);
    if (failure == Failure::none) {
      done += part;
      if (part == sub_step && ++successes >= patience) sub_step *= 2, successes = 0;
      if (sub_step > dt) patience = 1;
      continue;
    }
    patience = std::min(2 * patience, most_patience);
    successes = 0;
    take_back();
    ++report.rejected;
    sub_step = part / 4;
    if (sub_step < shortest) give_up(failure, part);
  }
  report.converged = true;
  if (box.cell.any()) grains.know_all();  // the stress of a cell asks for centres of mass after each step
  return report;
}

void ImplicitDynamics::give_up(Failure failure, double dt) const {
  const char* cause = failure == Failure::inverted_point      ? "a material point is turned inside out"
                      : failure == Failure::indefinite_matrix ? "the stiffness is indefinite"
                      : failure == Failure::not_finite        ? "a correction is not finite"
                      : failure == Failure::too_far           ? "a motion is larger than half a radius"
                      : failure == Failure::too_deep          ? "a contact stays too deep"
                                                              : "Newton's method does not converge";
  const char* remedy =
      failure == Failure::inverted_point || failure == Failure::indefinite_matrix  //
          ? "move the walls more slowly, use a finer grid (mpm.cells), or end at a smaller strain"
          : "use a larger mpm.tolerance or a finer grid (mpm.cells), move the walls more slowly, or "
            "end at a smaller strain";
  throw NumericalError(fmt::format(
      "the implicit step failed even at dt = {:.3g} s, {:.3g} of the explicit step: {} in grain {}; {}", dt,
      dt / explicit_step_, cause, failed_grain_, remedy));
}

ImplicitDynamics::Failure ImplicitDynamics::try_step(double dt, SoftStepReport& report) {
  start(dt);
  inertia_of_ = floppy(dt) ? options.floppy_inertia_of_at_most : options.inertia_of_at_most;
  const int most = most_iterations(dt);
  Failure failure = renew(dt, report);
  Imbalance left;
  const int renewal = grains.has_history() ? 1 : refactor_every;  // docs/decisions/0038
  for (int iteration = 1; failure == Failure::none; ++iteration) {
    if ((failure = residual(dt)) != Failure::none) break;
    const bool contacts_solved = solve_contacts(dt, report);
    left = correct(iteration, (iteration - 1) % renewal != 0);
    ++report.iterations;
    if (!std::isfinite(left.correction)) return Failure::not_finite;
    const bool too_far = left.correction >= largest_correction;
    if (too_far && !more_inertia(dt)) return Failure::too_far;
    if (contacts_solved && left.residual < options.tolerance) {
      if (find_depth() <= deepest * options.tolerance) break;
      failure = iteration == most ? Failure::too_deep : failure;
    } else if (iteration == most) {
      failure = Failure::no_convergence;
    }
    if (failure == Failure::none && (too_far || iteration % renewal == 0)) failure = renew(dt, report);
  }
  if (failure == Failure::none) failure = finish(dt, report);
  if (failure == Failure::none) report.residual = std::max(report.residual, left.residual);
  return failure;
}

/// The first grain that moved further than is trusted, or -1.
int ImplicitDynamics::runaway_grain(double dt) {
  if (!slow(dt)) return grains.runaway_grain(dt);
  std::vector<double> allowed(grains.size(), 1.0);
  const std::vector<bool> touching = touching_grains();
  for (int g = 0; g < grains.size(); ++g)
    if (touching[g]) allowed[g] = further_in_slow_steps;
  return grains.runaway_grain(dt, allowed);
}

/// A, definite.
ImplicitDynamics::Failure ImplicitDynamics::renew(double dt, SoftStepReport& report) {
  const double proximal = options.proximal * (quasi_static(dt) ? quasi_static_proximal : 1);
  Failure failure = factor(dt, proximal, report);
  while (failure == Failure::indefinite_matrix && more_inertia(dt)) failure = factor(dt, proximal, report);
  return failure == Failure::indefinite_matrix ? factor(dt, 4 * proximal, report) : failure;
}

/// In a slow step, where that changes the path of iterations alone. False: A has enough of it.
bool ImplicitDynamics::more_inertia(double dt) {
  if (!slow(dt) || inertia_of_ <= most_inertia) return false;
  inertia_of_ /= 2;
  return true;
}

int ImplicitDynamics::most_iterations(double dt) const {
  if (slow(dt)) return options.slow_iterations;
  return quasi_static(dt) ? options.quasi_static_iterations : options.max_iterations;
}

/// Contacts at the present positions, and their impulses by NLGS with warm start. True if it converged.
bool ImplicitDynamics::solve_contacts(double dt, SoftStepReport& report) {
  grains.gather_outline(outline_.position);
  std::vector<OutlineContact> found = neighbours_.detect(grains, outline_);
  carry_to(found);
  contacts = std::move(found);
  ElasticContacts system(grains, contacts, compliance_, outline_increment_, dt, scratch_, shares_contacts());
  AdhesiveContacts adhesive = adhesion_.contacts(grains, contacts, outline_, quasi_static(dt), attraction);
  PushedBodies pressed = pressed_walls(box, contacts, felt(), dt);
  system.push(pressed);
  system.apply_impulses(felt());
  SolverOptions solver = options.solver;
  solver.velocity_scale = mean_radius_ / dt;
  solver.tolerance = (floppy(dt) ? floppy_share : contact_share) * options.tolerance;
  const SolverReport solved =
      solve_adhesive<2>(system, adhesive, pressed, std::span(impulse), friction_of_contacts(), solver);
  system.gather(impulse);
  report.sweeps += solved.sweeps;
  press_moved_ = move_presses(box, pressed, dt);
  if (press_moved_ > 0) outline_.walls = box.walls;
  return solved.converged;
}

/// What was found last is given the impulses of the contacts before, and their attractions.
void ImplicitDynamics::carry_to(std::span<const OutlineContact> found) {
  impulse = carried_impulses(grains, contacts, impulse, found);
  if (!adheres()) return;
  attraction.resize(contacts.size());
  attraction = carried_attraction(grains, contacts, attraction, found);
}

/// (p_n - a, p_t) of the contacts [N s/m]; until it is called again.
const std::vector<Vec<2>>& ImplicitDynamics::felt() {
  return attraction.empty() ? impulse : felt_ = felt_impulses(impulse, attraction);
}

double ImplicitDynamics::energy_of_adhesion(std::span<const OutlineContact> of_contacts) const {
  return adhesion_.energy(grains, of_contacts, [](const OutlineContact& contact) { return contact.gap; });
}

/// Of the deepest vertex at the present positions, over the mean radius; keeps the contacts found.
double ImplicitDynamics::find_depth() {
  grains.gather_outline(outline_.position);
  found_ = neighbours_.detect(grains, outline_);
  double depth = 0;
  for (const OutlineContact& contact : found_) depth = std::max(depth, -contact.gap / mean_radius_);
  return depth;
}

/// The history of the points after a step that nothing takes back any more.
void ImplicitDynamics::flow(double dt) {
  if (!grains.has_history()) return;
  std::vector<FlowOfStep> flows(grains.batches.size());
  share([&](int b) { flows[b] = advance_history(grains, grains.batches[b], dt); },
        [&](int b, Message& message) { message(flows[b]); });
  last_flow = sum_of(grains, flows);
  work.flow += last_flow.dissipated;
}

/// v = (x - x_n)/dt; the walls' impulses; the work done; the contacts as they are at the end.
ImplicitDynamics::Failure ImplicitDynamics::finish(double dt, SoftStepReport& report) {
  std::vector<int> failed(batches(), -1);
  const auto end_batch = [&](int b) {
    GrainBatch& batch = grains.batches[b];
    failed[b] = batch.grain_in(internal_force(grains, batch, force_[b], dt));
    if (batch.topology->rigid()) return end_rigid(b, dt);
    for (std::size_t i = 0; i < batch.position.size(); ++i)
      batch.velocity[i] = Wide(1 / dt) * (batch.position[i] - start_[b][i]);
  };
  share(end_batch, [&](int b, Message& message) { message(failed[b]); });
  if (!none_failed(failed)) return Failure::inverted_point;
  failed_grain_ = runaway_grain(dt);
  if (failed_grain_ >= 0) return Failure::too_far;
  if (caught) catch_problem(dt);
  flow(dt);
  if (slow(dt)) hold_touching();
  const std::vector<Vec<2>> force = contact_forces(grains, contacts, felt(), dt);
  balance_momentum(dt, force);
  add_work(force);
  end_step_of_presses(box, contacts, felt(), dt);
  carry_to(found_);
  contacts = std::move(found_);
  if (adheres()) {
    const double now = energy_of_adhesion(contacts);
    work.adhesion += now - adhesion_energy;
    adhesion_energy = now;
  }
  impulse_time = dt;
  report.contacts = 0;
  double depths = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    report.contacts += impulse[c][0] > 0;
    if (impulse[c][0] > 0) depths += std::max(0.0, -contacts[c].gap);
    report.overlap_max = std::max(report.overlap_max, -contacts[c].gap / smallest_radius_);
  }
  report.overlap_mean = report.contacts > 0 ? depths / report.contacts / smallest_radius_ : 0;
  return Failure::none;
}

}  // namespace softgrain
