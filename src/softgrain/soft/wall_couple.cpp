#include "softgrain/soft/wall_couple.hpp"

#include <algorithm>

namespace softgrain {

std::vector<Wide> grains_on_smooth_walls_alone(const SoftGrains& grains,
                                               std::span<const OutlineContact> contacts,
                                               const FrictionByKind& friction, std::span<const char> met) {
  std::vector<char> at_wall(grains.size(), 0), at_grain(met.begin(), met.end());
  at_grain.resize(grains.size(), 0);
  for (const OutlineContact& c : contacts) {
    (c.wall >= 0 ? at_wall : at_grain)[grains.grain_of_vertex(c.vertex)] = 1;
    if (c.wall < 0) at_grain[grains.grain_of_vertex(c.master[0])] = 1;
  }
  std::vector<Wide> alone(grains.batches.size(), 0.0);
  for (std::size_t b = 0; b < alone.size(); ++b) {
    const GrainBatch& batch = grains.batches[b];
    if (friction.at_walls(batch.kind) > 0 || batch.topology->rigid()) continue;
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      if (const int g = batch.grain[lane]; batch.topology->round && at_wall[g] != 0 && at_grain[g] == 0)
        alone[b].set(lane, 1);
  }
  return alone;
}

namespace {

/// Sum of P and of x x P of each grain, about the origin, by walls.
struct WallImpulse {
  Vec<2> sum;
  double moment = 0;
};
std::vector<WallImpulse> wall_impulses(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                       std::span<const Vec<2>> impulse, std::span<const Vec<2>> outline) {
  std::vector<WallImpulse> given(grains.size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].wall < 0 || impulse[c] == Vec<2>{}) continue;
    const Vec<2> P = impulse_vector(contacts[c], impulse[c]);
    WallImpulse& to = given[grains.grain_of_vertex(contacts[c].vertex)];
    to.sum += P;
    contacts[c].for_each_vertex(
        [&](int v, double weight) { to.moment += weight * dot(perpendicular(outline[v]), P); });
  }
  return given;
}

}  // namespace

double turn_back(SoftGrains& grains, std::span<const Wide> alone, std::span<const OutlineContact> contacts,
                 std::span<const Vec<2>> impulse, std::span<const Vec<2>> outline) {
  const std::vector<WallImpulse> given = wall_impulses(grains, contacts, impulse, outline);
  double energy = 0;
  for (std::size_t b = 0; b < alone.size(); ++b) {
    if (!any(alone[b] > 0.0)) continue;
    GrainBatch& batch = grains.batches[b];
    const int nodes = batch.topology->grid.nodes();
    const Vec<2, Wide> centre = centre_of_mass(grains, batch, batch.position);
    Wide inertia = 0.0, momentum = 0.0, work = 0.0;
    for (int i = 0; i < nodes; ++i) {
      const Vec<2, Wide> x = batch.position[i] - centre;
      inertia += grains.node_mass(batch, i) * dot(x, x);
    }
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
      const WallImpulse& of_grain = given[batch.grain[lane]];
      momentum.set(
          lane, of_grain.moment - dot(perpendicular(Vec<2>{centre[0][lane], centre[1][lane]}), of_grain.sum));
    }
    const Wide turn = -alone[b] * momentum / inertia;
    for (int i = 0; i < nodes; ++i) {
      const Vec<2, Wide> x = batch.position[i] - centre, dv{-turn * x[1], turn * x[0]};
      batch.velocity[i] += dv;
      work += grains.node_mass(batch, i) * dot(dv, batch.velocity[i] - Wide(0.5) * dv);
    }
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) energy += work[lane];
  }
  return energy;
}

}  // namespace softgrain
