#pragma once
#include <memory>
#include <vector>

#include "softgrain/geometry/wall.hpp"
#include "softgrain/soft/soft_grains.hpp"
#include "support/random_numbers.hpp"

namespace softgrain::test {

inline std::shared_ptr<const Topology> disk(int n) { return std::make_shared<const Topology>(disk_grid(n)); }

/// A unit square about the origin, sides along the axes.
inline std::shared_ptr<const Topology> square(int n) {
  const std::vector<Vec<2>> corners{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  return std::make_shared<const Topology>(polygon_grid(corners, n));
}

inline GrainPlacement placed(std::shared_ptr<const Topology> shape, double radius, const Vec<2>& centre,
                             const Vec<2>& velocity = {}, double angle = 0) {
  return {
      .topology = std::move(shape), .radius = radius, .centre = centre, .angle = angle, .velocity = velocity};
}

/// Of any law: what flows does so at a stress far beyond the modulus.
inline MaterialParameters parameters(double E, double nu) {
  return {.young_modulus = E,
          .poisson_ratio = nu,
          .yield_stress = 100 * E,
          .creep_rate = 1,
          .creep_stress = 100 * E,
          .relaxation_share_1 = 0.4,
          .relaxation_time_1 = 1};
}

inline Wall<2> floor_at(double y) { return {.point = {0, y}, .normal = {0, 1}, .velocity = {}}; }

/// Bottom, top (coming down), left and right of a square box with a corner at the origin.
inline std::vector<Wall<2>> box_walls(double side, double lid_speed) {
  return {{.point = {0, 0}, .normal = {0, 1}, .velocity = {}},
          {.point = {0, side}, .normal = {0, -1}, .velocity = {0, -lid_speed}},
          {.point = {0, 0}, .normal = {1, 0}, .velocity = {}},
          {.point = {side, 0}, .normal = {-1, 0}, .velocity = {}}};
}

/// x <- map(grain, x) for all nodes, lane by lane.
template <class Map>
void move_nodes(SoftGrains& grains, Map&& map) {
  for (GrainBatch& batch : grains.batches)
    for (Vec<2, Wide>& x : batch.position)
      for (int lane = 0; lane < Wide::size; ++lane) {
        const Vec<2> to = map(lane, Vec<2>{x[0][lane], x[1][lane]});
        x[0].set(lane, to[0]);
        x[1].set(lane, to[1]);
      }
}

/// Every node moved at random by up to `size` [m] in each direction, differently in each lane.
inline void shake(SoftGrains& grains, double size, std::uint64_t seed = 3) {
  RandomNumbers random(seed);
  move_nodes(grains, [&](int, const Vec<2>& x) { return x + random.vector<2>(size); });
}

inline Vec<2> lane_of(const Vec<2, Wide>& v, int lane) { return {v[0][lane], v[1][lane]}; }

}  // namespace softgrain::test
