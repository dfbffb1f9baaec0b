#pragma once
#include <span>
#include <vector>

#include "softgrain/contact/pair_friction.hpp"
#include "softgrain/soft/by_kinds.hpp"
#include "softgrain/soft/contact_of.hpp"

namespace softgrain {

/// Coulomb's mu of every pair of kinds.
class FrictionByKind {
 public:
  FrictionByKind() = default;
  /// mu between grains and against walls, but of the pairs that are named. Raises UsageError for mu < 0 and
  /// for kinds that are not there.
  FrictionByKind(int kinds, double between_grains, double at_walls, std::span<const PairFriction> named);

  double between(int kind, int other) const { return mu_.of(kind, other); }
  double at_walls(int kind) const { return mu_.of(kind, PairFriction::wall); }
  /// mu of each contact.
  template <int Dim>
  std::vector<double> of(const GrainsOf<Dim>& grains, Contacts<Dim> contacts) const;
  bool operator==(const FrictionByKind&) const = default;

 private:
  ByKinds<double> mu_;
};

}  // namespace softgrain
