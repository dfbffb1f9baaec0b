#include "softgrain/bpm/attraction_forces.hpp"

#include <algorithm>

#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/math/lanes.hpp"

namespace softgrain {

template <int Dim>
AttractionForcesOf<Dim>::AttractionForcesOf(std::vector<Attraction> laws) : laws_(std::move(laws)) {
  for (const Attraction& law : laws_) require_valid(law);
}

template <int Dim>
void AttractionForcesOf<Dim>::update(const RigidParticles<Dim>& particles, const NeighbourReference<Dim>& reference,
                              const Shares& shares) {
  rows_.resize(reference.grains.size());
  for (std::size_t g = 0; g < rows_.size(); ++g) rows_[g].grain = reference.grains[g];
  own_for(shares, static_cast<int>(rows_.size()), [&](int g) {
    if (rows_[g].made == reference.made[g]) return;
    rows_[g] = rows_of(particles, reference, reference.grains[g]);
    rows_[g].made = reference.made[g];
  });
}

template <int Dim>
typename AttractionForcesOf<Dim>::Rows AttractionForcesOf<Dim>::rows_of(const RigidParticles<Dim>& particles,
                                                 const NeighbourReference<Dim>& reference,
                                                 const GrainRange& grain) {
  Rows rows;
  rows.grain = grain;
  const auto x = std::span(reference.position).subspan(grain.begin, grain.end - grain.begin);
  const double* radius = particles.radius.data() + grain.begin;
  const double widest = *std::max_element(radius, radius + x.size());
  const CellGrid<Dim> grid(x, 4 * widest + reference.skin);
  for (int i = 0; i < static_cast<int>(x.size()); ++i) {
    grid.for_each_neighbour(i, [&](int j) {
      if (j < i) return;
      const Vec<Dim> d = x[j] - x[i];
      const double reach = 2 * (radius[i] + radius[j]) + reference.skin;
      if (dot(d, d) < reach * reach) rows.neighbour.push_back(grain.begin + j);
    });
    while (rows.neighbour.size() % lane_count != 0) rows.neighbour.push_back(grain.begin + i);
    rows.begin.push_back(static_cast<int>(rows.neighbour.size()));
  }
  return rows;
}

template <int Dim>
void AttractionForcesOf<Dim>::add_forces(const RigidParticles<Dim>& particles, std::span<Vec<Dim>> force,
                                  const Shares& shares) const {
  shared_for(
      shares, static_cast<int>(rows_.size()), [&](int g) { add_forces(particles, rows_[g], force); },
      [&](int g, Message& message) {
        const GrainRange& grain = rows_[g].grain;
        message(force.subspan(grain.begin, grain.end - grain.begin));
      });
}

template <int Dim>
void AttractionForcesOf<Dim>::add_forces(const RigidParticles<Dim>& particles, const Rows& rows,
                                  std::span<Vec<Dim>> force) const {
  const double* radius = particles.radius.data();
  for (int row = 0; row < rows.size(); ++row) {
    const int i = rows.grain.begin + row;
    const Attraction& attraction = law(particles.grain[i]);
    const Vec<Dim>& x = particles.position[i];
    Vec<Dim, Lanes> sum;
    for (int k = rows.begin[row]; k < rows.begin[row + 1]; k += lane_count) {
      const int* j = &rows.neighbour[k];
      Vec<Dim, Lanes> d = gather_vectors(particles.position.data(), j);
      for (int m = 0; m < Dim; ++m) d[m] -= x[m];
      const Lanes a0 = radius[i] + Lanes{radius[j[0]], radius[j[1]], radius[j[2]], radius[j[3]]};
      Lanes r_squared = d[0] * d[0];
      for (int m = 1; m < Dim; ++m) r_squared += d[m] * d[m];
      // F_ij = F(r)/r (x_j - x_i) on i, -F_ij on j; a row's padding has x_j = x_i, which would be 0/0
      const Lanes F_over_r = attraction.force_over_distance(r_squared > 0 ? r_squared : a0 * a0, a0);
      Vec<Dim, Lanes> force_j = gather_vectors(force.data(), j);
      for (int m = 0; m < Dim; ++m) {
        const Lanes F = F_over_r * d[m];
        sum[m] += F;
        force_j[m] -= F;
      }
      scatter_vectors(force_j, force.data(), j);
    }
    for (int m = 0; m < Dim; ++m) force[i][m] += horizontal_sum(sum[m]);
  }
}

template <int Dim>
double AttractionForcesOf<Dim>::energy(const RigidParticles<Dim>& particles) const {
  double sum = 0;
  for_each_pair([&](int i, int j) {
    const double r = norm(particles.position[j] - particles.position[i]);
    sum += law(particles.grain[i]).energy(r, particles.radius[i] + particles.radius[j]);
  });
  return sum;
}

template class AttractionForcesOf<2>;
template class AttractionForcesOf<3>;

}  // namespace softgrain
