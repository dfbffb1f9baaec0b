#include "softgrain/soft/outline_contacts.hpp"

#include <algorithm>
#include <cassert>
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

// In units of the mean segment: candidates hold all contacts up to this gap until a vertex moved half the
// skin.
constexpr double largest_margin = 0.5;
constexpr double skin_share = 0.5;

/// Stretch of a periodic cell after which candidates are found anew: it brings vertices together that are
/// within reach of each other by a fifth of the skin.
constexpr double most_stretch = 0.01;

/// Vertices that a thread takes at once.
constexpr int part_size = 128;

/// Mean distance of a grain's outline vertices when it was round [m].
double segment_length(const SoftGrains& grains, int grain) {
  return 2 * std::numbers::pi * grains.radius(grain) /
         (grains.outline_end(grain) - grains.outline_begin(grain));
}

/// The vertex of each nearby master grain that is closest to a slave vertex.
struct Nearest {
  int grain, vertex;
  double distance_squared;
};

/// The vertex v and its arc against a wall. With s = n . (x_next - x_previous)/2 and theta the arc's
/// inclination, sin theta = s/l, the lowest place of the arc is f(s) = r (1 - cos theta) below the vertex; g
/// = h - f is concave, so that outlines clear of a wall are a convex set.
OutlineContact arc_at_wall(const OutlineState& state, int wall_index, const std::array<int, 4>& span,
                           double height, const OutlineArc& arc, double size) {
  const Wall<2>& wall = state.walls[wall_index];
  OutlineContact contact{
      .vertex = span[1], .wall = wall_index, .master = span, .normal = wall.normal, .gap = height};
  if (arc.end_sine > 0) {
    const double s = dot(state.position[span[2]] - state.position[span[0]], wall.normal) / 2;
    const double sine = std::clamp(s / (size * arc.half_chord), -arc.end_sine, arc.end_sine);
    const double cosine = std::sqrt(1 - sine * sine);
    contact.share = -arc.radius / arc.half_chord * sine / cosine;  // xi = -f'(s)
    contact.rise = size * arc.radius * (1 / cosine - 1);           // of f's conjugate
    contact.gap += contact.share * s + contact.rise;
  }
  contact.slip = dot(perpendicular(wall.normal), relative_displacement(contact, state));
  return contact;
}

/// The vertex of each grain within `reach` of vertex v that is nearest to it, sorted by grain.
/// `vertex` says whose image each position is; it is empty if there are none.
void find_near(const SoftGrains& grains, std::span<const Vec<2>> position, std::span<const int> vertex,
               const CellGrid<2>& grid, double reach, int v, std::vector<Nearest>& near) {
  near.clear();
  grid.for_each_neighbour(v, [&](int at) {
    const int w = vertex.empty() ? at : vertex[at];
    const int other = grains.grain_of_vertex(w);
    if (other == grains.grain_of_vertex(v)) return;
    const Vec<2> d = position[at] - position[v];
    const double distance_squared = dot(d, d);
    if (distance_squared > reach * reach) return;
    const auto found =
        std::find_if(near.begin(), near.end(), [&](const Nearest& n) { return n.grain == other; });
    if (found == near.end())
      near.push_back({other, w, distance_squared});
    else if (distance_squared < found->distance_squared)
      *found = {other, w, distance_squared};
  });
  std::sort(near.begin(), near.end(), [](const Nearest& a, const Nearest& b) { return a.grain < b.grain; });
}

}  // namespace

bool OutlineNeighbours::moved_far(const OutlineState& state) {
  if (reference_.size() != state.position.size()) return true;
  const bool repeats = state.cell.any();
  const Mat<2> stretch = stretch_since(reference_cell_, state.cell);
  if (std::sqrt(contract(stretch, stretch)) > most_stretch) return true;
  const double allowed = (repeats ? 1 - most_stretch / 0.05 : 1) * skin_share * segment_ / 2;
  parallel_for(static_cast<int>(parts_.size()), [&](int k) {
    double largest = 0;
    for (int v = parts_[k].begin; v < parts_[k].end; ++v) {
      Vec<2> d = state.position[v] - reference_[v];
      if (repeats) d -= stretch * reference_[v];  // what the cell carries it
      largest = std::max(largest, dot(d, d));
    }
    parts_[k].moved_far = largest > allowed * allowed;
  });
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.moved_far; });
}

void OutlineNeighbours::find_candidates(const SoftGrains& grains, const OutlineState& state) {
  reference_ = state.position;
  reference_cell_ = state.cell;
  parts_.resize((grains.outline_size() + part_size - 1) / part_size);
  shares_ = Shares(std::vector<double>(parts_.size(), 1.0));
  segment_ = 0;
  for (int g = 0; g < grains.size(); ++g) segment_ += segment_length(grains, g) / grains.size();
  double longest = 0;
  for (int v = 0; v < grains.outline_size(); ++v)
    longest = std::max(longest, norm(state.position[ring_of(grains, v).next(v)] - state.position[v]));
  const double reach = longest + (largest_margin + skin_share) * segment_ + range_;
  std::optional<Images<2>> images;
  if (state.cell.any()) images.emplace(state.position, state.cell, reach);
  const std::span<const Vec<2>> position = images ? images->position : state.position;
  const std::span<const int> vertex = images ? std::span<const int>(images->point) : std::span<const int>();
  const CellGrid<2> grid(position, reach);
  for (int k = 0; Part & part : parts_) {
    part.begin = k++ * part_size;
    part.end = std::min(part.begin + part_size, grains.outline_size());
  }
  own_for(shares_, static_cast<int>(parts_.size()), [&](int k) {
    Part& part = parts_[k];
    part.candidates.clear();
    std::vector<Nearest> near;
    for (int v = part.begin; v < part.end; ++v) {
      find_near(grains, position, vertex, grid, reach, v, near);
      for (const Nearest& nearest : near) part.candidates.push_back({v, nearest.vertex});
    }
  });
}

void OutlineNeighbours::find_contacts(const SoftGrains& grains, const OutlineState& state, double margin,
                                      Part& part) const {
  part.contacts.clear();
  const std::span<const Wall<2>> walls = state.walls;
  const std::span<const Vec<2>> position = state.position;
  const double near_a_wall = margin + segment_, furthest = 3 * segment_ + range_;
  const bool repeats = state.cell.any();
  auto candidate = part.candidates.begin();
  for (int v = part.begin; v < part.end; ++v) {
    const Vec<2> x = position[v];
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const double height = dot(x - walls[w].point, walls[w].normal);
      if (height > near_a_wall || walls[w].open) continue;
      const OutlineContact contact = wall_contact(grains, state, static_cast<int>(w), v, height);
      if (contact.gap < margin) part.contacts.push_back(contact);
    }
    for (; candidate != part.candidates.end() && candidate->vertex == v; ++candidate) {
      const Ring ring = ring_of(grains, candidate->nearest);
      Vec<2> shift{}, motion{};
      if (repeats) {
        const auto image = state.cell.nearest(position[candidate->nearest] - x);
        shift = state.cell.shift(image);
        motion = state.dt * state.cell.velocity(image);
      }
      const Vec<2> seen = x - shift;  // from the master
      candidate->nearest = nearest_vertex(ring, position, seen, candidate->nearest);
      const Vec<2> d = seen - position[candidate->nearest];
      if (dot(d, d) > furthest * furthest) continue;
      const int start = facing_segment(ring, position, seen, candidate->nearest);
      const int master = grains.grain_of_vertex(candidate->nearest);
      const bool vertex_alone =
          !grains.topology(master).rigid() ||
          (vertices_only_ && vertices_only_(grains.kind(grains.grain_of_vertex(v)), grains.kind(master)));
      const OutlineArc* arc = vertex_alone ? nullptr : rigid_arc(grains, v);
      const double arc_rise = arc == nullptr ? 0 : segment_ / 2;  // more than that of an arc over its vertex
      if (surely_outside(position, ring, start, seen, margin + arc_rise)) continue;
      const double gap = arc == nullptr
                             ? curve_contact(position, ring, v, seen, start).gap
                             : facing_arc(grains, position, ring, v, *arc, shift, candidate->nearest).gap;
      if (gap >= margin) continue;
      const Vec<2> back = (1 - state.normals_at) * motion;
      OutlineContact contact =
          arc == nullptr
              ? facing_contact(on_the_way_, ring, v, on_the_way_[v] - shift + back, candidate->nearest)
              : facing_arc(grains, on_the_way_, ring, v, *arc, shift - back, candidate->nearest);
      contact.gap = gap;
      contact.image = shift;
      contact.image_motion = motion;
      contact.slip = dot(perpendicular(contact.normal), relative_displacement(contact, state));
      part.contacts.push_back(contact);
    }
  }
}

/// A vertex, or its arc, against a wall from which it is `height` away.
OutlineContact OutlineNeighbours::wall_contact(const SoftGrains& grains, const OutlineState& state, int wall,
                                               int v, double height) const {
  const int grain = grains.grain_of_vertex(v);
  const bool vertex_alone = vertices_only_ && vertices_only_(grains.kind(grain), -1);
  if (const OutlineArc* arc = vertex_alone ? nullptr : rigid_arc(grains, v))
    return rigid_wall_contact(grains, state, on_the_way_, wall, v, *arc);
  const Ring ring = ring_of(grains, v);
  const int next = ring.next(v);
  return arc_at_wall(state, wall, {ring.previous(v), v, next, ring.next(next)}, height,
                     vertex_alone ? OutlineArc{} : grains.topology(grain).arc[v - ring.begin],
                     grains.radius(grain));
}

void OutlineNeighbours::keep(double range, std::function<bool(int, int)> vertices_only) {
  range_ = range;
  vertices_only_ = std::move(vertices_only);
  reference_.clear();
}

std::vector<OutlineContact> OutlineNeighbours::detect(const SoftGrains& grains, const OutlineState& state,
                                                      double margin) {
  assert(margin <= largest_margin);
  if (moved_far(state)) find_candidates(grains, state);
  on_the_way_.resize(state.position.size());
  parallel_for(static_cast<int>(parts_.size()), [&](int k) {
    for (int v = parts_[k].begin; v < parts_[k].end; ++v) on_the_way_[v] = state.on_the_way(v);
  });
  shared_for(
      shares_, static_cast<int>(parts_.size()),
      [&](int k) { find_contacts(grains, state, margin * segment_ + range_, parts_[k]); },
      [&](int k, Message& message) { message.list(parts_[k].contacts); }, Lengths::told);
  std::size_t count = 0;
  for (const Part& part : parts_) count += part.contacts.size();
  std::vector<OutlineContact> contacts;
  contacts.reserve(count);
  for (const Part& part : parts_) contacts.insert(contacts.end(), part.contacts.begin(), part.contacts.end());
  return contacts;
}

}  // namespace softgrain
