#include "softgrain/rigid/close_pairs.hpp"

#include <algorithm>
#include <functional>
#include <optional>

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

/// Finds bodies that may be near others. Wide ones look round in a grid of their own.
template <int Dim>
class NearBodies {
 public:
  /// Bodies at `position`, as large as `radius` says. Those of a pair have a gap below `apart`.
  NearBodies(std::span<const Vec<Dim>> position, std::span<const double> radius, double apart)
      : wide_(wide_bodies(radius)) {
    double widest = 0, widest_of_others = 0;
    for (std::size_t k = 0; k < radius.size(); ++k) {
      widest = std::max(widest, radius[k]);
      if (wide_[k] == 0) widest_of_others = std::max(widest_of_others, radius[k]);
    }
    grid_.emplace(position, 2 * widest_of_others + apart);
    if (widest > widest_of_others) grid_of_wide_.emplace(position, 2 * widest + apart);
  }

  /// visit(j) for others that may be near i; of a pair one alone sees the other, if `number(k)` is that of
  /// the body whose image k is.
  template <class Number, class Visit>
  void for_each_partner(int i, const Number& number, const Visit& visit) const {
    const bool wide = wide_[i] != 0;
    (wide ? *grid_of_wide_ : *grid_).for_each_neighbour(i, [&](int j) {
      const bool both = (wide_[j] != 0) == wide;
      if (both ? number(j) > number(i) : wide) visit(j);
    });
  }

 private:
  std::vector<char> wide_;
  std::optional<CellGrid<Dim>> grid_, grid_of_wide_;
};

/// Particles begin .. end - 1 with gap < skin at the reference positions, but not if `skipped(i, j)`.
template <int Dim, class Skipped>
std::vector<BodyPair> close_pairs(const RigidParticles<Dim>& particles,
                                  const std::vector<Vec<Dim>>& reference, double skin,
                                  const GrainRange& range, const Skipped& skipped) {
  const auto x = std::span(reference).subspan(range.begin, range.end - range.begin);
  const auto radius = std::span(particles.radius).subspan(range.begin, x.size());
  if (x.size() < 2) return {};
  const NearBodies<Dim> near(x, radius, skin);
  const auto pairs_of = [&](int i, std::vector<BodyPair>& pairs) {
    near.for_each_partner(i, std::identity{}, [&](int j) {
      if (skipped(range.begin + i, range.begin + j)) return;
      const Vec<Dim> d = x[j] - x[i];
      const double touch = radius[i] + radius[j] + skin;
      if (dot(d, d) < touch * touch)
        pairs.push_back({range.begin + std::min(i, j), range.begin + std::max(i, j)});
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
  const auto number = [&](int at) { return images.point[at]; };
  std::vector<double> radius_of_image;
  for (const int i : images.point) radius_of_image.push_back(radius[i]);
  const NearBodies<Dim> near(images.position, radius_of_image, apart);
  const auto pairs_of = [&](int i, std::vector<BodyPair>& pairs) {
    near.for_each_partner(i, number, [&](int at) {
      const int j = number(at);
      if (particles.grain[i] == particles.grain[j]) return;
      const Vec<Dim> d = images.position[at] - images.position[i];
      const double touch = radius[i] + radius[j] + apart;
      if (dot(d, d) >= touch * touch) return;
      BodyPair pair{std::min(i, j), std::max(i, j)};
      const auto image = images.between(i, at);
      for (std::size_t k = 0; k < Dim; ++k) pair.image[k] = i < j ? image[k] : -image[k];
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

std::vector<char> wide_bodies(std::span<const double> radius) {
  constexpr double ratio = 5;
  std::vector<char> wide;
  if (radius.empty()) return wide;
  const double smallest = *std::min_element(radius.begin(), radius.end());
  for (const double r : radius) wide.push_back(r > ratio * smallest ? 1 : 0);
  return wide;
}

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
