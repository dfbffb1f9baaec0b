#pragma once
#include <span>
#include <vector>

#include "softgrain/interaction/attraction.hpp"
#include "softgrain/rigid/neighbours.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// The attraction between the primary particles of each grain, over a full list of neighbours (each pair
/// twice: no particle is written by another's row, so the sum's order is fixed).
class AttractionForces {
 public:
  /// The same law in every grain.
  explicit AttractionForces(const Attraction& law) : AttractionForces(std::vector{law}) {}

  /// The law of each grain, by its number in RigidParticles::grain; a single one holds for all.
  explicit AttractionForces(std::vector<Attraction> laws);

  /// Makes the list again if the reference has moved on: all pairs of one grain closer than 2 a0 + skin
  /// there.
  void update(const RigidParticles<2>& particles, const NeighbourReference<2>& reference);

  /// F_i += sum_j F(r_ij) (x_j - x_i)/r_ij  [N/m]
  void add_forces(const RigidParticles<2>& particles, std::span<Vec<2>> force) const;

  /// sum over pairs of U [J/m].
  double energy(const RigidParticles<2>& particles) const;

  /// Calls visit(i, j) once for each listed pair, i < j.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (int i = 0; i + 1 < static_cast<int>(row_begin_.size()); ++i)
      for (int k = row_begin_[i]; k < row_begin_[i + 1]; ++k)
        if (i < neighbour_[k]) visit(i, neighbour_[k]);
  }

  const Attraction& law(int grain) const { return laws_.size() == 1 ? laws_.front() : laws_[grain]; }

 private:
  std::vector<Attraction> laws_;
  int generation_ = -1;
  std::vector<int> row_begin_;  ///< (n + 1), rows are padded to four lanes with the particle itself
  std::vector<int> neighbour_;
};

}  // namespace softgrain
