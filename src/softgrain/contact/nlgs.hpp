#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/extrapolate.hpp"
#include "softgrain/contact/law.hpp"
#include "softgrain/contact/residual.hpp"
#include "softgrain/contact/signorini_coulomb.hpp"
#include "softgrain/contact/solver_options.hpp"

namespace softgrain {

/// A system may bring its own sweep: the same mathematics as nlgs_sweep, fused with its data, in an order
/// that its contacts determine.
template <class S, int Dim>
concept HasOwnSweep = requires(S& s, std::span<Vec<Dim>> impulse, std::span<const double> friction,
                               const SolverOptions& options) {
  { s.sweep(impulse, friction, options) } -> std::same_as<Violation>;
};

/// A system whose sweeps may start ahead of where the last one ended: extrapolate(b) makes its velocities
/// v + b (v - v'), v' those when it was last called.
template <class S>
concept Extrapolates = requires(S& s, double b) {
  {s.extrapolate(b)};
};

/// Nesterov's momentum around the sweeps: sweep k + 1 starts from
///   y = p_k + b (p_k - p_k-1),
/// b of Momentum: 0 once the violation has grown. The velocities are linear in p, so that they go ahead
/// alike; a sweep puts every impulse right, so that y may leave the cones of friction.
template <int Dim>
class Extrapolation {
 public:
  /// Before a sweep.
  template <Extrapolates System>
  void go_ahead(System& system, std::span<Vec<Dim>> impulse) {
    const double b = momentum_.next();
    before_.resize(impulse.size());
    for (std::size_t c = 0; c < impulse.size(); ++c) softgrain::extrapolate(impulse[c], before_[c], b);
    system.extrapolate(b);
  }
  /// After it.
  void see(const Violation& violation) { momentum_.see(violation.sum_of_squares); }

 private:
  Momentum momentum_;
  std::vector<Vec<Dim>> before_;
};

/// The turn of one contact: it is solved exactly with the others frozen,
///   q_c = u_c - W_cc p_c,  p_c <- P(p_c + omega (p_c' - p_c)),  p_c' the solution of one contact under q_c,
/// and the bodies move at once; P, the projection on the Coulomb cone, acts only for omega > 1.
template <int Dim, ContactSystem<Dim> System>
void nlgs_update(System& system, int c, Vec<Dim>& p, double mu, double relaxation, Violation& violation) {
  const Vec<Dim> u = system.relative_velocity(c);
  if (u[0] >= 0 && p == Vec<Dim>{}) return;  // open, and it stays so
  const Mat<Dim> W = system.delassus_block(c);
  const Vec<Dim> solved = solve_signorini_coulomb(W, u - W * p, mu);
  violation.add(W * (solved - p), solved[0]);
  const Vec<Dim> next = relaxed_impulse(p, solved, mu, relaxation);
  const Vec<Dim> dp = next - p;
  if (dp == Vec<Dim>{}) return;
  p = next;
  system.apply_impulse(c, dp);
}

/// One pass of nonlinear Gauss-Seidel over the contacts in the order given. Returns the violation that each
/// contact showed when its turn came. Allocates nothing.
template <int Dim, ContactSystem<Dim> System>
Violation nlgs_sweep(System& system, std::span<Vec<Dim>> impulse, std::span<const double> friction,
                     double relaxation) {
  Violation violation;
  for (int c = 0; c < system.size(); ++c)
    nlgs_update<Dim>(system, c, impulse[c], friction[c], relaxation, violation);
  return violation;
}

/// The system's own sweep, or the plain one.
template <int Dim, ContactSystem<Dim> System>
Violation sweep_once(System& system, std::span<Vec<Dim>> impulse, std::span<const double> friction,
                     const SolverOptions& options) {
  if constexpr (HasOwnSweep<System, Dim>)
    return system.sweep(impulse, friction, options);
  else
    return nlgs_sweep<Dim>(system, impulse, friction, options.relaxation);
}

/// Sweeps until the law holds everywhere to the tolerance, or max_sweeps. `sweep(measured)` is one sweep; it
/// returns its violation [m/s] only if `measured`, as every sweep that may be the last is.
template <class Sweep>
SolverReport repeat_sweeps(const Sweep& sweep, double velocity_scale, const SolverOptions& options) {
  SolverReport report;
  const int first_look = std::min(options.min_sweeps, options.max_sweeps);
  for (int k = 1; k <= options.max_sweeps; ++k) {
    const Violation violation = sweep(k >= first_look);
    if (k < first_look) continue;
    report = report_of(violation, k, velocity_scale, options);
    if (report.converged || !std::isfinite(report.residual_mean)) break;
  }
  return report;
}

/// Nonlinear Gauss-Seidel (Moreau, Jean): sweeps over the contacts in the order given until the law holds
/// everywhere to the tolerance, or max_sweeps. `impulse` [N s] is the start (warm start) and becomes the
/// solution; the velocities of `system` must already include it, and include the solution on return.
/// `friction` holds mu of every contact. Converged iff rms(v_c) <= tolerance and max(v_c) <= worst_factor
/// tolerance, in units of velocity_scale.
template <int Dim, ContactSystem<Dim> System>
SolverReport solve_nlgs(System& system, std::span<Vec<Dim>> impulse, std::span<const double> friction,
                        const SolverOptions& options) {
  const double scale =
      options.velocity_scale > 0 ? options.velocity_scale : typical_velocity<Dim>(system, impulse);
  Extrapolation<Dim> ahead;
  const auto sweep = [&](bool /*measured*/) {
    if constexpr (Extrapolates<System>)
      if (options.extrapolated) ahead.go_ahead(system, impulse);
    const Violation violation = sweep_once<Dim>(system, impulse, friction, options);
    ahead.see(violation);
    return violation;
  };
  return repeat_sweeps(sweep, scale, options);
}

}  // namespace softgrain
