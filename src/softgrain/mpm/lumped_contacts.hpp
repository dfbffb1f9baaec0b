#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/mpm/outline_contacts.hpp"

namespace softgrain {

/// Contacts of explicit grains as a ContactSystem: the outline's lumped masses answer at once,
///   u = v_slave - sum_k w_k v_k,   W = (1/m_slave + sum_k w_k^2/m_k) 1,
/// with u_n changed to the gap at the end of the step over dt, (g + dt n . (u - u_found))/dt, where u_found
/// had brought the outlines to where the contacts were found.
class LumpedContacts {
 public:
  /// velocity: (outline vertices) [m/s], u_found when constructed, then changed by the caller and by
  /// impulses; inverse_mass: (outline vertices) [m/kg]. Keeps references.
  LumpedContacts(std::span<const OutlineContact> contacts, std::span<const Wall<2>> walls,
                 std::span<Vec<2>> velocity, std::span<const double> inverse_mass, double dt);

  int size() const { return static_cast<int>(contacts_.size()); }
  Mat<2> delassus_block(int contact) const {
    return Mat<2>::diagonal({delassus_[contact], delassus_[contact]});
  }
  Vec<2> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<2>& dp);

 private:
  Vec<2> velocity_between(int contact) const;

  std::span<const OutlineContact> contacts_;
  std::span<const Wall<2>> walls_;
  std::span<Vec<2>> velocity_;
  std::span<const double> inverse_mass_;
  std::vector<std::array<double, 4>> weight_;
  std::vector<double> delassus_, offset_;
};

}  // namespace softgrain
