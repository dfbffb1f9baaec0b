#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/law.hpp"
#include "softgrain/contact/solver_options.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Root mean square over contacts of the velocity that the others give, u_c - W_cc p_c [m/s]; from p = 0 that
/// of q. 1 when nothing moves.
template <int Dim, ContactSystem<Dim> System>
double typical_velocity(const System& system, std::span<const Vec<Dim>> impulse) {
  double sum = 0;
  for (int c = 0; c < system.size(); ++c) {
    const Vec<Dim> q = system.relative_velocity(c) - system.delassus_block(c) * impulse[c];
    sum += dot(q, q);
  }
  return sum > 0 ? std::sqrt(sum / system.size()) : 1;
}

/// The unit-free report: converged iff rms(v_c) <= tolerance and max(v_c) <= worst_factor tolerance, in units
/// of velocity_scale [m/s] > 0.
inline SolverReport report_of(const Violation& violation, int sweeps, double velocity_scale,
                              const SolverOptions& options) {
  SolverReport report{.sweeps = sweeps};
  report.residual_mean =
      std::sqrt(violation.sum_of_squares / std::max(violation.contacts, 1)) / velocity_scale;
  report.residual_max = std::sqrt(violation.max_square) / velocity_scale;
  report.converged = report.residual_mean <= options.tolerance &&
                     report.residual_max <= options.worst_factor * options.tolerance;
  return report;
}

/// u + mu |u_t| n: with it Signorini's and Coulomb's laws are one complementarity on the Coulomb cone K and
/// its dual, K* contains u + mu |u_t| n _|_ p in K (De Saxce & Feng 1998).
template <int Dim>
Vec<Dim> de_saxce_velocity(Vec<Dim> u, double mu) {
  const double normal = u[0];
  u[0] = 0;
  u[0] = normal + mu * norm(u);
  return u;
}

/// Euclidean norm over all contacts of the natural map p - P(p - (u + mu |u_t| n)), P the projection on the
/// Coulomb cone. Zero exactly where the laws hold. It adds impulses to velocities, rho = 1 in the units
/// given, as Siconos' fc2d_compute_error and fc3d_compute_error do; divided by |q| it is theirs.
template <int Dim>
double natural_map_residual(std::span<const Vec<Dim>> impulse, std::span<const Vec<Dim>> velocity,
                            std::span<const double> friction) {
  double sum = 0;
  for (std::size_t c = 0; c < impulse.size(); ++c) {
    const Vec<Dim> moved = impulse[c] - de_saxce_velocity(velocity[c], friction[c]);
    const Vec<Dim> defect = impulse[c] - project_on_coulomb_cone(moved, friction[c]);
    sum += dot(defect, defect);
  }
  return std::sqrt(sum);
}

/// E = 1/2 p.W p + q.p = 1/2 p.(u + q) [J]: what the impulses add to the kinetic energy, < 0 where they
/// dissipate.
template <int Dim>
double contact_energy(std::span<const Vec<Dim>> impulse, std::span<const Vec<Dim>> velocity,
                      std::span<const Vec<Dim>> free_velocity) {
  double energy = 0;
  for (std::size_t c = 0; c < impulse.size(); ++c)
    energy += dot(impulse[c], velocity[c] + free_velocity[c]) / 2;
  return energy;
}

}  // namespace softgrain
