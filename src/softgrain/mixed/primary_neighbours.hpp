#pragma once
#include <span>
#include <vector>

#include "softgrain/mixed/primary_contacts.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// Finds the contacts of primaries with outlines of elastic grains. Which vertices a primary may meet is
/// looked up among cells, and kept until one of them has moved far.
class PrimaryNeighbours {
 public:
  /// All contacts with gap < margin, sorted by key(). The primaries are at the start of the step, with the
  /// velocities that they have there. The list depends on the state alone, not on earlier calls.
  std::vector<PrimaryContact> detect(const SoftGrains& grains, const OutlineState& outline,
                                     const RigidParticles<2>& primaries);

 private:
  /// A primary and the vertices begin .. end - 1 of `vertices_`, near it, of one grain.
  struct Candidate {
    int primary = 0, grain = 0;
    int begin = 0, end = 0;
  };
  bool moved_far(const OutlineState& outline) const;
  void find_candidates(const SoftGrains& grains, const OutlineState& outline, std::span<const double> radius);
  void add_contacts(const SoftGrains& grains, const OutlineState& outline, const Candidate& candidate,
                    const Vec<2>& start, const Vec<2>& end, double radius,
                    std::vector<PrimaryContact>& found) const;

  std::vector<Candidate> candidates_;
  std::vector<int> vertices_;
  std::vector<Vec<2>> outline_reference_, primary_reference_;  // when these were found [m]
  PeriodicCell<2> reference_cell_;
  double reach_ = 0;                // of candidates: the largest distance of a vertex and a centre then [m]
  std::vector<Vec<2>> flown_;       // primaries at the end of the flight [m]
  std::vector<Vec<2>> on_the_way_;  // outlines where places and normals are taken [m]
  double segment_ = 0;              // the shortest of the undeformed round grains [m]
};

/// Impulses of `old` contacts [N s/m], given to the new ones of the same key.
std::vector<Vec<2>> carried_impulses(std::span<const PrimaryContact> old, std::span<const Vec<2>> old_impulse,
                                     std::span<const PrimaryContact> contacts);

}  // namespace softgrain
