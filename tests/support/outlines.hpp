#pragma once
#include <utility>
#include <vector>

#include "softgrain/soft/outline_contacts.hpp"
#include "support/soft_grains.hpp"

namespace softgrain::test {

/// Two disks, the second finer, deformed and overlapping by about 2 %.
inline SoftGrains overlapping_pair(double distance = 1.96) {
  SoftGrains grains({placed(disk(3), 1, {0, 0}), placed(disk(5), 1, {distance, 0.1})},
                    make_law(MaterialLaw::neo_hookean, 1, 0.3), 1);
  for (GrainBatch& batch : grains.batches)
    for (Vec<2, Wide>& x : batch.position) x[1] += 0.03 * x[0] * x[0];
  return grains;
}

inline OutlineState state_of(const SoftGrains& grains, std::vector<Wall<2>> walls = {}) {
  OutlineState state{.position = {}, .start = {}, .walls = std::move(walls), .dt = 1};
  grains.gather_outline(state.position);
  state.start = state.position;
  return state;
}

}  // namespace softgrain::test
