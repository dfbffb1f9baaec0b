#pragma once
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/law.hpp"
#include "softgrain/contact/pushed_bodies.hpp"
#include "softgrain/contact/solver_options.hpp"
#include "softgrain/contact/tangents.hpp"
#include "softgrain/rigid/activation.hpp"
#include "softgrain/rigid/contacts.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// The choices of the contact law beside friction.
struct ContactLaw {
  double restitution = 0;  ///< e_n in [0, 1], Newton's
  double push_out = 0.1;   ///< beta in [0, 1]: share of an existing overlap that a step removes
  Activation activation = Activation::anticipated;
};

/// Offset of a contact that does not exist in this step [m/s]: so large that no impulse ever answers it.
inline constexpr double inactive_offset = 1e30;

/// q_n - u_n,free of each contact [m/s] (theory (6)-(8)): max(g, 0)/dt + beta min(g, 0)/dt if anticipated;
/// else e u_n^-, or inactive_offset. `velocity_start` (bodies) [m/s] is that of the start of the step: u_n^-
/// comes from it. Or of the contacts from `begin` on, as many as `offset` holds.
template <int Dim>
void signorini_offset(const RigidContacts<Dim>& contacts, std::span<const Vec<Dim>> velocity_start,
                      const ContactLaw& law, double dt, std::vector<double>& offset);
template <int Dim>
void signorini_offset(const RigidContacts<Dim>& contacts, std::span<const Vec<Dim>> velocity_start,
                      const ContactLaw& law, double dt, int begin, std::span<double> offset);

/// u of a contact in its local axes [m/s], from the velocities and spins of the bodies, and of the image that
/// body b is met through.
template <int Dim>
Vec<Dim> relative_velocity(const RigidContacts<Dim>& contacts, int contact,
                           std::span<const Vec<Dim>> velocity, std::span<const Spin<Dim>> spin);

/// Rigid disks and spheres as a ContactSystem: the bodies' velocities carry all impulses, W is never formed.
///
/// With spins s = R omega and kappa = m R^2/I (theory (12)):
///   u = (v_b - v_a) - (s_a + s_b) x n,   W_nn = 1/m_a + 1/m_b,   W_tt = (1 + kappa) W_nn,   W_nt = 0.
template <int Dim>
class RigidContactSystem {
 public:
  /// Keeps references; `offset` (m) [m/s] as from signorini_offset.
  RigidContactSystem(RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts,
                     std::span<const double> offset)
      : particles_(particles), contacts_(contacts), offset_(offset) {}

  int size() const { return contacts_.size(); }
  Mat<Dim> delassus_block(int contact) const;
  Vec<Dim> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<Dim>& dp);

  /// v += M^-1 H p for all contacts (warm start), or for those of a block.
  void apply_impulses(std::span<const Vec<Dim>> impulse);
  void apply_impulses(int block, std::span<const Vec<Dim>> impulse);

  /// One sweep of NLGS, grain by grain on all threads and then between grains, four contacts at once in the
  /// plane; the same law as the plain sweep, and the same bits on any number of threads.
  Violation sweep(std::span<Vec<Dim>> impulse, std::span<const double> friction,
                  const SolverOptions& options);
  /// v <- v + b (v - v'), also spins and pushed bodies, v' those when this was last called.
  void extrapolate(double b);
  /// Sweeps then move these bodies too. Keeps a reference.
  void push(PushedBodies& bodies) { pushed_ = &bodies; }

 private:
  /// One contact of the sweep, for those that do not fill four lanes, and for spheres.
  void relax_contact(int contact, Vec<Dim>& impulse, double friction, double relaxation,
                     LaneViolation<double>& violation);

  Violation sweep_block(int block, std::span<Vec<Dim>> impulse, std::span<const double> friction,
                        double relaxation);

  RigidParticles<Dim>& particles_;
  const RigidContacts<Dim>& contacts_;
  std::span<const double> offset_;
  PushedBodies* pushed_ = nullptr;
  std::vector<Vec<Dim>> velocity_before_;
  std::vector<Spin<Dim>> spin_before_;
};

}  // namespace softgrain
