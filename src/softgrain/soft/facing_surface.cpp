#include "softgrain/soft/facing_surface.hpp"

#include <array>
#include <limits>
#include <vector>

#include "softgrain/soft/surface_lists.hpp"

namespace softgrain {
namespace {

/// A patch round a vertex, and how far x lies within it: the smaller of its two coordinates from the vertex.
struct FacingPatch {
  int patch = 0;
  double u = 0, v = 0;  // of the vertex
  double within = 0;
};

/// At most four of them, the one with the largest `within` first.
class FacingPatches {
 public:
  void add(const FacingPatch& next) {
    std::size_t k = size_++;
    for (; k > 0 && patch_[k - 1].within < next.within; --k) patch_[k] = patch_[k - 1];
    patch_[k] = next;
  }
  const FacingPatch* begin() const { return patch_.data(); }
  const FacingPatch* end() const { return patch_.data() + size_; }

 private:
  std::array<FacingPatch, 4> patch_;
  std::size_t size_ = 0;
};

/// The patches round a vertex, the one that x faces first.
FacingPatches patches_facing(const Surfaces& surfaces, int grain, int vertex, const Vec<3>& x) {
  const SolidTopology& topology = surfaces.grains.topology(grain);
  const int begin = surfaces.grains.outline_begin(grain), local = vertex - begin;
  const PaddedVec* position = surfaces.first_of(grain);
  const Vec<3> d = x - position[local];
  FacingPatches facing;
  for (const int q : topology.quads_round[local]) {
    if (q < 0) continue;
    const auto& net = topology.patches[q].vertex;
    std::size_t k = 0;
    while (net[PatchNet::corner[k]] != local) ++k;
    const Vec<3> a = position[net[PatchNet::corner[(k + 1) % 4]]] - position[local],
                 b = position[net[PatchNet::corner[(k + 3) % 4]]] - position[local];
    const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), da = dot(d, a), db = dot(d, b);
    facing.add({.patch = q,
                .u = k == 1 || k == 2 ? 1.0 : 0.0,
                .v = k >= 2 ? 1.0 : 0.0,
                .within = std::min(bb * da - ab * db, aa * db - ab * da) / (aa * bb - ab * ab)});
  }
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

}  // namespace

SurfaceContact contact_with_patch(const Surfaces& surfaces, const SurfaceContact& point, const Vec<3>& at,
                                  int grain, int nearest, double far) {
  SurfaceContact contact = point;
  contact.facing = grain;
  set_image(contact, nearest, surfaces.state);
  const Vec<3> x = at - contact.image;
  const SolidTopology& topology = surfaces.grains.topology(grain);
  const bool has_edges = topology.rigid_shape();
  if (!has_edges) {
    contact.gap = dot(x - surfaces.state.position[nearest], surfaces.normal[nearest]);
    if (contact.gap > far) return contact;
  }
  FacesOfEdge edge;
  Vec<3> way;  // to the nearest place
  bool inside = false;
  double least = std::numeric_limits<double>::infinity();
  const auto look_at = [&](const SurfacePatch& patch, int index, double u, double v) {
    const auto found = patch.nearest(x, u, v);
    const auto place = patch.at(found.u, found.v);
    const Vec<3> d = x - place.place;
    if (has_edges && !found.inside) edge.add(d, place.normal());
    if (dot(d, d) >= least) return;
    least = dot(d, d);
    way = d, inside = found.inside;
    contact.normal = place.normal();
    contact.gap = dot(d, contact.normal);
    set_master(contact, topology.patches[index], surfaces.grains.outline_begin(grain), found.u, found.v);
  };
  for (const FacingPatch& facing : patches_facing(surfaces, grain, nearest, x)) {
    const SurfacePatch patch = surfaces.patch(grain, facing.patch);
    look_at(patch, facing.patch, std::abs(facing.u - 0.3), std::abs(facing.v - 0.3));
    if (inside) break;
  }
  if (has_edges && !inside) edge.set_normal(way, surfaces.reach, contact);
  // So deep in a soft grain no contact lets it come: the point is in front of a fin that has been squeezed
  // out, and its nearest vertex is on the other side.
  constexpr double deep = 0.02;
  if (!has_edges && contact.gap < -deep * surfaces.segment)
    for (int q = 0; q < static_cast<int>(topology.patches.size()); ++q)
      if (const SurfacePatch patch = surfaces.patch(grain, q);
          norm(x - patch.at(0.5, 0.5).place) < std::sqrt(least) + 1.5 * surfaces.reach)
        look_at(patch, q, 0.5, 0.5);
  return contact;
}

}  // namespace softgrain
