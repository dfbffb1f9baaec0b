#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "softgrain/core/parallel.hpp"
#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/geometry/images.hpp"
#include "softgrain/soft/surface_contacts.hpp"

// What the lists of contacts of smooth surfaces and of rigid spheres have in common.

namespace softgrain {

/// Points that a thread takes at once.
inline constexpr int points_at_once = 256;

/// Points, and those of their images that lie near a periodic cell, sorted into cells of a size [m].
class ImagedGrid {
 public:
  ImagedGrid(std::span<const Vec<3>> points, const PeriodicCell<3>& cell, double size)
      : images_(images_of(points, cell, size)),
        position_(images_ ? std::span<const Vec<3>>(images_->position) : points),
        grid_(position_, size) {}

  /// visit(j, d): d is the way from point i to point j, or to an image of it.
  template <class Visit>
  void for_each_neighbour(int i, const Visit& visit) const {
    grid_.for_each_neighbour(i, [&](int at) {
      visit(images_ ? images_->point[static_cast<std::size_t>(at)] : at,
            position_[static_cast<std::size_t>(at)] - position_[static_cast<std::size_t>(i)]);
    });
  }

 private:
  static std::optional<Images<3>> images_of(std::span<const Vec<3>> points, const PeriodicCell<3>& cell,
                                            double reach) {
    if (!cell.any()) return std::nullopt;
    return Images<3>(points, cell, reach);
  }
  std::optional<Images<3>> images_;
  std::span<const Vec<3>> position_;
  CellGrid<3> grid_;
};

/// Takes over the net's vertices with their weights at (u, v).
inline void set_master(SurfaceContact& contact, const PatchNet& net, int first_vertex, double u, double v) {
  contact.patch = &net;
  contact.facing_begin = first_vertex;
  contact.weight = narrow_weights(patch_weights(net, u, v));
}

/// The image of the vertex `nearest` that the point `vertex` meets.
inline void set_image(SurfaceContact& contact, int nearest, const OutlineStateOf<3>& state) {
  if (!state.cell.any()) return;
  const auto n = state.cell.nearest(state.position[nearest] - state.position[contact.vertex]);
  contact.image = state.cell.shift(n);
  contact.image_motion = state.dt * state.cell.velocity(n);
}

/// Those of a point with walls.
inline void add_wall_contacts(const OutlineStateOf<3>& state, SurfaceContact contact, double margin,
                              std::vector<SurfaceContact>& contacts) {
  for (int w = 0; w < static_cast<int>(state.walls.size()); ++w) {
    if (state.walls[w].open) continue;
    contact.wall = w;
    contact.normal = state.walls[w].normal;
    contact.gap = gap_now(contact, state);
    if (contact.gap < margin) contacts.push_back(contact);
  }
}

/// add(i, list) for i = 0 .. count - 1 on all threads, `at_once` of them in one go; the lists one after the
/// other.
template <class Item, class Add>
void append_in_parallel(int count, int at_once, std::vector<Item>& all, const Add& add) {
  std::vector<std::vector<Item>> parts((count + at_once - 1) / at_once);
  parallel_for(static_cast<int>(parts.size()), [&](int k) {
    for (int i = k * at_once; i < std::min(count, (k + 1) * at_once); ++i) add(i, parts[k]);
  });
  std::size_t size = all.size();
  for (const auto& part : parts) size += part.size();
  all.reserve(size);
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
}

}  // namespace softgrain
