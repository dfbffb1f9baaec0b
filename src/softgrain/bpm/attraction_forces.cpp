#include "softgrain/bpm/attraction_forces.hpp"

#include <algorithm>

#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/math/lanes.hpp"

namespace softgrain {

AttractionForces::AttractionForces(std::vector<Attraction> laws) : laws_(std::move(laws)) {
  for (const Attraction& law : laws_) require_valid(law);
}

void AttractionForces::update(const RigidParticles<2>& particles, const NeighbourReference<2>& reference,
                              const Shares& shares) {
  rows_.resize(reference.grains.size());
  for (std::size_t g = 0; g < rows_.size(); ++g) rows_[g].grain = reference.grains[g];
  own_for(shares, static_cast<int>(rows_.size()), [&](int g) {
    if (rows_[g].made == reference.made[g]) return;
    rows_[g] = rows_of(particles, reference, reference.grains[g]);
    rows_[g].made = reference.made[g];
  });
}

AttractionForces::Rows AttractionForces::rows_of(const RigidParticles<2>& particles,
                                                 const NeighbourReference<2>& reference,
                                                 const GrainRange& grain) {
  Rows rows;
  rows.grain = grain;
  const auto x = std::span(reference.position).subspan(grain.begin, grain.end - grain.begin);
  const double* radius = particles.radius.data() + grain.begin;
  const double widest = *std::max_element(radius, radius + x.size());
  const CellGrid<2> grid(x, 4 * widest + reference.skin);
  for (int i = 0; i < static_cast<int>(x.size()); ++i) {
    grid.for_each_neighbour(i, [&](int j) {
      if (j < i) return;
      const Vec<2> d = x[j] - x[i];
      const double reach = 2 * (radius[i] + radius[j]) + reference.skin;
      if (dot(d, d) < reach * reach) rows.neighbour.push_back(grain.begin + j);
    });
    while (rows.neighbour.size() % lane_count != 0) rows.neighbour.push_back(grain.begin + i);
    rows.begin.push_back(static_cast<int>(rows.neighbour.size()));
  }
  return rows;
}

void AttractionForces::add_forces(const RigidParticles<2>& particles, std::span<Vec<2>> force,
                                  const Shares& shares) const {
  shared_for(
      shares, static_cast<int>(rows_.size()), [&](int g) { add_forces(particles, rows_[g], force); },
      [&](int g, Message& message) {
        const GrainRange& grain = rows_[g].grain;
        message(force.subspan(grain.begin, grain.end - grain.begin));
      });
}

void AttractionForces::add_forces(const RigidParticles<2>& particles, const Rows& rows,
                                  std::span<Vec<2>> force) const {
  const double* radius = particles.radius.data();
  for (int row = 0; row < rows.size(); ++row) {
    const int i = rows.grain.begin + row;
    const Attraction& attraction = law(particles.grain[i]);
    const Vec<2>& x = particles.position[i];
    Lanes sum_x = splat(0), sum_y = splat(0);
    for (int k = rows.begin[row]; k < rows.begin[row + 1]; k += lane_count) {
      const int* j = &rows.neighbour[k];
      const LaneColumns x_j = gather_columns(particles.position.data(), j);
      const Lanes d_x = x_j.x - x[0], d_y = x_j.y - x[1];
      const Lanes a0 = radius[i] + Lanes{radius[j[0]], radius[j[1]], radius[j[2]], radius[j[3]]};
      const Lanes r_squared = d_x * d_x + d_y * d_y;
      // F_ij = F(r)/r (x_j - x_i) on i, -F_ij on j; a row's padding has x_j = x_i, which would be 0/0
      const Lanes F_over_r = attraction.force_over_distance(r_squared > 0 ? r_squared : a0 * a0, a0);
      const Lanes F_x = F_over_r * d_x, F_y = F_over_r * d_y;
      sum_x += F_x;
      sum_y += F_y;
      LaneColumns force_j = gather_columns(force.data(), j);
      force_j.x -= F_x;
      force_j.y -= F_y;
      scatter_columns(force_j, force.data(), j);
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
