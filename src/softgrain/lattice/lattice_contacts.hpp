#pragma once
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/geometry/wall.hpp"
#include "softgrain/lattice/lattice.hpp"

namespace softgrain {

/// One place where a grain meets another or a wall.
struct LatticeContact {
  int grain = 0;           ///< the slave
  int other = -1;          ///< the master grain; -1 for a wall
  int wall = -1;           ///< -1 for a grain
  int vertex = -1;         ///< of the slave's outline; -1 for a node
  Vec<2> normal{};         ///< unit, from the master to the slave
  double gap_rate = 0;     ///< added to u_n [m/s]: (gap of the free motion)/dt - n . u_free; 0 on nodes
  Vec<2> wall_velocity{};  ///< [m/s]
  Vec<2> node{};           ///< where the node is [m]; of a contact on nodes
};

/// Contacts of grains on a lattice as a ContactSystem, whether they meet on nodes or on outlines
/// (theory (59)-(60)):
///   u = sum_i w_i v_i - v_wall,   W = sum_i w_i^2 / m_i,
/// where i runs over nodes of the two grains' fields, with w < 0 for those of the master.
class LatticeContacts {
 public:
  explicit LatticeContacts(Lattice& lattice) : lattice_(lattice) {}

  /// weights: of slave and master, a node may stand there twice.
  void add(const LatticeContact& contact, std::span<const NodeWeight> weights);
  std::span<const LatticeContact> contacts() const { return contacts_; }
  std::span<const NodeWeight> weights_of(int contact) const {
    return std::span(weights_).subspan(begin_[contact], begin_[contact + 1] - begin_[contact]);
  }

  int size() const { return static_cast<int>(contacts_.size()); }
  Mat<2> delassus_block(int contact) const {
    return Mat<2>::diagonal({delassus_[contact], delassus_[contact]});
  }
  Vec<2> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<2>& dp);
  /// sum_i w_i v_i of any velocities of the nodes [m/s].
  Vec<2> combined(int contact, std::span<const Vec<2>> node_velocity) const;
  /// H p: w_i P of all contacts, added to that of each node [N s/m].
  void add_impulses(std::span<const Vec<2>> impulse, std::span<Vec<2>> of_nodes) const;

 private:
  Lattice& lattice_;
  std::vector<LatticeContact> contacts_;
  std::vector<NodeWeight> weights_;
  std::vector<int> begin_{0};
  std::vector<double> delassus_;
};

/// Contacts on nodes, as in the paper's method: two grains where both have more than `least_mass` [kg/m],
/// the normal along the difference of their mass gradients (one normal for both, so that momentum is kept);
/// a wall where a node of the grain is nearer than `wall_reach` [m] to it or beyond. Only u_n >= 0 is asked.
void add_node_contacts(const Lattice& lattice, int grains, std::span<const Wall<2>> walls, double least_mass,
                       double wall_reach, LatticeContacts& contacts);

/// Weights of all outline vertices, grain by grain.
struct OutlineWeights {
  std::vector<int> first_vertex;                 ///< (grains + 1)
  std::vector<std::vector<NodeWeight>> weights;  ///< (vertices)
};

/// Contacts of outlines: a vertex against a segment of another outline (the smaller grain is the slave, ties
/// by index) or a wall, where the free motion of dt brings them: u_n >= 0 then says that the gap at the end
/// of the step is not negative.
void add_outline_contacts(std::span<const PointGrain> grains, const Lattice& lattice,
                          const OutlineWeights& outline, std::span<const Wall<2>> walls, double dt,
                          LatticeContacts& contacts);

/// v of a vertex [m/s].
Vec<2> velocity_of(const Lattice& lattice, std::span<const NodeWeight> weights);

}  // namespace softgrain
