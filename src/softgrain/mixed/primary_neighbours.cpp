#include "softgrain/mixed/primary_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "softgrain/core/parallel.hpp"
#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/geometry/images.hpp"
#include "softgrain/soft/facing.hpp"

namespace softgrain {
namespace {

/// Contacts are listed up to this gap, in segments of an outline: what the impulses of a step move is less.
constexpr double margin_share = 0.1;

/// Candidates hold all contacts until a vertex and a primary have together come this many segments nearer.
constexpr double skin_share = 0.5;

/// Candidates that a thread takes at once.
constexpr int candidates_at_once = 64;

/// Between the ends of a span, which are vertices?
bool is_within(double share) {
  constexpr double at_end = 1e-6;
  return share > at_end && share < 1 - at_end;
}

/// Of points since a reference, but for what the cell carries them.
double furthest(std::span<const Vec<2>> now, std::span<const Vec<2>> before, const Mat<2>& stretch) {
  double square = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vec<2> way = now[i] - before[i] - stretch * before[i];
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

bool PrimaryNeighbours::moved_far(const OutlineState& outline) const {
  if (outline_reference_.size() != outline.position.size() || primary_reference_.size() != flown_.size())
    return true;
  const Mat<2> stretch = stretch_since(reference_cell_, outline.cell);
  const double nearer = furthest(outline.position, outline_reference_, stretch) +
                        furthest(flown_, primary_reference_, stretch) +
                        std::sqrt(contract(stretch, stretch)) * reach_;
  return !(nearer <= skin_share * segment_);
}

void PrimaryNeighbours::find_candidates(const SoftGrains& grains, const OutlineState& outline,
                                        std::span<const double> radius) {
  const std::vector<Vec<2>>& x = outline.position;
  outline_reference_ = x;
  primary_reference_ = flown_;
  reference_cell_ = outline.cell;
  segment_ = shortest_segment(grains);
  double longest = 0, widest = 0;
  for (int v = 0; v < grains.outline_size(); ++v)
    longest = std::max(longest, norm(x[grains.beside(v)[1]] - x[v]));
  for (const double r : radius) widest = std::max(widest, r);
  // a place of the curve is less than a segment away from its nearest vertex
  const double around = longest + (margin_share + skin_share) * segment_;
  reach_ = widest + around;
  std::vector<Vec<2>> all = x;
  all.insert(all.end(), flown_.begin(), flown_.end());
  const auto vertices = static_cast<int>(x.size());
  std::optional<Images<2>> images;
  if (outline.cell.any()) images.emplace(all, outline.cell, reach_);
  const std::span<const Vec<2>> place = images ? images->position : all;
  const CellGrid<2> grid(place, reach_);
  candidates_.clear();
  vertices_.clear();
  std::vector<int> near;
  for (int i = 0; i < static_cast<int>(flown_.size()); ++i) {
    near.clear();
    const double reach = radius[i] + around;
    grid.for_each_neighbour(vertices + i, [&](int at) {
      const int v = images ? images->point[at] : at;
      if (v >= vertices) return;
      const Vec<2> d = place[at] - place[vertices + i];
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
  PrimaryContact pair{.primary = candidate.primary, .grain = candidate.grain};
  if (outline.cell.any()) {
    const auto image = outline.cell.nearest(outline.position[vertices_[candidate.begin]] - end);
    pair.image = outline.cell.shift(image);
    pair.image_motion = outline.dt * outline.cell.velocity(image);
  }
  // the primary as the outline sees it
  const Vec<2> there = end - pair.image, half_way = start + outline.normals_at * (end - start) - pair.image +
                                                    (1 - outline.normals_at) * pair.image_motion;
  const double margin = margin_share * segment_;
  const Ring ring = ring_of(grains, vertices_[candidate.begin]);
  for (int k = candidate.begin; k < candidate.end; ++k) {
    const int v = vertices_[k];
    if (const double gap = norm(outline.position[v] - there) - radius; gap < margin) {
      const Vec<2> d = on_the_way_[v] - half_way;
      found.push_back(pair);
      found.back().vertex = v;
      found.back().normal = (1 / norm(d)) * d;
      found.back().gap = gap;
    }
    if (surely_outside(outline.position, ring, v, there, radius + margin)) continue;
    const OutlineContact end_of_span = curve_contact(outline.position, ring, -1, there, v);
    if (!is_within(end_of_span.share) || end_of_span.gap < 0 || end_of_span.gap - radius >= margin) continue;
    const OutlineContact place = curve_contact(on_the_way_, ring, -1, half_way, v);
    found.push_back(pair);
    found.back().span = place.master;
    found.back().share = place.share;
    found.back().normal = -place.normal;
    found.back().gap = end_of_span.gap - radius;
  }
}

std::vector<PrimaryContact> PrimaryNeighbours::detect(const SoftGrains& grains, const OutlineState& outline,
                                                      const RigidParticles<2>& primaries) {
  flown_ = primaries.position;
  for (std::size_t i = 0; i < flown_.size(); ++i) flown_[i] += outline.dt * primaries.velocity[i];
  if (moved_far(outline)) find_candidates(grains, outline, primaries.radius);
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
