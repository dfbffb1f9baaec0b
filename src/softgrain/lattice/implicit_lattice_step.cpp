#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/lattice/compliant_contacts.hpp"
#include "softgrain/lattice/updated_lagrangian.hpp"

// Backward Euler on the nodes of the lattice (theory (60a)-(60d)).

namespace softgrain {
namespace {

/// Iterations after which the matrices are made anew.
constexpr int refactor_every = 4;

/// Tolerance of NLGS over that of Newton's method.
constexpr double contact_share = 0.1;

/// Of nodes that have a say in when Newton's method ends, over a full cell: lighter ones move nothing.
constexpr double least_share = 1e-3;

/// A correction beyond this many mean radii is no correction.
constexpr double largest = 0.5;

/// Steps shorter than this share of the explicit one are not tried.
constexpr double shortest = 1.0 / 16;

using Place = std::tuple<int, int, int, int, double, double>;

/// What a contact is recognised by: nodes of the lattice stay where they are.
Place place_of(const LatticeContact& c) { return {c.grain, c.other, c.wall, c.vertex, c.node[0], c.node[1]}; }

}  // namespace

/// Does of_grain(g) succeed for all? If not, remembers the first grain for which it fails.
template <class Work>
bool UpdatedLagrangianDynamics::all_grains(const Work& of_grain) {
  std::vector<char> fine(grains.size());
  parallel_for(static_cast<int>(grains.size()), [&](int g) { fine[g] = static_cast<char>(of_grain(g)); });
  const auto bad = std::find(fine.begin(), fine.end(), 0);
  if (bad == fine.end()) return true;
  failed_grain_ = static_cast<int>(bad - fine.begin());
  return false;
}

SoftStepReport UpdatedLagrangianDynamics::implicit_step(double dt) {
  SoftStepReport report;
  std::vector<Vec<2>> felt(box.walls.size());
  const double least = shortest * std::min(dt, stable_time_step(law, density, options.cell, 1));
  double part = dt;
  for (double done = 0; done < dt * (1 - 1e-9);) {
    part = std::min(part, dt - done);
    const auto before = std::tuple(grains, box, work, contacts, impulse);
    const Failure failure = try_step(part, report);
    if (failure == Failure::none) {
      done += part;
      for (std::size_t w = 0; w < felt.size(); ++w) felt[w] += box.impulse[w];
      continue;
    }
    std::tie(grains, box, work, contacts, impulse) = before;
    ++report.rejected;
    if (part / 4 < least) give_up(failure, part);
    part /= 4;
  }
  box.impulse = felt;
  report.converged = true;
  return report;
}

void UpdatedLagrangianDynamics::give_up(Failure failure, double dt) const {
  const char* cause = failure == Failure::inverted_point      ? "a material point is turned inside out"
                      : failure == Failure::indefinite_matrix ? "the stiffness is indefinite"
                      : failure == Failure::not_finite        ? "a correction is not finite"
                                                              : "Newton's method does not converge";
  throw NumericalError(fmt::format(
      "the implicit step on the lattice failed even at dt = {:.3g} s: {} in grain {}; use a smaller "
      "time.step or a larger mpm.tolerance, or end at a smaller strain",
      dt, cause, failed_grain_));
}

UpdatedLagrangianDynamics::Failure UpdatedLagrangianDynamics::try_step(double dt, SoftStepReport& report) {
  begin_implicit(dt);
  Failure failure = solve_nodes(dt, report);
  if (failure == Failure::none) failure = strain_all(dt);
  if (failure != Failure::none) return failure;
  end_implicit(dt);
  const SoftStepReport now = report_of({});
  report.contacts = now.contacts;
  report.overlap_mean = now.overlap_mean;
  report.overlap_max = std::max(report.overlap_max, now.overlap_max);
  return Failure::none;
}

/// v_i- of the nodes, and what they would do freely.
void UpdatedLagrangianDynamics::begin_implicit(double dt) {
  damping_ = {options.damping, dt, box};
  box.advance(dt);
  work.internal += kinetic_energy_of_points();
  find_stencils();
  gather_momentum();
  work.internal -= kinetic_energy_of_nodes();
  start_velocity_ = flight_velocity_ = lattice_.velocity;
  find_outline_weights();
  equations_.resize(grains.size());
  end_F_.resize(grains.size());
  parallel_for(static_cast<int>(grains.size()), [&](int g) {
    equations_[g].number(lattice_, g, stencil_[g]);
    lattice_.for_each_node(g, [&](int i, const Vec<2>& x) {
      if (lattice_.mass[i] > 0)
        flight_velocity_[i] += dt * options.gravity + damping_.velocity_change(x, start_velocity_[i]);
    });
  });
}

/// Newton's method: v <- v + A^-1 (r + H p/dt)/dt, and p by NLGS under W = H^T A^-1 H/dt^2.
UpdatedLagrangianDynamics::Failure UpdatedLagrangianDynamics::solve_nodes(double dt, SoftStepReport& report) {
  SolverOptions solver = options.solver;
  solver.velocity_scale = mean_radius_ / dt;
  solver.tolerance = contact_share * options.tolerance;
  solver.extrapolated = true;
  std::optional<LatticeContacts> system;
  std::optional<CompliantContacts> compliant;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    if (const Failure failure = strain_all(dt); failure != Failure::none) return failure;
    find_residual(dt);
    const bool fresh = iteration % refactor_every == 0;
    if (fresh)
      if (const Failure failure = factor(dt, report); failure != Failure::none) return failure;
    if (iteration == 0 || options.contact_on == ContactOn::outline) {
      const std::vector<LatticeContact> old = contacts;
      const std::vector<Vec<2>> old_impulse = impulse;
      system.emplace(lattice_);
      find_contacts(*system, dt);
      contacts.assign(system->contacts().begin(), system->contacts().end());
      carry_impulses(old, old_impulse);
    }
    compliant.emplace(
        CompliantContacts(lattice_, *system, equations_, dt, fresh || !compliant ? nullptr : &*compliant));
    correction_ = residual_;
    solve_grains(correction_);
    std::vector<Vec<2>> free_velocity = lattice_.velocity;
    for (int i = 0; i < lattice_.nodes(); ++i) free_velocity[i] += (1 / dt) * correction_[i];
    compliant->start(free_velocity, impulse);
    const SolverReport solved = solve_nlgs<2>(*compliant, std::span(impulse), friction_of(contacts), solver);
    report.sweeps += solved.sweeps;
    ++report.iterations;

    std::vector<Vec<2>> by_contact(residual_.size());
    system->add_impulses(impulse, by_contact);  // H p
    for (Vec<2>& f : by_contact) f *= 1 / dt;
    solve_grains(by_contact);
    for (int i = 0; i < lattice_.nodes(); ++i) {
      correction_[i] += by_contact[i];
      lattice_.velocity[i] += (1 / dt) * correction_[i];
    }
    const double left = largest_correction();
    if (!(left < largest)) return Failure::not_finite;
    if (left < options.tolerance && solved.converged) {
      report.residual = std::max(report.residual, left);
      add_work_of_contacts(*system);
      return Failure::none;
    }
  }
  return Failure::no_convergence;
}

/// F of all points at the end of the step, from the nodes' velocities as they are.
UpdatedLagrangianDynamics::Failure UpdatedLagrangianDynamics::strain_all(double dt) {
  const bool all =
      all_grains([&](int g) { return strained(lattice_, g, grains[g], stencil_[g], dt, end_F_[g]); });
  return all ? Failure::none : Failure::inverted_point;
}

/// r_i = m_i (v_i* - v_i)/dt + f_i, v* the flight.
void UpdatedLagrangianDynamics::find_residual(double dt) {
  residual_.assign(lattice_.nodes(), {});
  parallel_for(static_cast<int>(grains.size()), [&](int g) {
    add_internal_force(lattice_, g, grains[g], stencil_[g], end_F_[g], law, residual_);
    for (const int i : equations_[g].nodes())
      residual_[i] += (lattice_.mass[i] / dt) * (flight_velocity_[i] - lattice_.velocity[i]);
  });
}

UpdatedLagrangianDynamics::Failure UpdatedLagrangianDynamics::factor(double dt, SoftStepReport& report) {
  report.factorisations += static_cast<int>(grains.size());
  const bool all = all_grains(
      [&](int g) { return equations_[g].factor(lattice_, grains[g], stencil_[g], end_F_[g], law, dt); });
  return all ? Failure::none : Failure::indefinite_matrix;
}

/// x <- A^-1 x of all grains, by nodes; 0 where there is no mass.
void UpdatedLagrangianDynamics::solve_grains(std::span<Vec<2>> of_nodes) const {
  parallel_for(static_cast<int>(grains.size()), [&](int g) {
    const std::vector<int>& nodes = equations_[g].nodes();
    std::vector<Vec<2>> x(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) x[k] = of_nodes[nodes[k]];
    equations_[g].solve(x);
    const int first = lattice_.first_node(g);
    std::fill_n(of_nodes.begin() + first, lattice_.columns(g) * lattice_.rows(g), Vec<2>{});
    for (std::size_t k = 0; k < nodes.size(); ++k) of_nodes[nodes[k]] = x[k];
  });
}

std::vector<double> UpdatedLagrangianDynamics::friction_of(std::span<const LatticeContact> of) const {
  std::vector<double> friction;
  for (const LatticeContact& c : of)
    friction.push_back(c.wall >= 0 ? options.wall_friction : options.friction);
  return friction;
}

/// Over the mean radius.
double UpdatedLagrangianDynamics::largest_correction() const {
  const double least = least_share * density * options.cell * options.cell;
  double most = 0;
  for (int i = 0; i < lattice_.nodes(); ++i)
    if (const double f = norm(correction_[i]); lattice_.mass[i] > least && !(f <= most)) most = f;
  return most / mean_radius_;
}

/// `impulse` of `contacts`: that of the same place before, if there was a contact.
void UpdatedLagrangianDynamics::carry_impulses(std::span<const LatticeContact> old,
                                               std::span<const Vec<2>> old_impulse) {
  std::map<Place, Vec<2>> known;
  for (std::size_t c = 0; c < old.size(); ++c)
    if (old_impulse[c][0] > 0) known[place_of(old[c])] = old_impulse[c];
  impulse.assign(contacts.size(), {});
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (const auto found = known.find(place_of(contacts[c])); found != known.end())
      impulse[c] = found->second;
}

/// With the velocities at the end of the step.
void UpdatedLagrangianDynamics::add_work_of_contacts(const LatticeContacts& system) {
  for (int c = 0; c < system.size(); ++c) {
    const LatticeContact& contact = contacts[c];
    const Vec<2> t = perpendicular(contact.normal), P = impulse[c][0] * contact.normal + impulse[c][1] * t;
    const Vec<2> u = system.combined(c, lattice_.velocity) - contact.wall_velocity;
    work.walls += dot(P, contact.wall_velocity);
    work.contacts -= dot(P, u);
    work.friction -= impulse[c][1] * dot(t, u);
  }
}

/// Points follow their nodes. What was done, with the velocities at the end of the step:
///   sum_i m_i (v_i+ - v_i-) . v_i+ = change of kinetic energy + sum_i m_i |v_i+ - v_i-|^2/2.
void UpdatedLagrangianDynamics::end_implicit(double dt) {
  impulse_time = dt;
  for (std::size_t g = 0; g < grains.size(); ++g) work.internal += internal_work(grains[g], end_F_[g], law);
  for (int i = 0; i < lattice_.nodes(); ++i) {
    const double m = lattice_.mass[i];
    if (!(m > 0)) continue;
    const Vec<2>& v = lattice_.velocity[i];
    const Vec<2> dv = v - start_velocity_[i], by_gravity = dt * options.gravity;
    work.inertia += 0.5 * m * dot(dv, dv);
    work.gravity += m * dot(by_gravity, v);
    work.damping -= m * dot(flight_velocity_[i] - start_velocity_[i] - by_gravity, v);
  }
  work.internal += kinetic_energy_of_nodes();
  const double steps = dt / stable_time_step(law, density, options.cell);
  move_points(dt, 1 - std::pow(1 - options.pic_share, steps));
  move_outlines(dt);
  work.internal -= kinetic_energy_of_points();
  for (std::size_t g = 0; g < grains.size(); ++g) grains[g].F = end_F_[g];
}

}  // namespace softgrain
