#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "softgrain/contact/adhesion.hpp"
#include "softgrain/contact/fixed_point.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/contact/pushed_bodies.hpp"

namespace softgrain {

/// Adhesion at one contact in a step of dt (theory (79)). It is a part of the law of contact: the bodies feel
/// (p_n - a, p_t) with
///   a = pull t_c(g'),  0 <= g' _|_ p_n >= 0,  |p_t| <= mu p_n,  g' = dt u_n,
/// t_c the mean traction from g to g', or t(g') where the end of the step must be an equilibrium. p_n is the
/// pressure that holds the surfaces apart, and what friction goes by.
struct AdhesiveContact {
  Adhesion law{};
  double pull = 0;      ///< length of the outline times dt [m s]; 0: no adhesion here
  double gap = 0;       ///< g at the start of the step [m]
  double dt = 0;        ///< [s]
  bool at_end = false;  ///< t(g') instead of the mean

  /// a [N s/m] of a contact with the gap g' [m] at the end.
  double attraction(double next) const {
    return pull * (at_end ? law.traction(next) : law.mean_traction(gap, next));
  }
};

/// Adhesion of the contacts of a ContactSystem.
struct AdhesiveContacts {
  std::vector<AdhesiveContact> contact;  ///< (all contacts); empty if there is no adhesion
  std::span<double> attraction{};        ///< (all contacts) a >= 0 [N s/m]: start and solution
};

namespace detail {

/// f(a) - a of each contact [N s/m], with its violation of the law: the jump that this would give it.
template <int Dim, ContactSystem<Dim> System>
Violation attraction_change(const System& system, const AdhesiveContacts& adhesion,
                            const PushedBodies& pushed, std::span<const Vec<Dim>> impulse,
                            std::span<double> change) {
  const std::size_t count = adhesion.contact.size();
  std::vector<double> u_n(count);
  for (std::size_t c = 0; c < count; ++c)
    if (adhesion.contact[c].pull > 0) u_n[c] = system.relative_velocity(static_cast<int>(c))[0];
  for (const Pushing& pushing : pushed.contacts) {
    const PushedBody& body = pushed.bodies[static_cast<std::size_t>(pushing.body)];
    u_n[static_cast<std::size_t>(pushing.contact)] -= pushing.share * (body.velocity() - body.assumed);
  }
  Violation violation;
  for (std::size_t c = 0; c < count; ++c) {
    const AdhesiveContact& of_contact = adhesion.contact[c];
    if (of_contact.pull == 0) continue;
    change[c] = of_contact.attraction(of_contact.dt * u_n[c]) - adhesion.attraction[c];
    const double W_nn = system.delassus_block(static_cast<int>(c))(0, 0);
    violation.add(Vec<Dim>{W_nn * change[c]}, impulse[c][0]);
  }
  return violation;
}

/// Gives the contacts other attractions [N s/m]: the bodies feel them at once.
template <int Dim, ContactSystem<Dim> System>
void set_attraction(System& system, AdhesiveContacts& adhesion, PushedBodies& pushed,
                    std::span<const double> attraction) {
  std::vector<double> change(attraction.size());
  for (std::size_t c = 0; c < attraction.size(); ++c) {
    const AdhesiveContact& of_contact = adhesion.contact[c];
    if (of_contact.pull == 0) continue;
    const double next = std::clamp(attraction[c], 0.0, of_contact.pull * of_contact.law.strength());
    change[c] = next - adhesion.attraction[c];
    adhesion.attraction[c] = next;
    if (change[c] != 0) system.apply_impulse(static_cast<int>(c), Vec<Dim>{-change[c]});
  }
  for (const Pushing& pushing : pushed.contacts)
    pushed.bodies[static_cast<std::size_t>(pushing.body)].push -=
        pushing.share * change[static_cast<std::size_t>(pushing.contact)];
}

}  // namespace detail

/// solve_nlgs with adhesion: the velocities of the system, and the pushes of bodies, include (p_n - a, p_t)
/// before and after. Sweeps at a given a, and a from the gaps that they leave, follow each other until the
/// law holds with both (docs/decisions/0056). Without adhesion it is solve_nlgs.
template <int Dim, ContactSystem<Dim> System>
SolverReport solve_adhesive(System& system, AdhesiveContacts& adhesion, PushedBodies& pushed,
                            std::span<Vec<Dim>> impulse, std::span<const double> friction,
                            const SolverOptions& options) {
  if (adhesion.contact.empty()) return solve_nlgs<Dim>(system, impulse, friction, options);
  constexpr int most_passes = 15;
  SolverOptions inner = options;  // what sweeps at a given a leave is noise to the next a
  inner.tolerance *= 0.02;
  inner.max_sweeps *= 4;
  FixedPoint fixed_point;
  std::vector<double> change(impulse.size()), next;
  SolverReport report = solve_nlgs<Dim>(system, impulse, friction, inner);
  for (int pass = 1;; ++pass) {
    const Violation violation =
        detail::attraction_change<Dim>(system, adhesion, pushed, std::span<const Vec<Dim>>(impulse), change);
    const SolverReport attracted = report_of(violation, 0, options.velocity_scale, options);
    report.residual_mean = std::max(report.residual_mean, attracted.residual_mean);
    report.residual_max = std::max(report.residual_max, attracted.residual_max);
    report.converged = report.residual_mean <= options.tolerance &&
                       report.residual_max <= options.worst_factor * options.tolerance;
    next.assign(adhesion.attraction.begin(), adhesion.attraction.end());
    if (report.converged) {  // what short steps change is below the tolerance, but adds up
      for (std::size_t c = 0; c < next.size(); ++c) next[c] += change[c];
      detail::set_attraction<Dim>(system, adhesion, pushed, next);
      return report;
    }
    if (pass == most_passes || !std::isfinite(report.residual_mean)) return report;
    fixed_point.improve(next, change);
    detail::set_attraction<Dim>(system, adhesion, pushed, next);
    const int sweeps = report.sweeps;
    report = solve_nlgs<Dim>(system, impulse, friction, inner);
    report.sweeps += sweeps;
  }
}

}  // namespace softgrain
