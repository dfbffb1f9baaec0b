#pragma once
#include <span>
#include <vector>

#include "softgrain/geometry/wall.hpp"
#include "softgrain/math/vec.hpp"
#include "softgrain/mpm/soft_grains.hpp"

namespace softgrain {

/// An outline vertex against a segment of another grain's outline, or against a wall. The finer grain's
/// vertices are the slaves (ties by index), so that a pair never changes its roles.
struct OutlineContact {
  int vertex = 0;               ///< the slave
  int wall = -1;                ///< or -1
  std::array<int, 2> master{};  ///< ends of the master's segment, unless a wall
  double share = 0;             ///< xi: the vertex faces (1 - xi) x_0 + xi x_1
  Vec<2> normal{};  ///< unit, from the master to the slave: interpolated from smoothed vertex normals
  double gap = 0;   ///< g = (x_slave - x_master) . n [m], open > 0
  double slip = 0;  ///< tangential displacement of slave against master since the start of the step [m]

  /// Weights of the two master vertices.
  std::array<double, 2> weights() const { return {1 - share, share}; }
};

/// Where the outlines are, and where they were at the start of the step.
struct OutlineState {
  std::vector<Vec<2>> position, start;  ///< (outline vertices) [m]
  std::vector<Wall<2>> walls;           ///< with their points at the end of the step
  double dt = 0;                        ///< [s]
};

/// Finds the contacts of outlines: which grains a vertex may meet is looked up among cells, and kept until
/// some vertex has moved far; where on their outline it faces them is walked to from where it did last. Cost
/// O(vertices).
class OutlineNeighbours {
 public:
  /// All contacts with gap < half a segment, sorted by (vertex, master grain or wall).
  std::vector<OutlineContact> detect(const SoftGrains& grains, const OutlineState& state);

 private:
  /// A slave vertex, and the vertex of a master grain that was nearest to it.
  struct Candidate {
    int vertex = 0, nearest = 0;
  };
  bool moved_far(const SoftGrains& grains, const OutlineState& state) const;
  void find_candidates(const SoftGrains& grains, const OutlineState& state);

  std::vector<Candidate> candidates_;  // sorted by (vertex, master grain)
  std::vector<Vec<2>> reference_;      // positions when they were found
  double segment_ = 0;                 // mean length of a segment of the round grains [m]
};

/// Gap of a contact when its bodies have moved a little since it was found: the vertex faces the same edge or
/// wall, at another place of it [m].
double gap_now(const OutlineContact& contact, const OutlineState& state);

/// Impulses of `old` contacts [N s/m], given to the new contacts of the same vertex and master grain or wall.
std::vector<Vec<2>> carried_impulses(const SoftGrains& grains, std::span<const OutlineContact> old,
                                     std::span<const Vec<2>> old_impulse,
                                     std::span<const OutlineContact> contacts);

/// Outward unit normals of all outline vertices, smoothed along each outline.
std::vector<Vec<2>> smoothed_normals(const SoftGrains& grains, std::span<const Vec<2>> position);

}  // namespace softgrain
