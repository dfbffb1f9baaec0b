#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "softgrain/contact/signorini_coulomb.hpp"
#include "softgrain/contact/solver_options.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// How far the contacts were from their law when a sweep came to them. The violation of a contact is the jump
/// of its velocity when its own impulse alone puts it right, v_c = |W_cc (p_c' - p_c)| [m/s]: zero exactly
/// where the law holds, whatever the conditioning of W_cc. Without friction v_c = |min(W_nn p_n, u_n)|.
struct Violation {
  double sum_of_squares = 0;  ///< of v_c [m^2/s^2]
  double max_square = 0;      ///< of v_c [m^2/s^2]
  int contacts = 0;           ///< those that carry impulse or are violated

  /// Counts a contact by its v_c^2 and whether it carries impulse after the update.
  void add(double square, bool carries_impulse) {
    if (!carries_impulse && square == 0) return;
    sum_of_squares += square;
    max_square = square <= max_square ? max_square : square;  // keeps NaN
    ++contacts;
  }
};

/// The report of a solve that ends with this violation; `velocity_scale` [m/s] > 0 makes it unit-free.
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

/// Euclidean norm over all contacts of the natural map p - P(p - (u + mu |u_t| n)), P the projection on the
/// Coulomb cone (De Saxce & Feng 1998). Zero exactly where Signorini's and Coulomb's laws hold. It adds
/// impulses to velocities with rho = 1 in the units of the file, as Siconos' fc2d_compute_error and
/// fc3d_compute_error do; divide by |q| for theirs.
template <int Dim>
double natural_map_residual(std::span<const Vec<Dim>> impulse, std::span<const Vec<Dim>> velocity,
                            std::span<const double> friction) {
  double sum = 0;
  for (std::size_t c = 0; c < impulse.size(); ++c) {
    const Vec<Dim>& p = impulse[c];
    Vec<Dim> shifted = velocity[c];  // u + mu |u_t| n
    shifted[0] = 0;
    shifted[0] = velocity[c][0] + friction[c] * norm(shifted);
    const Vec<Dim> defect = p - project_on_coulomb_cone(p - shifted, friction[c]);
    sum += dot(defect, defect);
  }
  return std::sqrt(sum);
}

/// E = 1/2 p.W p + q.p = 1/2 p.(u + q) [J], the energy that contact takes from (E < 0) the motion.
template <int Dim>
double contact_energy(std::span<const Vec<Dim>> impulse, std::span<const Vec<Dim>> velocity,
                      std::span<const Vec<Dim>> free_velocity) {
  double energy = 0;
  for (std::size_t c = 0; c < impulse.size(); ++c)
    energy += dot(impulse[c], velocity[c] + free_velocity[c]) / 2;
  return energy;
}

}  // namespace softgrain
