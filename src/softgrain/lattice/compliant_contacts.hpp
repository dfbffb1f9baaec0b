#pragma once
#include <span>
#include <vector>

#include "softgrain/lattice/grain_equations.hpp"
#include "softgrain/lattice/lattice_contacts.hpp"

namespace softgrain {

/// Contacts of grains on a lattice as a ContactSystem in a step by backward Euler (theory (60d)): those of
/// LatticeContacts, but an impulse moves all nodes of a grain, through its stiffness,
///   W = H^T A^-1 H/dt^2.
class CompliantContacts {
 public:
  /// The nodes where the contacts act, and their compliance. Of grains whose nodes in contact are those of
  /// `before`, which was made with the same matrices, it is taken over.
  CompliantContacts(const Lattice& lattice, const LatticeContacts& contacts,
                    std::span<const GrainEquations> equations, double dt, CompliantContacts* before);

  /// Velocities of all nodes without impulses [m/s]; then those of `impulse` are added.
  void start(std::span<const Vec<2>> node_velocity, std::span<const Vec<2>> impulse);

  int size() const { return contacts_.size(); }
  Mat<2> delassus_block(int contact) const { return delassus_[contact]; }
  Vec<2> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<2>& dp);
  /// The velocities go ahead, see Extrapolation.
  void extrapolate(double b);

 private:
  /// A node's share in a contact, and its place in velocity_.
  struct Share {
    int grain = 0, place = 0;
    double weight = 0;
  };
  struct Grain {
    int first = 0;                   // of its nodes in contact, in velocity_
    std::vector<int> unknown;        // theirs, in rising order
    std::vector<double> compliance;  // [1/kg], row-major
  };
  std::span<const Share> shares_of(int contact) const {
    return std::span(shares_).subspan(begin_[contact], begin_[contact + 1] - begin_[contact]);
  }
  void find_nodes(const Lattice& lattice, std::span<const GrainEquations> equations);
  void find_shares(const Lattice& lattice, std::span<const GrainEquations> equations);
  Mat<2> find_delassus(int contact) const;

  const LatticeContacts& contacts_;
  std::vector<Grain> grain_;
  std::vector<int> node_;  // of the lattice, as velocity_
  std::vector<Vec<2>> velocity_, before_;
  std::vector<Share> shares_;
  std::vector<int> begin_{0};
  std::vector<Mat<2>> delassus_;
};

}  // namespace softgrain
