#pragma once
#include <span>
#include <vector>

#include "softgrain/core/shared_loop.hpp"
#include "softgrain/interaction/attraction.hpp"
#include "softgrain/rigid/neighbours.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// The attraction between the primary particles of each grain, grain by grain on all threads, over a list in
/// which each pair stands once.
template <int Dim>
class AttractionForcesOf {
 public:
  /// The same law in every grain.
  explicit AttractionForcesOf(const Attraction& law) : AttractionForcesOf(std::vector{law}) {}

  /// The law of each grain, by its number in RigidParticles::grain; a single one holds for all.
  explicit AttractionForcesOf(std::vector<Attraction> laws);

  /// Makes the lists of grains again whose reference has moved on: all pairs closer than 2 a0 + skin there.
  /// Of all grains, or of those of this rank alone.
  void update(const RigidParticles<Dim>& particles, const NeighbourReference<Dim>& reference,
              const Shares& shares = {});

  /// F_i += sum_j F(r_ij) (x_j - x_i)/r_ij  [N/m, N in space], on the primaries of all grains, or of those of
  /// this rank.
  void add_forces(const RigidParticles<Dim>& particles, std::span<Vec<Dim>> force,
                  const Shares& shares = {}) const;

  /// sum over pairs of U [J/m, J in space].
  double energy(const RigidParticles<Dim>& particles) const;

  /// Calls visit(i, j) once for each listed pair, i < j.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (const Rows& rows : rows_)
      for (int row = 0; row < rows.size(); ++row)
        for (int k = rows.begin[row]; k < rows.begin[row + 1]; ++k)
          if (const int i = rows.grain.begin + row; i < rows.neighbour[k]) visit(i, rows.neighbour[k]);
  }

  const Attraction& law(int grain) const { return laws_.size() == 1 ? laws_.front() : laws_[grain]; }

 private:
  /// The neighbours of each primary of a grain, as far as they come after it.
  struct Rows {
    int made = -1;  // as NeighbourReference::made
    GrainRange grain{};
    std::vector<int> begin{0};
    std::vector<int> neighbour;  // rows are padded to four lanes with the primary itself

    int size() const { return static_cast<int>(begin.size()) - 1; }
  };
  static Rows rows_of(const RigidParticles<Dim>& particles, const NeighbourReference<Dim>& reference,
                      const GrainRange& grain);
  void add_forces(const RigidParticles<Dim>& particles, const Rows& rows, std::span<Vec<Dim>> force) const;

  std::vector<Attraction> laws_;
  std::vector<Rows> rows_;
};
using AttractionForces = AttractionForcesOf<2>;

}  // namespace softgrain
