#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/soft/surface_contacts.hpp"

// Where a point in space faces another outline.

namespace softgrain {

/// The grains' patches, and what is looked up for all of them.
struct Surfaces {
  explicit Surfaces(const SolidGrains& all, const OutlineStateOf<3>& now) : grains(all), state(now) {
    for (int g = 0; g < grains.size(); ++g) {
      const auto& patches = grains.topology(g).patches;
      const int vertices = grains.outline_end(g) - grains.outline_begin(g);
      segment += std::sqrt(4 * std::numbers::pi / vertices) * grains.radius(g) / grains.size();
      const PaddedVec* x = first_of(g);
      for (const PatchNet& net : patches) {  // half of the longer diagonal of the quad
        const auto corner = [&](std::size_t k) { return x[net.vertex[k]]; };
        reach = std::max({reach, norm(corner(10) - corner(5)) / 2, norm(corner(6) - corner(9)) / 2});
      }
    }
  }
  const PaddedVec* first_of(int grain) const { return &state.position[grains.outline_begin(grain)]; }
  SurfacePatch patch(int grain, int index) const {
    return {grains.topology(grain).patches[index], first_of(grain)};
  }

  const SolidGrains& grains;
  const OutlineStateOf<3>& state;
  double segment = 0;  // mean distance of vertices of round grains [m]
  double reach = 0;    // from a place on a patch to its nearest vertex, at most [m]
};

/// Where a point, which is at `at`, faces a grain, of which the vertex `nearest` is nearest to it. If it is
/// farther than `far` above a plane that touches a smooth outline there, that is the gap.
SurfaceContact contact_with_patch(const Surfaces& surfaces, const SurfaceContact& point, const Vec<3>& at,
                                  int grain, int nearest, double far);

}  // namespace softgrain
