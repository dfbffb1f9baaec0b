#include "softgrain/mpm/outline_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "softgrain/geometry/cell_grid.hpp"

namespace softgrain {
namespace {

constexpr int smoothing_passes = 2;

// In units of the mean segment: contacts are kept up to this gap, and candidates until a vertex moved half
// the skin.
constexpr double margin_share = 0.5;
constexpr double skin_share = 0.5;

/// Neighbour of a vertex along its own outline.
int next_vertex(const SoftGrains& grains, int vertex) {
  const int grain = grains.grain_of_vertex(vertex);
  return vertex + 1 < grains.outline_end(grain) ? vertex + 1 : grains.outline_begin(grain);
}
int previous_vertex(const SoftGrains& grains, int vertex) {
  const int grain = grains.grain_of_vertex(vertex);
  return vertex > grains.outline_begin(grain) ? vertex - 1 : grains.outline_end(grain) - 1;
}

/// Mean distance of a grain's outline vertices when it was round [m].
double segment_length(const SoftGrains& grains, int grain) {
  return 2 * std::numbers::pi * grains.radius(grain) /
         (grains.outline_end(grain) - grains.outline_begin(grain));
}

bool is_slave(const SoftGrains& grains, int grain, int other) {
  return std::tuple{segment_length(grains, grain), grain} < std::tuple{segment_length(grains, other), other};
}

/// The vertex of each nearby master grain that is closest to a slave vertex.
struct Nearest {
  int grain, vertex;
  double distance_squared;
};

/// The closer of the two segments that meet at the master's nearest vertex.
OutlineContact facing_segment(const SoftGrains& grains, const OutlineState& state,
                              std::span<const Vec<2>> normals, int slave, int nearest) {
  const Vec<2>& x = state.position[slave];
  OutlineContact contact{.vertex = slave};
  double closest = std::numeric_limits<double>::infinity();
  const std::array<std::array<int, 2>, 2> segments{std::array{previous_vertex(grains, nearest), nearest},
                                                   std::array{nearest, next_vertex(grains, nearest)}};
  for (const auto& segment : segments) {
    const Vec<2>& a = state.position[segment[0]];
    const Vec<2> along = state.position[segment[1]] - a;
    const double share = std::clamp(dot(x - a, along) / dot(along, along), 0.0, 1.0);
    const Vec<2> d = x - (a + share * along);
    if (dot(d, d) < closest) {
      closest = dot(d, d);
      contact.master = segment;
      contact.share = share;
    }
  }
  const auto [w0, w1] = contact.weights();
  const auto [m0, m1] = contact.master;
  const Vec<2> n = w0 * normals[m0] + w1 * normals[m1];
  contact.normal = (1 / norm(n)) * n;
  contact.gap = dot(x - (w0 * state.position[m0] + w1 * state.position[m1]), contact.normal);
  const Vec<2> moved = (x - state.start[slave]) - (w0 * (state.position[m0] - state.start[m0]) +
                                                   w1 * (state.position[m1] - state.start[m1]));
  contact.slip = dot(perpendicular(contact.normal), moved);
  return contact;
}

OutlineContact wall_contact(const OutlineState& state, int slave, int wall_index) {
  const Wall<2>& wall = state.walls[wall_index];
  const Vec<2> moved = state.position[slave] - state.start[slave] - state.dt * wall.velocity;
  return {.vertex = slave,
          .wall = wall_index,
          .normal = wall.normal,
          .gap = dot(state.position[slave] - wall.point, wall.normal),
          .slip = dot(perpendicular(wall.normal), moved)};
}

/// The vertex of a master's outline nearest to `slave`, walking downhill from `start`.
int nearest_vertex(const SoftGrains& grains, std::span<const Vec<2>> position, int slave, int start) {
  const auto distance_squared = [&](int w) {
    const Vec<2> d = position[w] - position[slave];
    return dot(d, d);
  };
  int nearest = start;
  double least = distance_squared(start);
  for (;;) {
    const int before = previous_vertex(grains, nearest), after = next_vertex(grains, nearest);
    const double d_before = distance_squared(before), d_after = distance_squared(after);
    if (least <= d_before && least <= d_after) return nearest;
    nearest = d_before < d_after ? before : after;
    least = std::min(d_before, d_after);
  }
}

/// Identity of a contact over the steps: the vertex, then the wall or the master grain.
std::tuple<int, int, int> identity(const SoftGrains& grains, const OutlineContact& contact) {
  return {contact.vertex, contact.wall, contact.wall >= 0 ? 0 : grains.grain_of_vertex(contact.master[0])};
}

}  // namespace

std::vector<Vec<2>> smoothed_normals(const SoftGrains& grains, std::span<const Vec<2>> position) {
  std::vector<Vec<2>> normals(position.size()), raw(position.size());
  const int n = static_cast<int>(position.size());
  for (int v = 0; v < n; ++v) {
    const Vec<2> chord = position[next_vertex(grains, v)] - position[previous_vertex(grains, v)];
    normals[v] = (-1 / norm(chord)) * perpendicular(chord);  // outward of a counter-clockwise outline
  }
  for (int pass = 0; pass < smoothing_passes; ++pass) {
    raw = normals;
    for (int v = 0; v < n; ++v) {
      const Vec<2> sum = raw[previous_vertex(grains, v)] + 2 * raw[v] + raw[next_vertex(grains, v)];
      normals[v] = (1 / norm(sum)) * sum;
    }
  }
  return normals;
}

bool OutlineNeighbours::moved_far(const SoftGrains& grains, const OutlineState& state) const {
  if (reference_.size() != state.position.size()) return true;
  double largest = 0;
  for (int v = 0; v < grains.outline_size(); ++v) {
    const Vec<2> d = state.position[v] - reference_[v];
    largest = std::max(largest, dot(d, d));
  }
  return largest > (skin_share * segment_ / 2) * (skin_share * segment_ / 2);
}

void OutlineNeighbours::find_candidates(const SoftGrains& grains, const OutlineState& state) {
  reference_ = state.position;
  candidates_.clear();
  segment_ = 0;
  for (int g = 0; g < grains.size(); ++g) segment_ += segment_length(grains, g) / grains.size();
  double longest = 0;
  for (int v = 0; v < grains.outline_size(); ++v)
    longest = std::max(longest, norm(state.position[next_vertex(grains, v)] - state.position[v]));
  const double reach = longest + (margin_share + skin_share) * segment_;
  const CellGrid<2> grid(state.position, reach);
  std::vector<Nearest> near;
  for (int v = 0; v < grains.outline_size(); ++v) {
    const int grain = grains.grain_of_vertex(v);
    near.clear();
    grid.for_each_neighbour(v, [&](int w) {
      const int other = grains.grain_of_vertex(w);
      if (other == grain || !is_slave(grains, grain, other)) return;
      const Vec<2> d = state.position[w] - state.position[v];
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
    for (const Nearest& nearest : near) candidates_.push_back({v, nearest.vertex});
  }
}

std::vector<OutlineContact> OutlineNeighbours::detect(const SoftGrains& grains, const OutlineState& state) {
  if (moved_far(grains, state)) find_candidates(grains, state);
  const double margin = margin_share * segment_;
  const std::vector<Vec<2>> normals = smoothed_normals(grains, state.position);
  std::vector<OutlineContact> contacts;
  auto candidate = candidates_.begin();
  for (int v = 0; v < grains.outline_size(); ++v) {
    for (int w = 0; w < static_cast<int>(state.walls.size()); ++w) {
      const Wall<2>& wall = state.walls[w];
      if (dot(state.position[v] - wall.point, wall.normal) < margin)
        contacts.push_back(wall_contact(state, v, w));
    }
    for (; candidate != candidates_.end() && candidate->vertex == v; ++candidate) {
      candidate->nearest = nearest_vertex(grains, state.position, v, candidate->nearest);
      const Vec<2> d = state.position[v] - state.position[candidate->nearest];
      if (dot(d, d) > 9 * segment_ * segment_) continue;
      const OutlineContact contact = facing_segment(grains, state, normals, v, candidate->nearest);
      if (contact.gap < margin) contacts.push_back(contact);
    }
  }
  return contacts;
}

double gap_now(const OutlineContact& contact, const OutlineState& state) {
  const Vec<2>& x = state.position[contact.vertex];
  if (contact.wall >= 0) return dot(x - state.walls[contact.wall].point, contact.normal);
  const Vec<2>& a = state.position[contact.master[0]];
  const Vec<2> along = state.position[contact.master[1]] - a;
  const double share = std::clamp(dot(x - a, along) / dot(along, along), 0.0, 1.0);
  return dot(x - (a + share * along), contact.normal);
}

std::vector<Vec<2>> carried_impulses(const SoftGrains& grains, std::span<const OutlineContact> old,
                                     std::span<const Vec<2>> old_impulse,
                                     std::span<const OutlineContact> contacts) {
  std::vector<std::pair<std::tuple<int, int, int>, int>> known;
  for (int c = 0; c < static_cast<int>(old.size()); ++c)
    if (old_impulse[c][0] > 0) known.emplace_back(identity(grains, old[c]), c);
  std::sort(known.begin(), known.end());
  std::vector<Vec<2>> impulse(contacts.size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto id = identity(grains, contacts[c]);
    const auto found = std::lower_bound(known.begin(), known.end(), std::pair{id, 0});
    if (found != known.end() && found->first == id) impulse[c] = old_impulse[found->second];
  }
  return impulse;
}

}  // namespace softgrain
