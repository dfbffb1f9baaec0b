#pragma once
#include <vector>

#include "softgrain/contact/delassus_system.hpp"

namespace softgrain {

/// A frictional contact problem by itself, without bodies: u = W p + q with Signorini's and Coulomb's laws.
/// Local vectors are (normal, tangent) in 2D, (normal, tangent, tangent) in 3D, contact after contact.
struct ContactProblem {
  int dimension = 2;             ///< 2 or 3
  std::vector<MatrixEntry> W;    ///< Delassus matrix [1/kg], dimension x contacts rows and columns
  std::vector<double> q;         ///< free velocity [m/s], length dimension x contacts
  std::vector<double> friction;  ///< mu >= 0 of each contact

  int contacts() const { return static_cast<int>(friction.size()); }
};

/// A problem, and the impulses that somebody found for it.
struct SolvedContactProblem {
  ContactProblem problem;
  std::vector<double> impulse;  ///< p [N s], length dimension x contacts
};

/// The same problem with impulses in units that make the mean W_nn 1 (1/W_nn kg instead of kg): W and p
/// become of the order of 1 and u, and the natural map, which adds p to u, weighs them alike.
SolvedContactProblem in_natural_units(SolvedContactProblem solved);

/// automatic: Nesterov's and NLGS by turns, each from where it was, until one converges.
enum class ContactMethod { automatic, nesterov, nlgs };

struct ContactProblemOptions {
  ContactMethod method = ContactMethod::automatic;
  double tolerance = 1e-8;  ///< on the natural-map residual over |q|
  int max_sweeps = 100000;  ///< of each method
};

/// The best iterate that was seen.
struct ContactSolution {
  std::vector<double> impulse;                     ///< p [N s], not unique
  std::vector<double> velocity;                    ///< u = W p + q [m/s]
  ContactMethod method = ContactMethod::nesterov;  ///< that found it
  int sweeps = 0;  ///< of that method: sweeps of NLGS or iterations of Nesterov's
  /// |natural map| / |q| with impulses in units of 1/mean W_nn, so that no unit matters; in these units that
  /// of Siconos' fc2d_compute_error and fc3d_compute_error
  double residual = 0;
  double energy = 0;       ///< 1/2 p.W p + q.p [J]
  bool converged = false;  ///< residual <= tolerance
};

/// What given impulses are worth, with 0 sweeps; `tolerance` decides whether they count as converged.
ContactSolution assess_impulses(const SolvedContactProblem& solved, double tolerance);

/// Solves from p = 0 until the tolerance, max_sweeps, or a residual that has not fallen for 20 000 sweeps and
/// four fifths of all. Returns the better of both methods where neither converges.
ContactSolution solve_contact_problem(const ContactProblem& problem, const ContactProblemOptions& options);

}  // namespace softgrain
