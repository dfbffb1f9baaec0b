#include "softgrain/rigid/close_pairs.hpp"

#include <algorithm>

#include "softgrain/core/parallel.hpp"
#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/geometry/images.hpp"

namespace softgrain {
namespace {

/// Pairs, and those of a later range after them.
struct PairList {
  std::vector<BodyPair> pairs;
  PairList& operator+=(const PairList& more) {
    pairs.insert(pairs.end(), more.pairs.begin(), more.pairs.end());
    return *this;
  }
};

/// Particles begin .. end - 1 with gap < skin at the reference positions, but not if `skipped(i, j)`.
template <int Dim, class Skipped>
std::vector<BodyPair> close_pairs(const RigidParticles<Dim>& particles,
                                  const std::vector<Vec<Dim>>& reference, double skin,
                                  const GrainRange& range, const Skipped& skipped) {
  const auto x = std::span(reference).subspan(range.begin, range.end - range.begin);
  const double* radius = particles.radius.data() + range.begin;
  if (x.size() < 2) return {};
  const CellGrid<Dim> grid(x, 2 * *std::max_element(radius, radius + x.size()) + skin);
  const auto pairs_of = [&](int i, std::vector<BodyPair>& pairs) {
    grid.for_each_neighbour(i, [&](int j) {
      if (j < i || skipped(range.begin + i, range.begin + j)) return;
      const Vec<Dim> d = x[j] - x[i];
      const double touch = radius[i] + radius[j] + skin;
      if (dot(d, d) < touch * touch) pairs.push_back({range.begin + i, range.begin + j});
    });
  };
  return parallel_sum<PairList>(static_cast<int>(x.size()),
                                [&](int begin, int end) {
                                  PairList part;
                                  for (int i = begin; i < end; ++i) pairs_of(i, part.pairs);
                                  return part;
                                })
      .pairs;
}

/// The same of particles of different grains, through all images.
template <int Dim>
std::vector<BodyPair> close_pairs_of_images(const RigidParticles<Dim>& particles,
                                            const NeighbourReference<Dim>& reference) {
  const std::vector<double>& radius = particles.radius;
  const double apart = reference.skin + reference.reach;
  const double reach = 2 * *std::max_element(radius.begin(), radius.end()) + apart;
  const Images<Dim> images(reference.between, reference.cell, reach);
  const CellGrid<Dim> grid(images.position, reach);
  const auto pairs_of = [&](int i, std::vector<BodyPair>& pairs) {
    grid.for_each_neighbour(i, [&](int at) {
      const int j = images.point[at];
      if (j < i || particles.grain[i] == particles.grain[j]) return;
      const Vec<Dim> d = images.position[at] - images.position[i];
      const double touch = radius[i] + radius[j] + apart;
      if (dot(d, d) >= touch * touch) return;
      BodyPair pair{i, j};
      const auto image = images.between(i, at);
      std::copy(image.begin(), image.end(), pair.image.begin());
      pairs.push_back(pair);
    });
  };
  return parallel_sum<PairList>(particles.size(),
                                [&](int begin, int end) {
                                  PairList part;
                                  for (int i = begin; i < end; ++i) pairs_of(i, part.pairs);
                                  return part;
                                })
      .pairs;
}

}  // namespace

template <int Dim>
std::vector<BodyPair> pairs_between(const RigidParticles<Dim>& particles,
                                    const NeighbourReference<Dim>& reference) {
  const auto& grain = particles.grain;
  const double apart = reference.skin + reference.reach;
  std::vector<BodyPair> pairs;
  if (reference.cell.any())
    pairs = close_pairs_of_images(particles, reference);
  else if (reference.grains.size() > 1)
    pairs = close_pairs(particles, reference.between, apart, {0, particles.size()},
                        [&](int i, int j) { return grain[i] == grain[j]; });
  for (std::size_t w = 0; w < particles.walls.size(); ++w) {
    for (int i = 0; i < particles.size(); ++i) {
      const double height = dot(reference.between[i] - reference.wall_point[w], particles.walls[w].normal);
      if (height < particles.radius[i] + apart)
        pairs.push_back({i, particles.wall_body(static_cast<int>(w))});
    }
  }
  return pairs;
}

template <int Dim>
std::vector<BodyPair> pairs_inside(const RigidParticles<Dim>& particles,
                                   const NeighbourReference<Dim>& reference, const GrainRange& grain) {
  return close_pairs(particles, reference.position, reference.skin, grain, [](int, int) { return false; });
}

template std::vector<BodyPair> pairs_between<2>(const RigidParticles<2>&, const NeighbourReference<2>&);
template std::vector<BodyPair> pairs_between<3>(const RigidParticles<3>&, const NeighbourReference<3>&);
template std::vector<BodyPair> pairs_inside<2>(const RigidParticles<2>&, const NeighbourReference<2>&,
                                               const GrainRange&);
template std::vector<BodyPair> pairs_inside<3>(const RigidParticles<3>&, const NeighbourReference<3>&,
                                               const GrainRange&);

}  // namespace softgrain
