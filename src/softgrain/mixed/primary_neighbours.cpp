#include "softgrain/mixed/primary_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/core/parallel.hpp"
#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/soft/facing.hpp"

namespace softgrain {
namespace {

/// Contacts are listed up to this gap, in segments of an outline: what the impulses of a step move is less.
constexpr double margin_share = 0.1;

/// Candidates hold all contacts until a vertex and a primary have together come this many segments nearer.
constexpr double skin_share = 0.5;

/// Candidates that a thread takes at once.
constexpr int candidates_at_once = 64;

double furthest(std::span<const Vec<2>> now, std::span<const Vec<2>> before) {
  double square = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vec<2> way = now[i] - before[i];
    square = std::max(square, dot(way, way));
  }
  return std::sqrt(square);
}

double shortest_segment(const SoftGrains& grains) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int g = 0; g < grains.size(); ++g)
    shortest = std::min(shortest, 2 * std::numbers::pi * grains.radius(g) /
                                      (grains.outline_end(g) - grains.outline_begin(g)));
  return shortest;
}

}  // namespace

bool PrimaryNeighbours::moved_far(std::span<const Vec<2>> outline, std::span<const Vec<2>> primary) const {
  if (outline_reference_.size() != outline.size() || primary_reference_.size() != primary.size()) return true;
  const double nearer = furthest(outline, outline_reference_) + furthest(primary, primary_reference_);
  return !(nearer <= skin_share * segment_);
}

void PrimaryNeighbours::find_candidates(const SoftGrains& grains, std::span<const Vec<2>> outline,
                                        std::span<const Vec<2>> primary, std::span<const double> radius) {
  outline_reference_.assign(outline.begin(), outline.end());
  primary_reference_.assign(primary.begin(), primary.end());
  segment_ = shortest_segment(grains);
  double longest = 0, widest = 0;
  for (int v = 0; v < grains.outline_size(); ++v)
    longest = std::max(longest, norm(outline[grains.beside(v)[1]] - outline[v]));
  for (const double r : radius) widest = std::max(widest, r);
  // a place of the curve is less than a segment away from its nearest vertex
  const double around = longest + (margin_share + skin_share) * segment_;
  std::vector<Vec<2>> all = outline_reference_;
  all.insert(all.end(), primary.begin(), primary.end());
  const CellGrid<2> grid(all, widest + around);
  const auto vertices = static_cast<int>(outline.size());
  candidates_.clear();
  vertices_.clear();
  std::vector<int> near;
  for (int i = 0; i < static_cast<int>(primary.size()); ++i) {
    near.clear();
    const double reach = radius[i] + around;
    grid.for_each_neighbour(vertices + i, [&](int v) {
      if (v >= vertices) return;
      const Vec<2> d = outline[v] - primary[i];
      if (dot(d, d) < reach * reach) near.push_back(v);
    });
    std::sort(near.begin(), near.end());
    for (const int v : near) {
      const int grain = grains.grain_of_vertex(v), at = static_cast<int>(vertices_.size());
      if (candidates_.empty() || candidates_.back().primary != i || candidates_.back().grain != grain)
        candidates_.push_back({.primary = i, .grain = grain, .begin = at, .end = at});
      vertices_.push_back(v);
      ++candidates_.back().end;
    }
  }
}

/// Of one candidate, whose primary goes from `start` to `end`.
void PrimaryNeighbours::add_contacts(const SoftGrains& grains, const OutlineState& outline,
                                     const Candidate& candidate, const Vec<2>& start, const Vec<2>& end,
                                     double radius, std::vector<PrimaryContact>& found) const {
  const double margin = margin_share * segment_;
  const auto distance = [&](int k) { return norm(outline.position[vertices_[k]] - end); };
  int nearest = candidate.begin;
  for (int k = candidate.begin + 1; k < candidate.end; ++k)
    if (distance(k) < distance(nearest)) nearest = k;
  const Vec<2> middle = start + outline.normals_at * (end - start);
  const PrimaryContact pair{.primary = candidate.primary, .grain = candidate.grain};

  const Ring ring = ring_of(grains, vertices_[nearest]);
  const OutlineContact there = facing_contact(outline.position, ring, -1, end, vertices_[nearest]);
  if (there.gap - radius < margin) {
    const OutlineContact place = facing_contact(on_the_way_, ring, -1, middle, vertices_[nearest]);
    found.push_back(pair);
    found.back().span = place.master;
    found.back().share = place.share;
    found.back().normal = -place.normal;
    found.back().gap = there.gap - radius;
  }
  for (int k = candidate.begin; k < candidate.end; ++k) {
    const double gap = distance(k) - radius;
    if (!(gap < margin)) continue;
    const Vec<2> d = on_the_way_[vertices_[k]] - middle;
    found.push_back(pair);
    found.back().vertex = vertices_[k];
    found.back().normal = (1 / norm(d)) * d;
    found.back().gap = gap;
  }
}

std::vector<PrimaryContact> PrimaryNeighbours::detect(const SoftGrains& grains, const OutlineState& outline,
                                                      const RigidParticles<2>& primaries) {
  flown_ = primaries.position;
  for (std::size_t i = 0; i < flown_.size(); ++i) flown_[i] += outline.dt * primaries.velocity[i];
  if (moved_far(outline.position, flown_))
    find_candidates(grains, outline.position, flown_, primaries.radius);
  on_the_way_.resize(outline.position.size());
  parallel_ranges(grains.outline_size(), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) on_the_way_[v] = outline.on_the_way(v);
  });
  const auto count = static_cast<int>(candidates_.size());
  std::vector<std::vector<PrimaryContact>> parts((count + candidates_at_once - 1) / candidates_at_once);
  parallel_for(static_cast<int>(parts.size()), [&](int part) {
    for (int k = part * candidates_at_once; k < std::min(count, (part + 1) * candidates_at_once); ++k) {
      const int i = candidates_[k].primary;
      add_contacts(grains, outline, candidates_[k], primaries.position[i], flown_[i], primaries.radius[i],
                   parts[part]);
    }
  });
  std::vector<PrimaryContact> contacts;
  for (const auto& part : parts) contacts.insert(contacts.end(), part.begin(), part.end());
  return contacts;
}

std::vector<Vec<2>> carried_impulses(std::span<const PrimaryContact> old, std::span<const Vec<2>> old_impulse,
                                     std::span<const PrimaryContact> contacts) {
  std::vector<Vec<2>> impulse(contacts.size());
  std::size_t k = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    while (k < old.size() && old[k].key() < contacts[c].key()) ++k;
    if (k < old.size() && old[k].key() == contacts[c].key()) impulse[c] = old_impulse[k];
  }
  return impulse;
}

}  // namespace softgrain
