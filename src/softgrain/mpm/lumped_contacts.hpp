#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/residual.hpp"
#include "softgrain/mpm/outline_contacts.hpp"

namespace softgrain {

/// Contacts of explicit grains as a ContactSystem: the outline's lumped masses answer at once,
///   u = v_slave - sum_k w_k v_k,   W = (1/m_slave + sum_k w_k^2/m_k) 1,
/// with u_n changed to the gap at the end of the step over dt, (g + dt n . (u - u_found))/dt, where u_found
/// had brought the outlines to where the contacts were found.
class LumpedContacts {
 public:
  /// velocity: (outline vertices) [m/s], u_found when constructed, then changed by the caller and by
  /// impulses; inverse_mass: (outline vertices) [m/kg]. Keeps a reference to the velocities.
  LumpedContacts(std::span<const OutlineContact> contacts, std::span<const Wall<2>> walls,
                 std::span<Vec<2>> velocity, std::span<const double> inverse_mass, double dt);

  int size() const { return static_cast<int>(rows_.size()); }
  Mat<2> delassus_block(int contact) const {
    return Mat<2>::diagonal({rows_[contact].delassus, rows_[contact].delassus});
  }
  Vec<2> relative_velocity(int contact) const { return relative_velocity(rows_[contact]); }
  void apply_impulse(int contact, const Vec<2>& dp) { apply_impulse(rows_[contact], dp); }
  /// One pass of Gauss-Seidel. As W is a multiple of 1, a contact is solved by
  ///   p_n = max(0, p_n - u_n/W),  p_t = p_t - u_t/W, cut to |p_t| <= mu p_n.
  Violation sweep(std::span<Vec<2>> impulse, std::span<const double> friction, const SolverOptions& options);

 private:
  struct Row {
    int count = 1;                    // of vertices: the slave alone, or with four of a master
    std::array<int, 5> vertex{};      // the slave, then the master's
    std::array<double, 5> weight{1};  // 1, -w_k
    std::array<double, 5> answer{};   // weight/m: velocity by a unit impulse
    Vec<2> normal, offset;            // u = (n, t) . sum weight v + offset
    double delassus = 0;
  };
  Vec<2> relative_velocity(const Row& row) const;
  void apply_impulse(const Row& row, const Vec<2>& dp);

  std::vector<Row> rows_;
  std::span<Vec<2>> velocity_;
};

}  // namespace softgrain
