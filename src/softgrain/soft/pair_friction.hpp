#pragma once
#include <span>
#include <vector>

#include "softgrain/soft/contact_of.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// mu of the contacts between grains of two kinds, or of a kind and walls.
struct PairFriction {
  static constexpr int wall = -1;
  int kind = 0;
  int other = wall;  ///< another kind, the same, or `wall`
  double mu = 0;
};

/// Coulomb's mu of every pair of kinds: a symmetric matrix, and one column for the walls.
class FrictionByKind {
 public:
  /// mu between grains and against walls, but of the pairs that are named. Raises UsageError for mu < 0 and
  /// for kinds that are not there.
  FrictionByKind(int kinds, double between_grains, double at_walls, std::span<const PairFriction> named);

  double between(int kind, int other) const { return between_[kind * kinds_ + other]; }
  double at_walls(int kind) const { return at_walls_[kind]; }
  /// mu of each contact.
  template <int Dim>
  std::vector<double> of(const GrainsOf<Dim>& grains, Contacts<Dim> contacts) const;

 private:
  int kinds_;
  std::vector<double> between_, at_walls_;
};

}  // namespace softgrain
