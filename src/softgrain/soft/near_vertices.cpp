#include "softgrain/soft/near_vertices.hpp"

#include <algorithm>
#include <utility>

namespace softgrain {
namespace {

/// Keeps the nearer one of each grain.
void add_nearest(const NearestVertex& next, std::vector<NearestVertex>& near) {
  const auto found =
      std::find_if(near.begin(), near.end(), [&](const NearestVertex& n) { return n.grain == next.grain; });
  if (found == near.end())
    near.push_back(next);
  else if (std::pair(next.distance_squared, next.vertex) < std::pair(found->distance_squared, found->vertex))
    *found = next;
}
void sort_by_grain(std::vector<NearestVertex>& near) {
  std::sort(near.begin(), near.end(),
            [](const NearestVertex& a, const NearestVertex& b) { return a.grain < b.grain; });
}

}  // namespace

bool is_of_surface(const SolidGrains& grains, int v) {
  const int grain = grains.grain_of_vertex(v);
  const SolidTopology& shape = grains.topology(grain);
  return !shape.ball && (!shape.rigid() || v + 1 < grains.outline_end(grain));
}

NearVertices::NearVertices(const Surfaces& surfaces, double reach)
    : surfaces_(surfaces),
      place_(surfaces.state.position.begin(), surfaces.state.position.end()),
      grid_(place_, surfaces.state.cell, reach) {
  const int vertices = surfaces.grains.outline_size();
  append_in_parallel(vertices, points_at_once, near_,
                     [&](int v, std::vector<NearestVertex>& list) { find(reach, v, list); });
  begin_.assign(vertices + 1, 0);
  for (const NearestVertex& n : near_) ++begin_[n.of + 1];
  for (int v = 0; v < vertices; ++v) begin_[v + 1] += begin_[v];
}

void NearVertices::find_for_middle(const SurfacePoint& middle, int first_vertex, const Vec<3>& x,
                                   std::vector<NearestVertex>& near) const {
  near.clear();
  for (const int corner : std::span(middle.corner).first(middle.of_edge() ? 2 : 4))
    for (NearestVertex n : of(first_vertex + corner)) {
      n.distance_squared = distance_squared(x, n.vertex);
      add_nearest(n, near);
    }
  for (NearestVertex& n : near) walk(x, n);
  sort_by_grain(near);
}

double NearVertices::distance_squared(const Vec<3>& x, int vertex) const {
  const OutlineStateOf<3>& state = surfaces_.state;
  Vec<3> d = state.position[vertex] - x;
  if (state.cell.any()) d += state.cell.shift(state.cell.nearest(d));
  return dot(d, d);
}

/// Downhill from n.vertex, at its distance, to the vertex of its grain that is nearest to x.
void NearVertices::walk(const Vec<3>& x, NearestVertex& n) const {
  const SolidTopology& shape = surfaces_.grains.topology(n.grain);
  const int begin = surfaces_.grains.outline_begin(n.grain);
  for (int from = -1; from != n.vertex;) {
    from = n.vertex;
    for (const int q : shape.quads_round[from - begin]) {
      if (q < 0) continue;
      for (const std::size_t corner : PatchNet::corner) {
        const int w = begin + shape.patches[q].vertex[corner];
        if (const double next = distance_squared(x, w); next < n.distance_squared)
          n.vertex = w, n.distance_squared = next;
      }
    }
  }
}

void NearVertices::find(double reach, int v, std::vector<NearestVertex>& all) const {
  if (!is_of_surface(surfaces_.grains, v)) return;
  thread_local std::vector<NearestVertex> near;
  near.clear();
  const int grain = surfaces_.grains.grain_of_vertex(v);
  grid_.for_each_neighbour(v, [&](int w, const Vec<3>& d) {
    const int other = surfaces_.grains.grain_of_vertex(w);
    if (other == grain || surfaces_.grains.topology(other).ball || !surfaces_.brings_points(grain, other))
      return;
    const double distance_squared = dot(d, d);
    if (distance_squared <= reach * reach) add_nearest({v, other, w, distance_squared}, near);
  });
  sort_by_grain(near);
  all.insert(all.end(), near.begin(), near.end());
}

}  // namespace softgrain
