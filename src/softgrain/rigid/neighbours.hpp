#pragma once
#include <array>
#include <functional>
#include <vector>

#include "softgrain/rigid/contacts.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// Coefficient of friction between two bodies (a particle, and a particle or wall): any rule on their
/// indices.
using FrictionRule = std::function<double(int body_a, int body_b)>;

/// The particles begin .. end - 1 of a grain.
struct GrainRange {
  int begin = 0, end = 0;
};

/// The positions from which the lists of pairs were last made. A list holds all pairs within its reach +
/// skin; it is complete as long as no two bodies, walls included, have approached by more than the skin.
template <int Dim>
struct NeighbourReference {
  double skin = 0;                   ///< [m]
  std::vector<Vec<Dim>> position;    ///< (n) [m]
  std::vector<Vec<Dim>> wall_point;  ///< (walls) [m]
  int generation = 0;                ///< counts the rebuilds

  std::vector<GrainRange> grains{};         ///< all particles, grain by grain
  std::vector<std::array<int, 2>> close{};  ///< grains g < h, or g and wall h - grains.size(), that may meet
                                            ///< before one of them has gone `far`
  double far = 0;                           ///< [m]
};

/// True if some pair might be missing. Grains that move as a whole stay where they are for their own
/// particles: with D the mean displacement of a grain since the reference and d the largest of a particle
/// about it, two particles of one grain have approached by at most 2 d, those of two by d + d' + |D - D'|,
/// which may reach 90 % of the skin.
template <int Dim>
bool needs_rebuild(const NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles);

/// Takes the present positions as reference, or those given (restart).
template <int Dim>
void set_reference(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles);
template <int Dim>
void set_reference(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles,
                   std::vector<Vec<Dim>> position, std::vector<Vec<Dim>> wall_point);

/// All candidate contacts with gap < skin at the reference: a block for the inside of each grain that has
/// any, then the block of those between grains and with walls. Impulses of `old` contacts are carried over by
/// (a, b). The order depends on the reference alone.
template <int Dim>
RigidContacts<Dim> candidate_contacts(const RigidParticles<Dim>& particles,
                                      const NeighbourReference<Dim>& reference, const FrictionRule& friction,
                                      const RigidContacts<Dim>& old);

/// Gaps and normals at the present positions, in place. A pair of coincident centres raises NumericalError.
template <int Dim>
void detect_contacts(const RigidParticles<Dim>& particles, RigidContacts<Dim>& contacts);

}  // namespace softgrain
