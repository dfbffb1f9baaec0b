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

/// All contacts with gap < margin [m], sorted by (vertex, master grain or wall). Cost O(vertices).
std::vector<OutlineContact> detect_outline_contacts(const SoftGrains& grains, const OutlineState& state,
                                                    double margin);

/// Impulses of `old` contacts [N s/m], given to the new contacts of the same vertex and master grain or wall.
std::vector<Vec<2>> carried_impulses(const SoftGrains& grains, std::span<const OutlineContact> old,
                                     std::span<const Vec<2>> old_impulse,
                                     std::span<const OutlineContact> contacts);

/// Outward unit normals of all outline vertices, smoothed along each outline.
std::vector<Vec<2>> smoothed_normals(const SoftGrains& grains, std::span<const Vec<2>> position);

}  // namespace softgrain
