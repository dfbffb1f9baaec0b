#pragma once
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/mpm/outline_contacts.hpp"

namespace softgrain {

/// Contacts of explicit grains as a ContactSystem: the outline's lumped masses answer at once,
///   u = v_slave - (1 - xi) v_0 - xi v_1 (+ g/dt along n),   W = (1/m_slave + (1 - xi)^2/m_0 + xi^2/m_1) 1.
class LumpedContacts {
 public:
  /// velocity: (outline vertices) [m/s], changed by impulses; inverse_mass: (outline vertices) [m/kg];
  /// push_out beta: share of a penetration that a step removes. Keeps references.
  LumpedContacts(std::span<const OutlineContact> contacts, std::span<const Wall<2>> walls,
                 std::span<Vec<2>> velocity, std::span<const double> inverse_mass, double dt,
                 double push_out);

  int size() const { return static_cast<int>(contacts_.size()); }
  Mat<2> delassus_block(int contact) const {
    return Mat<2>::diagonal({delassus_[contact], delassus_[contact]});
  }
  Vec<2> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<2>& dp);

 private:
  std::span<const OutlineContact> contacts_;
  std::span<const Wall<2>> walls_;
  std::span<Vec<2>> velocity_;
  std::span<const double> inverse_mass_;
  std::vector<double> delassus_, offset_;
};

}  // namespace softgrain
