#include "softgrain/soft/surface_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "softgrain/soft/carried_impulses.hpp"
#include "softgrain/soft/sphere_contacts.hpp"
#include "softgrain/soft/surface_lists.hpp"

namespace softgrain {
namespace {

/// Vertices, or middles of patches, that a thread takes at once.
constexpr int points_at_once = 256;

/// The grains' patches, and what is looked up for all of them.
struct Surfaces {
  explicit Surfaces(const SolidGrains& all, const OutlineStateOf<3>& now) : grains(all), state(now) {
    for (int g = 0; g < grains.size(); ++g) {
      const auto& patches = grains.topology(g).patches;
      const int vertices = grains.outline_end(g) - grains.outline_begin(g);
      segment += std::sqrt(4 * std::numbers::pi / vertices) * grains.radius(g) / grains.size();
      patch_begin.push_back(patch_begin.back() + static_cast<int>(patches.size()));
      const Vec<3>* x = first_of(g);
      for (const PatchNet& net : patches) {  // half of the longer diagonal of the quad
        const auto corner = [&](std::size_t k) { return x[net.vertex[k]]; };
        reach = std::max({reach, norm(corner(10) - corner(5)) / 2, norm(corner(6) - corner(9)) / 2});
      }
    }
  }
  const Vec<3>* first_of(int grain) const { return &state.position[grains.outline_begin(grain)]; }
  SurfacePatch patch(int grain, int index) const {
    return {grains.topology(grain).patches[index], first_of(grain)};
  }

  const SolidGrains& grains;
  const OutlineStateOf<3>& state;
  std::vector<int> patch_begin{0};  // (grains + 1)
  double segment = 0;               // mean distance of vertices of round grains [m]
  double reach = 0;                 // from a place on a patch to its nearest vertex, at most [m]
};

/// A patch round a vertex, and how far x lies within it: the smaller of its two coordinates from the vertex.
struct FacingPatch {
  int patch = 0;
  double u = 0, v = 0;  // of the vertex
  double within = 0;
};

/// The patches round a vertex, the one that x faces first.
std::vector<FacingPatch> patches_facing(const Surfaces& surfaces, int grain, int vertex, const Vec<3>& x) {
  const SolidTopology& topology = surfaces.grains.topology(grain);
  const int begin = surfaces.grains.outline_begin(grain), local = vertex - begin;
  const Vec<3>* position = surfaces.first_of(grain);
  const Vec<3> d = x - position[local];
  constexpr std::array<std::size_t, 4> around{5, 9, 10, 6};  // P_11, P_21, P_22, P_12
  std::vector<FacingPatch> facing;
  for (const int q : topology.quads_round[local]) {
    if (q < 0) continue;
    const auto& net = topology.patches[q].vertex;
    std::size_t k = 0;
    while (net[around[k]] != local) ++k;
    const Vec<3> a = position[net[around[(k + 1) % 4]]] - position[local],
                 b = position[net[around[(k + 3) % 4]]] - position[local];
    const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), da = dot(d, a), db = dot(d, b);
    facing.push_back({.patch = q,
                      .u = k == 1 || k == 2 ? 1.0 : 0.0,
                      .v = k >= 2 ? 1.0 : 0.0,
                      .within = std::min(bb * da - ab * db, aa * db - ab * da) / (aa * bb - ab * ab)});
  }
  std::stable_sort(facing.begin(), facing.end(),
                   [](const FacingPatch& p, const FacingPatch& q) { return p.within > q.within; });
  return facing;
}

/// Beside an edge of a grain the nearest place is on the edge for both of its faces: a point that is outside
/// one of them meets the edge along the way to it, one that is inside both the face that it is less deep in.
class FacesOfEdge {
 public:
  void add(const Vec<3>& d, const Vec<3>& normal) { faces_.push_back({d, normal}); }
  /// way: to the nearest place of all [m]; size: of a patch [m]
  void set_normal(const Vec<3>& way, double size, SurfaceContact& contact) const {
    constexpr double near = 1e-6, flat = 0.97;
    double highest = -std::numeric_limits<double>::infinity(), least_cosine = 1;
    Vec<3> normal = contact.normal;
    for (const Face& face : faces_) {
      if (norm(face.d - way) > near * size) continue;  // its own nearest place lies elsewhere
      least_cosine = std::min(least_cosine, dot(face.normal, contact.normal));
      if (const double height = dot(face.d, face.normal); height > highest)
        highest = height, normal = face.normal;
    }
    if (least_cosine > flat) return;
    const double distance = norm(way);
    const bool beside = highest > 0 && distance > near * size;
    contact.normal = beside ? (1 / distance) * way : normal;
    contact.gap = beside ? distance : highest;
  }

 private:
  struct Face {
    Vec<3> d, normal;
  };
  std::vector<Face> faces_;
};

/// Where the point `vertex` faces a grain, of which the vertex `nearest` is nearest to it.
SurfaceContact contact_with_patch(const Surfaces& surfaces, int vertex, int grain, int nearest) {
  SurfaceContact contact{.point = vertex, .vertex = vertex};
  set_image(contact, nearest, surfaces.state);
  const Vec<3> x = surfaces.state.position[vertex] - contact.image;
  const bool has_edges = surfaces.grains.topology(grain).rigid_shape();
  FacesOfEdge edge;
  Vec<3> way;  // to the nearest place
  bool inside = false;
  double least = std::numeric_limits<double>::infinity();
  for (const FacingPatch& facing : patches_facing(surfaces, grain, nearest, x)) {
    const SurfacePatch patch = surfaces.patch(grain, facing.patch);
    const auto found = patch.nearest(x, std::abs(facing.u - 0.3), std::abs(facing.v - 0.3));
    const auto place = patch.at(found.u, found.v);
    const Vec<3> d = x - place.place;
    if (has_edges && !found.inside) edge.add(d, place.normal());
    if (dot(d, d) >= least) continue;
    least = dot(d, d);
    way = d, inside = found.inside;
    contact.normal = place.normal();
    contact.gap = dot(d, contact.normal);
    set_master(contact, surfaces.grains.topology(grain).patches[facing.patch],
               surfaces.grains.outline_begin(grain), found.u, found.v);
    if (found.inside) break;
  }
  if (has_edges && !inside) edge.set_normal(way, surfaces.reach, contact);
  return contact;
}

/// Those of a rigid sphere, by its centre, with rigid grains of other shapes.
void add_contacts_of_sphere(const Surfaces& surfaces, double margin, int centre,
                            std::vector<SurfaceContact>& contacts) {
  const SolidGrains& grains = surfaces.grains;
  const double R = grains.radius(grains.grain_of_vertex(centre));
  const OutlineStateOf<3>& state = surfaces.state;
  const auto way = [&](int vertex) {
    const Vec<3> d = state.position[vertex] - state.position[centre];
    return state.cell.any() ? d + state.cell.shift(state.cell.nearest(d)) : d;
  };
  for (int g = 0; g < grains.size(); ++g) {
    if (!grains.topology(g).rigid_shape()) continue;
    const int end = grains.outline_end(g) - 1;  // its centre
    if (norm(way(end)) > R + grains.radius(g) + margin) continue;
    int nearest = grains.outline_begin(g);
    for (int v = nearest; v < end; ++v)
      if (norm(way(v)) < norm(way(nearest))) nearest = v;
    SurfaceContact contact = contact_with_patch(surfaces, centre, g, nearest);
    contact.offset = R;
    contact.gap -= R;
    if (contact.gap < margin) contacts.push_back(contact);
  }
}

/// The vertex of each other grain nearest to vertex v, within the reach; sorted by grain.
struct NearestVertex {
  int grain, vertex;
  double distance_squared;
};
void find_nearest(const Surfaces& surfaces, const ImagedGrid& grid, double reach, int v,
                  std::vector<NearestVertex>& near) {
  near.clear();
  const int grain = surfaces.grains.grain_of_vertex(v);
  grid.for_each_neighbour(v, [&](int w, const Vec<3>& d) {
    const int other = surfaces.grains.grain_of_vertex(w);
    if (other == grain || surfaces.grains.topology(other).ball) return;
    const double distance_squared = dot(d, d);
    if (distance_squared > reach * reach) return;
    const auto found =
        std::find_if(near.begin(), near.end(), [&](const NearestVertex& n) { return n.grain == other; });
    if (found == near.end())
      near.push_back({other, w, distance_squared});
    else if (std::pair(distance_squared, w) < std::pair(found->distance_squared, found->vertex))
      *found = {other, w, distance_squared};
  });
  std::sort(near.begin(), near.end(),
            [](const NearestVertex& a, const NearestVertex& b) { return a.grain < b.grain; });
}

/// Those of one vertex.
void add_contacts_of_vertex(const Surfaces& surfaces, const ImagedGrid& grid, double margin, int v,
                            std::vector<NearestVertex>& near, std::vector<SurfaceContact>& contacts) {
  const int own = surfaces.grains.grain_of_vertex(v);
  const SolidTopology& shape = surfaces.grains.topology(own);
  const bool is_centre = shape.rigid() && v + 1 == surfaces.grains.outline_end(own);
  if (shape.ball && is_centre) return add_contacts_of_sphere(surfaces, margin, v, contacts);
  if (shape.ball || is_centre) return;
  add_wall_contacts(surfaces.state, {.point = v, .vertex = v}, margin, contacts);
  find_nearest(surfaces, grid, surfaces.reach + margin, v, near);
  for (const NearestVertex& nearest : near) {
    const SurfaceContact contact = contact_with_patch(surfaces, v, nearest.grain, nearest.vertex);
    if (contact.gap < margin) contacts.push_back(contact);
  }
}

/// Those of the middle of one patch, with walls.
void add_contacts_of_patch(const Surfaces& surfaces, double margin, int patch,
                           std::vector<SurfaceContact>& contacts) {
  const auto next = std::upper_bound(surfaces.patch_begin.begin(), surfaces.patch_begin.end(), patch);
  const int grain = static_cast<int>(next - surfaces.patch_begin.begin()) - 1;
  if (surfaces.grains.topology(grain).ball) return;
  const PatchNet& net = surfaces.grains.topology(grain).patches[patch - surfaces.patch_begin[grain]];
  const int begin = surfaces.grains.outline_begin(grain);
  SurfaceContact contact{.point = surfaces.grains.outline_size() + patch, .vertex = begin + net.vertex[5]};
  set_master(contact, net, begin, 0.5, 0.5);
  add_wall_contacts(surfaces.state, contact, margin, contacts);
}

}  // namespace

std::vector<SurfaceContact> SurfaceNeighbours::detect(const SolidGrains& grains,
                                                      const OutlineStateOf<3>& state, double margin) const {
  const Surfaces surfaces(grains, state);
  const double gap = margin * surfaces.segment;
  const ImagedGrid grid(state.position, state.cell, surfaces.reach + gap);
  std::vector<SurfaceContact> contacts;
  append_in_parallel(grains.outline_size(), points_at_once, contacts,
                     [&](int v, std::vector<SurfaceContact>& list) {
                       thread_local std::vector<NearestVertex> near;
                       add_contacts_of_vertex(surfaces, grid, gap, v, near, list);
                     });
  if (!state.walls.empty())
    append_in_parallel(
        surfaces.patch_begin.back(), points_at_once, contacts,
        [&](int q, std::vector<SurfaceContact>& list) { add_contacts_of_patch(surfaces, gap, q, list); });
  if (grains.has_rigid()) add_sphere_contacts(grains, state, gap, contacts);
  return contacts;
}

double gap_now(const SurfaceContact& contact, const OutlineStateOf<3>& state) {
  Vec<3> apart = Vec<3>{} - contact.image;
  if (contact.wall >= 0) apart -= state.walls[contact.wall].point;
  contact.for_each_vertex([&](int v, double weight) { apart += weight * state.position[v]; });
  return dot(apart, contact.normal) - contact.offset;
}

double offset_of(const SurfaceContact& contact, const SolidGrains& grains) {
  double sum = 0;
  const auto add = [&](int vertex) {
    const int grain = grains.grain_of_vertex(vertex);
    if (grains.topology(grain).ball) sum += grains.radius(grain);
  };
  add(contact.vertex);
  if (contact.wall < 0) add(contact.master[5]);
  return sum;
}

void update_gap(SurfaceContact& contact, const OutlineStateOf<3>& state) {
  if (contact.wall < 0) set_image(contact, contact.master[5], state);
  contact.gap = gap_now(contact, state);
}

Vec<3> relative_displacement(const SurfaceContact& contact, const OutlineStateOf<3>& state) {
  Vec<3> displacement = Vec<3>{} - contact.image_motion;
  if (contact.wall >= 0) displacement -= state.dt * state.walls[contact.wall].velocity;
  contact.for_each_vertex(
      [&](int v, double weight) { displacement += weight * (state.position[v] - state.start[v]); });
  if (contact.offset > 0) {  // omega x (-R n) of either side
    displacement -= cross(state.rolled[contact.vertex], contact.normal);
    if (contact.wall < 0) displacement -= cross(state.rolled[contact.master[5]], contact.normal);
  }
  return displacement;
}

std::vector<Vec<3>> carried_impulses(const SolidGrains& grains, std::span<const SurfaceContact> old,
                                     std::span<const Vec<3>> old_impulse,
                                     std::span<const SurfaceContact> contacts) {
  return carry_impulses(
      old, old_impulse, contacts, [](const SurfaceContact& c) { return c.point; },
      [&](const SurfaceContact& c) { return facing_grain(c, grains); },
      [](const SurfaceContact& was, const Vec<3>& impulse, const SurfaceContact& now) {
        return to_local(now.normal, impulse_vector(was, impulse));
      });
}

}  // namespace softgrain
