#pragma once
#include <algorithm>
#include <vector>

#include "softgrain/geometry/periodic_cell.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Contacts begin .. end - 1, swept in this order. Up to `fours_end` each four in turn share no particle, so
/// that they are solved at once.
struct ContactBatch {
  int begin = 0, fours_end = 0, end = 0;
};

/// The contacts inside a grain, or those between grains and with walls.
struct ContactBlock {
  ContactBatch frictionless, frictional;  ///< one after the other
  ContactBatch pressed;                   ///< then those with walls of presses, which take their turns alone
  ContactBatch crossing;  ///< then those with images across the edge of a periodic cell, which do so too
  int list = 0;           ///< of NeighbourReference that it was made from
  int made = 0;           ///< when, as NeighbourReference::made
  /// Has it contacts, and with friction? Of a grain of another rank this alone is known.
  bool any = false, rough = false;

  int begin() const { return frictionless.begin; }
  int end() const { return std::max({frictional.end, pressed.end, crossing.end}); }
  /// The same, where its contacts start at `begin`.
  void move_to(int begin) {
    const int shift = begin - frictionless.begin;
    for (ContactBatch* batch : {&frictionless, &frictional, &pressed, &crossing})
      batch->begin += shift, batch->fours_end += shift, batch->end += shift;
  }
};

/// Candidate contacts, in the order of the sweep: all pairs that could touch before the next rebuild. Open
/// ones stay in the arrays with impulse 0, so that warm start and colours survive from step to step
/// (docs/decisions/0005).
///
/// Local axes: the normal n from a to b, then the tangents of `tangents(n)`.
template <int Dim>
struct RigidContacts {
  std::vector<int> body_a, body_b;  ///< (m) a < b: particles, then walls (RigidParticles); a is never a wall
  std::vector<double> inverse_mass_a;    ///< (m) [1/kg]
  std::vector<double> inverse_mass_b;    ///< (m) [1/kg], 0 for walls
  std::vector<double> inverse_delassus;  ///< (m) 1 / W_nn [kg]
  std::vector<double> friction;          ///< (m) mu
  std::vector<Vec<Dim>> normal;          ///< (m) unit, from a to b
  std::vector<double> gap;               ///< (m) [m], open > 0
  std::vector<Vec<Dim>> impulse;         ///< (m) (p_n, p_t) [N s/m in 2D]
  /// Those inside grains, which share no particle: of each grain that has any, with ranks of each grain. Then
  /// the one between them
  std::vector<ContactBlock> blocks;
  PeriodicCell<Dim> cell;                                ///< where gaps were measured
  std::vector<typename PeriodicCell<Dim>::Image> image;  ///< of body b of the last contacts, which cross it

  int size() const { return static_cast<int>(body_a.size()); }
  /// The first contact that crosses the edge of the cell.
  int first_crossing() const { return size() - static_cast<int>(image.size()); }
  /// Where body b is seen from a, from where it is itself [m].
  Vec<Dim> shift(int contact) const {
    return contact < first_crossing() ? Vec<Dim>{} : cell.shift(image[contact - first_crossing()]);
  }
  /// How much faster that image goes than body b [m/s].
  Vec<Dim> image_velocity(int contact) const {
    return contact < first_crossing() ? Vec<Dim>{} : cell.velocity(image[contact - first_crossing()]);
  }
  void resize(int size) {
    body_a.resize(size), body_b.resize(size);
    inverse_mass_a.resize(size), inverse_mass_b.resize(size), inverse_delassus.resize(size);
    friction.resize(size), normal.resize(size), gap.resize(size), impulse.resize(size);
  }
};

}  // namespace softgrain
