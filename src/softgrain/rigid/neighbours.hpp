#pragma once
#include <functional>
#include <vector>

#include "softgrain/rigid/contacts.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// Coefficient of friction between two bodies (a particle, and a particle or wall): any rule on their
/// indices.
using FrictionRule = std::function<double(int body_a, int body_b)>;

/// The positions from which the lists of pairs were last made. A list holds all pairs within its reach +
/// skin; it is complete as long as no two bodies, walls included, have approached by more than the skin.
template <int Dim>
struct NeighbourReference {
  double skin = 0;                   ///< [m]
  std::vector<Vec<Dim>> position;    ///< (n) [m]
  std::vector<Vec<Dim>> wall_point;  ///< (walls) [m]
  int generation = 0;                ///< counts the rebuilds
};

/// True if some pair might be missing: twice the largest displacement since the reference exceeds 90 % of the
/// skin.
template <int Dim>
bool needs_rebuild(const NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles);

/// Takes the present positions as reference.
template <int Dim>
void set_reference(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles);

/// All candidate contacts with gap < skin at the reference, coloured: frictionless batches first, then
/// frictional ones. Impulses of `old` contacts are carried over by (a, b). The order depends on the reference
/// alone.
template <int Dim>
RigidContacts<Dim> candidate_contacts(const RigidParticles<Dim>& particles,
                                      const NeighbourReference<Dim>& reference, const FrictionRule& friction,
                                      const RigidContacts<Dim>& old);

/// Gaps and normals at the present positions, in place. A pair of coincident centres raises NumericalError.
template <int Dim>
void detect_contacts(const RigidParticles<Dim>& particles, RigidContacts<Dim>& contacts);

}  // namespace softgrain
