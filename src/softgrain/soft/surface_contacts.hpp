#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/contact/tangents.hpp"
#include "softgrain/soft/outline_state.hpp"
#include "softgrain/soft/solid_equilibrium.hpp"

namespace softgrain {

/// A point of a grain in space against another grain's outline (the master), or against a wall. The finer
/// grain of a pair (Surfaces::brings_points) brings its vertices and the middles of its patches and edges,
/// half as far apart as the vertices, so that neither outline bulges into the other between them. Rigid
/// grains bring no middles of edges.
///
/// Place and normal on the master are those where the contact was found. Until it is looked for again they
/// stay, and with them the weights: the gap n . sum weight x is linear in the vertices, so that impulses with
/// these weights do the work of the gap, and contact makes no energy.
struct SurfaceContact {
  /// Number of the point: an outline vertex, or behind all of these a middle, as Middles numbers them
  int point = 0;
  int vertex = 0;                     ///< the point itself, or beside it
  int wall = -1;                      ///< or -1
  int grain = 0;                      ///< whose point it is
  int facing = -1;                    ///< the master, or -1 at a wall
  const SurfacePoint* own = nullptr;  ///< the middle, of the grain's shape; or none
  int own_begin = 0;                  ///< first outline vertex of that grain
  int facing_begin = 0;               ///< first outline vertex of the master; of a sphere the one that it has
  const PatchNet* patch = nullptr;    ///< that it faces, of the master's shape; none at a wall
  PatchWeights weight{};              ///< of the patch's vertices
  Vec<3> normal{};                    ///< unit, from the master or wall to the point
  double gap = 0;                     ///< where the contact was found [m], open > 0
  double offset = 0;                  ///< sum of the radii of the rigid spheres that take part [m]
  Vec<3> image{};         ///< from where the master is to where the point meets it, in a periodic cell [m]
  Vec<3> image_motion{};  ///< of that image against the master over the step [m]

  /// One of the master's vertices at the patch.
  int facing_vertex() const { return facing_begin + patch->vertex[PatchNet::corner[0]]; }
  /// visit(vertex, weight) for the vertices of the point: its place is sum weight x.
  template <class Visit>
  void for_each_own_vertex(Visit&& visit) const {
    if (own == nullptr) return visit(vertex, 1.0);
    for (std::size_t k = 0; k < static_cast<std::size_t>(own->count); ++k)
      if (own->weight[k] != 0) visit(own_begin + own->vertex[k], own->weight[k]);
  }
  /// The same for those of the master, if there is one; weights with the sign that they have in the gap.
  template <class Visit>
  void for_each_facing_vertex(Visit&& visit) const {
    if (wall >= 0) return;
    for (std::size_t k = 0; k < 16; ++k)
      if (weight[k] != 0) visit(facing_begin + patch->vertex[k], -static_cast<double>(weight[k]));
  }
  /// For all vertices that take part: dg = n . sum weight dx.
  template <class Visit>
  void for_each_vertex(Visit&& visit) const {
    for_each_own_vertex(visit);
    for_each_facing_vertex(visit);
  }
};

/// The middles of the patches of all grains, then those of the edges of all grains. As points they are
/// numbered behind the outline vertices. Keeps a reference to the grains.
class Middles {
 public:
  explicit Middles(const SolidGrains& grains);
  int size() const { return begin_.back(); }
  /// The middle i from 0, with nothing that it meets yet.
  SurfaceContact point(int i) const;

 private:
  const SolidGrains& grains_;
  std::vector<int> begin_{0};  // (2 grains + 1) patches of each grain, then edges of each
};

/// Finds the contacts of outlines in space. It remembers nothing, so that whoever goes on from a snapshot
/// finds the same.
class SurfaceNeighbours {
 public:
  /// All contacts with gap < margin, sorted by (point, master grain or wall); the margin is in units of
  /// segment_length of the grains, in the mean. Cost O(vertices).
  std::vector<SurfaceContact> detect(const SolidGrains& grains, const OutlineStateOf<3>& state,
                                     double margin) const;
};

/// Where the point of a contact is, of outlines at x [m].
Vec<3> place_of(const SurfaceContact& contact, std::span<const PaddedVec> x);

/// Sum of the radii of the rigid spheres that take part in a contact [m].
double offset_of(const SurfaceContact& contact, const SolidGrains& grains);

/// Brings the image of a contact up to where its vertices and the periodic cell are now.
void update_image(SurfaceContact& contact, const OutlineStateOf<3>& state);

/// Gap of a contact when its bodies have moved a little since it was found [m].
double gap_now(const SurfaceContact& contact, const OutlineStateOf<3>& state);

/// p_n n + p_t t [N s], on the point.
inline Vec<3> impulse_vector(const SurfaceContact& contact, const Vec<3>& impulse) {
  return from_local(contact.normal, impulse);
}

/// Displacement of the point since the start of the step, less that of the place, its image or the wall that
/// it faces [m].
Vec<3> relative_displacement(const SurfaceContact& contact, const OutlineStateOf<3>& state);

/// Impulses of `old` contacts [N s], given to the new contacts of the same point and master grain or wall.
/// Both lists are sorted by point.
std::vector<Vec<3>> carried_impulses(const SolidGrains& grains, std::span<const SurfaceContact> old,
                                     std::span<const Vec<3>> old_impulse,
                                     std::span<const SurfaceContact> contacts);

}  // namespace softgrain
