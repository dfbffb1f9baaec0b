#include "softgrain/bpm/attraction_forces.hpp"

#include <algorithm>

#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/math/lanes.hpp"

namespace softgrain {

AttractionForces::AttractionForces(std::vector<Attraction> laws) : laws_(std::move(laws)) {
  for (const Attraction& law : laws_) require_valid(law);
}

void AttractionForces::update(const RigidParticles<2>& particles, const NeighbourReference<2>& reference) {
  if (generation_ == reference.generation) return;
  generation_ = reference.generation;
  row_begin_.assign(1, 0);
  neighbour_.clear();
  if (particles.size() == 0) return;
  const double widest = *std::max_element(particles.radius.begin(), particles.radius.end());
  const CellGrid<2> grid(reference.position, 4 * widest + reference.skin);
  for (int i = 0; i < particles.size(); ++i) {
    const std::size_t begin = neighbour_.size();
    grid.for_each_neighbour(i, [&](int j) {
      if (particles.grain[i] != particles.grain[j]) return;
      const Vec<2> d = reference.position[j] - reference.position[i];
      const double reach = 2 * (particles.radius[i] + particles.radius[j]) + reference.skin;
      if (dot(d, d) < reach * reach) neighbour_.push_back(j);
    });
    std::sort(neighbour_.begin() + begin, neighbour_.end());
    while (neighbour_.size() % lane_count != 0) neighbour_.push_back(i);
    row_begin_.push_back(static_cast<int>(neighbour_.size()));
  }
}

void AttractionForces::add_forces(const RigidParticles<2>& particles, std::span<Vec<2>> force) const {
  const double* radius = particles.radius.data();
  for (int i = 0; i < particles.size(); ++i) {
    const Attraction& attraction = law(particles.grain[i]);
    const Vec<2>& x = particles.position[i];
    Lanes sum_x = splat(0), sum_y = splat(0);
    for (int k = row_begin_[i]; k < row_begin_[i + 1]; k += lane_count) {
      const int* j = &neighbour_[k];
      const LaneColumns x_j = gather_columns(particles.position.data(), j);
      const Lanes d_x = x_j.x - x[0], d_y = x_j.y - x[1];
      const Lanes a0 = radius[i] + Lanes{radius[j[0]], radius[j[1]], radius[j[2]], radius[j[3]]};
      const Lanes r_squared = d_x * d_x + d_y * d_y;
      // F_ij = F(r)/r (x_j - x_i); a row's padding has x_j = x_i, which would be 0/0
      const Lanes F_over_r = attraction.force_over_distance(r_squared > 0 ? r_squared : a0 * a0, a0);
      sum_x += F_over_r * d_x;
      sum_y += F_over_r * d_y;
    }
    force[i] += Vec<2>{horizontal_sum(sum_x), horizontal_sum(sum_y)};
  }
}

double AttractionForces::energy(const RigidParticles<2>& particles) const {
  double sum = 0;
  for_each_pair([&](int i, int j) {
    const double r = norm(particles.position[j] - particles.position[i]);
    sum += law(particles.grain[i]).energy(r, particles.radius[i] + particles.radius[j]);
  });
  return sum;
}

}  // namespace softgrain
