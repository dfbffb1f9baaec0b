#pragma once
#include "softgrain/soft/rigid_motion.hpp"
#include "softgrain/soft/soft_grains.hpp"

// How rigid grains in space move.

namespace softgrain::test {

inline GrainMaterial rigid_material(double density) { return {.law = {}, .density = density, .rigid = true}; }

/// v_c and omega of a grain.
struct Twist {
  Vec<3> velocity, spin;
};
inline Twist twist_of(const SolidGrains& grains, int grain) {
  const auto [batch, lane] = grains.batch_of(grain);
  const RigidTwistOf<3> all = rigid_twist(grains, *batch, batch->position, batch->velocity);
  return {lane_of(all.velocity, lane), lane_of(all.spin, lane)};
}

/// sum of x x m v + I omega over all grains, about the origin.
inline Vec<3> angular_momentum(const SolidGrains& grains) {
  Vec<3> sum;
  for (const SolidBatch& batch : grains.batches)
    for (int i = 0; i < batch.topology->grid.nodes(); ++i)
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
        sum += grains.node_mass(batch, i)[lane] *
               cross(lane_of(batch.position[i], lane), lane_of(batch.velocity[i], lane));
  return sum;
}

}  // namespace softgrain::test
