#pragma once
#include <span>
#include <vector>

#include "softgrain/contact/adhesive_contacts.hpp"
#include "softgrain/soft/by_kinds.hpp"
#include "softgrain/soft/outline_contacts.hpp"

namespace softgrain {

/// Adhesion of outlines by pair of kinds. Each vertex stands for half of the segments beside it on the
/// undeformed outline, at a wall with all of that length and against another grain with half, as the other
/// grain's vertices stand for the same faces.
class OutlineAdhesion {
 public:
  OutlineAdhesion() = default;
  /// Raises UsageError for a surface energy < 0 or a range <= 0, and for kinds that are not there.
  OutlineAdhesion(const SoftGrains& grains, std::span<const PairAdhesion> named);

  bool any() const { return range_ > 0; }
  double range() const { return range_; }  ///< the longest [m]
  /// Does a kind adhere to another, or to walls (PairAdhesion::wall)?
  bool adhere(int kind, int other) const { return law_.of(kind, other).any(); }
  /// For the contact solver, in a step of state.dt; at_end: see AdhesiveContact. attraction: (contacts), kept
  /// by reference. Without adhesion none.
  AdhesiveContacts contacts(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                            const OutlineState& state, bool at_end, std::span<double> attraction) const;
  /// sum of length Phi(g) [J/m]; gap(contact) [m].
  template <class Gap>
  double energy(const SoftGrains& grains, std::span<const OutlineContact> contacts, const Gap& gap) const {
    double sum = 0;
    for (const OutlineContact& contact : contacts) {
      const Adhesion& law = value_of(law_, grains, contact);
      if (law.any()) sum += length_of(contact) * law.energy(gap(contact));
    }
    return sum;
  }

 private:
  double length_of(const OutlineContact& contact) const {
    return (contact.wall >= 0 ? 1 : 0.5) * length_[contact.vertex];
  }

  double range_ = 0;
  ByKinds<Adhesion> law_;
  std::vector<double> length_;  // (outline vertices) [m]
};

/// Of the contacts at the start of the step [J/m].
double energy_at_start(const AdhesiveContacts& contacts);

/// Impulses that bodies feel, (p_n - a, p_t); attraction: (contacts), or empty where nothing attracts.
std::vector<Vec<2>> felt_impulses(std::span<const Vec<2>> impulse, std::span<const double> attraction);

/// Attractions of `old` contacts, as carried_impulses.
std::vector<double> carried_attraction(const SoftGrains& grains, std::span<const OutlineContact> old,
                                       std::span<const double> old_attraction,
                                       std::span<const OutlineContact> contacts);

}  // namespace softgrain
