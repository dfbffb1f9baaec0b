#pragma once
#include <optional>
#include <span>
#include <vector>

#include "softgrain/contact/adhesion.hpp"
#include "softgrain/rigid/contacts.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// Attraction between primaries of two grains, and between primaries and walls: adhesion (theory (78)) of the
/// face that each pair stands for, l = a_i + a_j wide, in space l^2 large, at a wall l = 2 a_i,
///   F = l t(g) [N/m],  in space l^2 t(g) [N];  F0 = 2 w l/delta under overlap, 0 beyond the range delta.
/// It acts over the candidate contacts between grains, whose list must reach as far as it does.
template <int Dim>
class SurfaceAttraction {
 public:
  SurfaceAttraction() = default;
  /// The kind of each grain; nothing named: none attract. Raises UsageError as adhesion_by_kinds.
  SurfaceAttraction(std::vector<int> kind_of_grain, int kinds, std::span<const PairAdhesion> named);

  bool any() const { return range_ > 0; }
  double range() const { return range_; }  ///< the longest [m]

  /// Adds the forces on particles and, after them, walls [N/m, N in space]. Returns the power that the cell
  /// puts in by moving images: sum F . (dH/dt) n [W/m, W in space].
  double add_forces(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts,
                    std::span<Vec<Dim>> force) const;
  /// sum over pairs of l Phi(g), in space l^2 Phi(g), where the particles are [J/m, J in space].
  double energy(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts) const;
  /// F of a contact at its gap [N/m, N in space].
  double force(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts, int contact) const {
    return pull(particles, contacts, contact, contacts.gap[contact]);
  }

 private:
  struct Pair {
    Adhesion law;
    double face = 0;  // l or l^2 [m, m^2]
  };
  std::optional<Pair> pair(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts,
                           int contact) const;
  double pull(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts, int contact,
              double gap) const;

  double range_ = 0;
  std::vector<int> kind_of_grain_;
  ByKinds<Adhesion> law_;
};

}  // namespace softgrain
