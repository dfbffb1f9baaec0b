#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "softgrain/soft/surface_contacts.hpp"

// Where a point in space faces another outline.

namespace softgrain {

/// The grains' patches, and what is looked up for all of them.
struct Surfaces {
  explicit Surfaces(const SolidGrains& all, const OutlineStateOf<3>& now) : grains(all), state(now) {
    normal.resize(grains.outline_size());
    segment_of.resize(grains.size());
    for (int g = 0; g < grains.size(); ++g) {
      const auto& patches = grains.topology(g).patches;
      const int vertices = grains.outline_end(g) - grains.outline_begin(g);
      segment_of[g] = std::sqrt(4 * std::numbers::pi / vertices) * grains.radius(g);
      segment += segment_of[g] / grains.size();
      const PaddedVec* x = first_of(g);
      Vec<3>* n = &normal[grains.outline_begin(g)];
      for (const PatchNet& net : patches) {
        const auto at = [&](std::size_t k) { return net.vertex[PatchNet::corner[k]]; };
        const Vec<3> a = x[at(2)] - x[at(0)], b = x[at(3)] - x[at(1)];  // diagonals of the quad
        reach = std::max({reach, norm(a) / 2, norm(b) / 2});
        for (std::size_t k = 0; k < 4; ++k) n[at(k)] += cross(a, b);
      }
    }
    for (Vec<3>& n : normal)
      if (dot(n, n) > 0) n *= 1 / norm(n);
  }
  /// True if a grain brings its points to another one: the finer of the two does, of two alike the first, and
  /// both where one is rigid with edges, which are met by their own points.
  bool brings_points(int grain, int other) const {
    if (grains.topology(grain).rigid_shape() || grains.topology(other).rigid_shape()) return true;
    return std::pair(segment_of[grain], grain) < std::pair(segment_of[other], other);
  }
  const PaddedVec* first_of(int grain) const { return &state.position[grains.outline_begin(grain)]; }
  SurfacePatch patch(int grain, int index) const {
    return {grains.topology(grain).patches[index], first_of(grain)};
  }

  const SolidGrains& grains;
  const OutlineStateOf<3>& state;
  std::vector<Vec<3>> normal;      // (outline vertices) unit, outwards: the mean of the quads round each
  std::vector<double> segment_of;  // (grains) mean distance of vertices of a round one [m]
  double segment = 0;              // its mean [m]
  double reach = 0;                // from a place on a patch to its nearest vertex, at most [m]
};

/// Where a point, which is at `at`, faces a grain, of which the vertex `nearest` is nearest to it. If it is
/// farther than `far` above the plane that touches a smooth outline there, that is the gap.
SurfaceContact contact_with_patch(const Surfaces& surfaces, const SurfaceContact& point, const Vec<3>& at,
                                  int grain, int nearest, double far);

}  // namespace softgrain
