#include "softgrain/bpm/attraction_forces.hpp"

#include <algorithm>

#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/math/lane_rows.hpp"

namespace softgrain {
namespace {

/// Primaries of a grain, of which four are looked at at once. In the plane in their own arrays; in space in
/// rows of four numbers, since gathering three by three takes half of the time.
template <int Dim>
class GrainInLanes;

template <>
class GrainInLanes<2> {
 public:
  GrainInLanes(const RigidParticles<2>& particles, const GrainRange&, std::span<Vec<2>> force)
      : x_(particles.position.data()), radius_(particles.radius.data()), force_(force.data()) {}

  /// x_j - x_i of four j, and a_i + a_j.
  Vec<2, Lanes> from(int i, const int* j, Lanes& a0) const {
    a0 = radius_[i] + Lanes{radius_[j[0]], radius_[j[1]], radius_[j[2]], radius_[j[3]]};
    const LaneColumns x = gather_columns(x_, j);
    return {x.x - x_[i][0], x.y - x_[i][1]};
  }
  /// force_j -= F.
  void take(const int* j, const Vec<2, Lanes>& F) {
    LaneColumns force = gather_columns(force_, j);
    force.x -= F[0], force.y -= F[1];
    scatter_columns(force, force_, j);
  }
  void give(int i, const Vec<2, Lanes>& F) {
    force_[i] += Vec<2>{horizontal_sum(F[0]), horizontal_sum(F[1])};
  }

 private:
  const Vec<2>* x_;
  const double* radius_;
  Vec<2>* force_;
};

template <>
class GrainInLanes<3> {
 public:
  GrainInLanes(const RigidParticles<3>& particles, const GrainRange& grain, std::span<Vec<3>> force)
      : first_(grain.begin), force_(force) {
    for (int i = grain.begin; i < grain.end; ++i) {
      const Vec<3>& x = particles.position[i];
      row_.push_back(Lanes{x[0], x[1], x[2], particles.radius[i]});
    }
    pull_.resize(row_.size(), Lanes{});
  }
  ~GrainInLanes() {
    for (std::size_t i = 0; i < pull_.size(); ++i)
      for (int m = 0; m < 3; ++m) force_[first_ + i][m] += pull_[i][m];
  }
  GrainInLanes(const GrainInLanes&) = delete;
  GrainInLanes& operator=(const GrainInLanes&) = delete;

  Vec<3, Lanes> from(int i, const int* j, Lanes& a0) const {
    const auto [x, y, z, radius] = transpose_rows(at(j[0]), at(j[1]), at(j[2]), at(j[3]));
    const Lanes& here = at(i);
    a0 = here[3] + radius;
    return {x - here[0], y - here[1], z - here[2]};
  }
  void take(const int* j, const Vec<3, Lanes>& F) {
    const auto rows = transpose_rows(F[0], F[1], F[2], Lanes{});
    for (int lane = 0; lane < lane_count; ++lane) pull_[j[lane] - first_] -= rows[lane];
  }
  void give(int i, const Vec<3, Lanes>& F) {
    pull_[i - first_] += Lanes{horizontal_sum(F[0]), horizontal_sum(F[1]), horizontal_sum(F[2]), 0};
  }

 private:
  const Lanes& at(int i) const { return row_[i - first_]; }

  int first_;
  std::span<Vec<3>> force_;
  std::vector<Lanes> row_, pull_;  // x, y, z, radius; the force on each
};

}  // namespace

template <int Dim>
AttractionForcesOf<Dim>::AttractionForcesOf(std::vector<Attraction> laws) : laws_(std::move(laws)) {
  for (const Attraction& law : laws_) require_valid(law);
}

template <int Dim>
void AttractionForcesOf<Dim>::update(const RigidParticles<Dim>& particles,
                                     const NeighbourReference<Dim>& reference, const Shares& shares) {
  rows_.resize(reference.grains.size());
  for (std::size_t g = 0; g < rows_.size(); ++g) {
    if (!shares.mine(static_cast<int>(g)) && rows_[g].made >= 0) rows_[g] = {};
    rows_[g].grain = reference.grains[g];
  }
  own_for(shares, static_cast<int>(rows_.size()), [&](int g) {
    if (rows_[g].made == reference.made[g]) return;
    rows_[g] = rows_of(particles, reference, reference.grains[g]);
    rows_[g].made = reference.made[g];
  });
}

template <int Dim>
typename AttractionForcesOf<Dim>::Rows AttractionForcesOf<Dim>::rows_of(
    const RigidParticles<Dim>& particles, const NeighbourReference<Dim>& reference, const GrainRange& grain) {
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
  own_for(shares, static_cast<int>(rows_.size()), [&](int g) { add_forces(particles, rows_[g], force); });
}

template <int Dim>
void AttractionForcesOf<Dim>::add_forces(const RigidParticles<Dim>& particles, const Rows& rows,
                                         std::span<Vec<Dim>> force) const {
  if (rows.size() == 0) return;
  const Attraction& attraction = law(particles.grain[rows.grain.begin]);
  GrainInLanes<Dim> grain(particles, rows.grain, force);
  for (int row = 0; row < rows.size(); ++row) {
    const int i = rows.grain.begin + row;
    Vec<Dim, Lanes> sum;
    for (int k = rows.begin[row]; k < rows.begin[row + 1]; k += lane_count) {
      const int* j = &rows.neighbour[k];
      Lanes a0;
      const Vec<Dim, Lanes> d = grain.from(i, j, a0);
      Lanes r_squared = d[0] * d[0];
      for (int m = 1; m < Dim; ++m) r_squared += d[m] * d[m];
      // F_ij = F(r)/r (x_j - x_i) on i, -F_ij on j; a row's padding has x_j = x_i, which would be 0/0
      const Lanes F_over_r = attraction.force_over_distance(r_squared > 0 ? r_squared : a0 * a0, a0);
      Vec<Dim, Lanes> F;
      for (int m = 0; m < Dim; ++m) sum[m] += F[m] = F_over_r * d[m];
      grain.take(j, F);
    }
    grain.give(i, sum);
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
