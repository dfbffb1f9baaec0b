#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/soft/outline_contacts.hpp"

namespace softgrain {

/// A rigid grain in an explicit step.
struct LumpedBody {
  Vec<2> centre;    ///< x_c where contacts take place and normal, OutlineState::normals_at of the step [m]
  Vec<2> velocity;  ///< [m/s]
  double spin = 0;  ///< [1/s]
  double inverse_mass = 0, inverse_inertia = 0;  ///< [m/kg], [m/(kg m^2)]

  Vec<2> velocity_at(const Vec<2>& x) const { return velocity + spin * perpendicular(x - centre); }
};

/// Which vertices belong to rigid grains.
struct LumpedBodies {
  std::vector<LumpedBody> body;
  std::vector<int> of_vertex;  ///< (outline vertices) number of the body, or -1; empty if there are none

  int at(int vertex) const { return of_vertex.empty() ? -1 : of_vertex[static_cast<std::size_t>(vertex)]; }
};

/// The contacts of rigid grains among those of LumpedContacts: with a = e_z x sum_k w_k (x_k - x_c) and
/// w = sum_k w_k over the vertices that a contact has on a body,
///   u = sum over soft vertices of w_k v_k + sum over bodies of (w v_c + a omega),
///   W = sum w_k^2/m_k 1 + sum (w^2/m 1 + a a^T/I).
/// A body meets contacts all around it: they are swept one after the other, so that any number of threads
/// gives the same bits.
class BodyContacts {
 public:
  /// As LumpedContacts; keeps a reference to the bodies too, which have the velocities u_found now.
  BodyContacts(std::span<const OutlineContact> contacts, const OutlineState& outline,
               std::span<Vec<2>> velocity, std::span<const double> inverse_mass, LumpedBodies& bodies);

  bool has(int contact) const { return !row_of_.empty() && row_of_[static_cast<std::size_t>(contact)] >= 0; }
  std::span<const int> contacts() const { return contact_; }
  const Mat<2>& delassus_block(int contact) const { return row(contact).delassus; }
  Vec<2> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<2>& dp);

 private:
  struct Side {
    int body = -1;
    double weight = 0;
    Vec<2> arm;  // a
  };
  struct Row {
    int vertices = 0;  // of soft grains
    std::array<int, 5> vertex{};
    std::array<double, 5> weight{}, mobility{};
    std::array<Side, 2> side;
    Vec<2> normal, offset;
    Mat<2> delassus;
  };
  const Row& row(int contact) const { return rows_[row_of_[static_cast<std::size_t>(contact)]]; }
  Row make_row(const OutlineContact& contact, const OutlineState& outline,
               std::span<const double> inverse_mass) const;
  Vec<2> velocity_of(const Row& row) const;

  std::vector<Row> rows_;
  std::vector<int> contact_;  // of each row
  std::vector<int> row_of_;   // (all contacts) or -1; empty if there are no bodies
  std::span<Vec<2>> velocity_;
  LumpedBodies& bodies_;
};

/// In space, where no grain is rigid yet.
class NoBodyContacts {
 public:
  NoBodyContacts(auto&&...) {}
  bool has(int /*contact*/) const { return false; }
  std::span<const int> contacts() const { return {}; }
  Mat<3> delassus_block(int /*contact*/) const { return {}; }
  Vec<3> relative_velocity(int /*contact*/) const { return {}; }
  void apply_impulse(int /*contact*/, const Vec<3>& /*dp*/) {}
};

}  // namespace softgrain
