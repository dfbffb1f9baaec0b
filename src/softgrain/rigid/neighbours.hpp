#pragma once
#include <array>
#include <functional>
#include <vector>

#include "softgrain/core/shared_loop.hpp"
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

/// The positions from which the lists of pairs were last made: one list for the inside of each grain, and one
/// of the pairs between grains and with walls. A list holds all pairs within its reach + skin; it is complete
/// as long as no two of its bodies have approached by more than the skin.
template <int Dim>
struct NeighbourReference {
  double skin = 0;                   ///< [m]
  double reach = 0;                  ///< gap up to which the list between grains is complete [m]
  std::vector<Vec<Dim>> position;    ///< (n) [m] of the list inside the particle's grain
  std::vector<Vec<Dim>> between{};   ///< (n) [m] of the list between grains
  std::vector<Vec<Dim>> wall_point;  ///< (walls) [m] of the list between grains
  int generation = 0;                ///< counts the times when lists were made again
  std::vector<int> made{};  ///< (grains + 1) generation of each list, the last is that between grains
  std::vector<GrainRange> grains{};  ///< all particles, grain by grain
  bool shared = false;               ///< do ranks share what is done grain by grain?
  Shares shares{};                   ///< of grains: then who makes the lists inside them, and works on them

  /// Grains g < h, in which image, or g and wall h - grains.size(), that may meet before one has gone `far`
  struct Close {
    int g = 0, h = 0;
    typename PeriodicCell<Dim>::Image image{};
  };
  PeriodicCell<Dim> cell{};  ///< of the list between grains
  std::vector<Close> close{};
  std::vector<Vec<Dim>> centre{};  ///< (grains) of all particles of a grain, in `between` [m]
  double widest = 0;               ///< half of the largest grain [m]
  double far = 0;                  ///< [m]

  int between_list() const { return static_cast<int>(grains.size()); }
};

/// Takes the present positions as reference of the lists that might miss a pair, and of those more than half
/// way there: with ranks of the lists inside their own grains; before that of the list between grains is
/// taken, know_all() makes all positions known on all ranks. False if no list might miss one. Grains that
/// move as a whole stay where they are for their own particles: with D the mean displacement of a grain since
/// a reference and d the largest of a particle about it, two particles of one grain have approached by at
/// most 2 d, those of two by d + d' + |D - D'|, which may reach 90 % of the skin.
template <int Dim>
bool renew_stale_lists(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles,
                       const std::function<void()>& know_all = {});

/// Takes the present positions as reference of all lists.
template <int Dim>
void set_reference(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles);

/// Goes on from references given (restart).
template <int Dim>
void restore_reference(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles,
                       std::vector<Vec<Dim>> position, std::vector<Vec<Dim>> between,
                       std::vector<Vec<Dim>> wall_point, const PeriodicCell<Dim>& cell);

/// All candidate contacts with gap < skin at the reference, but for those inside grains of other ranks:
/// blocks for the insides of grains (RigidContacts::blocks), then the block of those between grains and with
/// walls. Blocks of `old`, made from this reference, are taken over where their list has not been made again;
/// else impulses are carried over by (a, b). The order depends on the reference alone. The memory of `room`
/// is used again.
template <int Dim>
RigidContacts<Dim> candidate_contacts(const RigidParticles<Dim>& particles,
                                      const NeighbourReference<Dim>& reference, const FrictionRule& friction,
                                      const RigidContacts<Dim>& old, RigidContacts<Dim> room = {});

/// Gaps and normals at the present positions and in the present cell, in place: of all contacts, or of begin
/// .. end - 1. Those of coincident centres are not finite.
template <int Dim>
void detect_contacts(const RigidParticles<Dim>& particles, RigidContacts<Dim>& contacts);
template <int Dim>
void detect_contacts(const RigidParticles<Dim>& particles, int begin, int end, RigidContacts<Dim>& contacts);

}  // namespace softgrain
