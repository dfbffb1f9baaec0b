#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/solid_equilibrium.hpp"
#include "support/random_numbers.hpp"

namespace softgrain::test {

inline std::shared_ptr<const SolidTopology> ball(int n) {
  return std::make_shared<const SolidTopology>(ball_grid(n));
}

/// By an angle [rad] in the plane of axes i and j.
inline Mat<3> turn_in(int i, int j, double angle) {
  Mat<3> Q = identity<3>();
  Q(i, i) = Q(j, j) = std::cos(angle);
  Q(i, j) = -std::sin(angle);
  Q(j, i) = std::sin(angle);
  return Q;
}

/// One of many different orientations.
inline Mat<3> some_turn(int k) {
  return turn_in(0, 1, 0.3 * k) * (turn_in(1, 2, 0.7 * k) * turn_in(0, 2, 1.1 * k));
}

/// So many balls of radius 1, far from each other along x, each turned another way; E = 1, rho = 1.
inline SolidGrains balls(int n, int count, double nu, bool mean_dilatation = false,
                         MaterialLaw law = MaterialLaw::neo_hookean) {
  const auto shape = ball(n);
  std::vector<PlacementOf<3>> placed;
  for (int k = 0; k < count; ++k)
    placed.push_back(
        {.topology = shape, .radius = 1, .centre = {3.0 * k, 0, 0}, .angle = some_turn(k), .velocity = {}});
  return {std::move(placed),
          {GrainMaterial{.law = make_law(law, 1, nu), .density = 1, .mean_dilatation = mean_dilatation}}};
}

/// Two walls across z, which come together at v each.
inline Box<3> walls_at(double low, double high, double v = 0) {
  return Box<3>({{.point = {0, 0, low}, .normal = {0, 0, 1}, .velocity = {0, 0, v}},
                 {.point = {0, 0, high}, .normal = {0, 0, -1}, .velocity = {0, 0, -v}}});
}

/// x <- map(x) for all nodes, lane by lane.
template <class Map>
void move_nodes(SolidGrains& grains, Map&& map) {
  for (SolidBatch& batch : grains.batches)
    for (Vec<3, Wide>& x : batch.position)
      for (int lane = 0; lane < Wide::size; ++lane) {
        const Vec<3> to = map(lane_of(x, lane));
        for (int d = 0; d < 3; ++d) x[d].set(lane, to[d]);
      }
}

/// Every node moved at random by up to `size` [m] in each direction, differently in each lane.
inline void shake(SolidGrains& grains, double size, std::uint64_t seed = 3) {
  RandomNumbers random(seed);
  move_nodes(grains, [&](Vec<3> x) {
    for (int d = 0; d < 3; ++d) x[d] += random.uniform(-size, size);
    return x;
  });
}

}  // namespace softgrain::test
