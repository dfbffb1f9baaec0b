#include <tuple>
#include <utility>

#include "softgrain/experiment/scene_of_box.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/model/scene_in_cell.hpp"

namespace softgrain {

/// In a periodic cell each grain is shown through its image whose centre lies there.
template <int Dim>
ParticleParts SimulationOf<Dim>::particle_parts() const {
  ParticleParts parts = model_->particle_parts();
  if (parts.count == 0 || !box_.cell.any()) return parts;
  parts.rows = [this, centres = model_->centres(), rows = std::move(parts.rows)](int part) {
    Scene moved;
    moved.particles = rows(part);
    move_into_cell<Dim>(box_.cell, centres, moved);
    return std::move(moved.particles);
  };
  return parts;
}

/// A scene with the walls, or a cell, around its grains.
template <int Dim>
Scene SimulationOf<Dim>::in_box(Scene scene) const {
  if constexpr (Dim == 3) {
    if (box_.cell.any()) move_into_cell<3>(box_.cell, model_->centres(), scene);
    add_faces(box_, model_->reach(), scene);
    return scene;
  } else {
    if (box_.cell.any()) move_into_cell<2>(box_.cell, model_->centres(), scene);
    const double low = box_.bounded(1) ? box_.low(1).point[1] : 0,
                 high = box_.bounded(1) ? box_.high(1).point[1] : box_.height();
    const double tilt = box_.repeats(1) ? box_.cell.edges(0, 1) : 0;
    auto [left, right] = std::pair(0.0, box_.width());
    if (box_.bounded(0))
      left = box_.low(0).point[0], right = box_.high(0).point[0];
    else if (!box_.repeats(0))
      std::tie(left, right) = model_->reach();
    scene.wall_segments = {left,        low,  right,        low,
                           left + tilt, high, right + tilt, high};                  // in the order of BoxWall
    if (box_.open_top && box_.walls[top_wall].open) scene.wall_segments[6] = left;  // nothing to see
    if (box_.faces() == 4)
      scene.wall_segments.insert(scene.wall_segments.end(),
                                 {left, low, left + tilt, high, right, low, right + tilt, high});
    return scene;
  }
}

template ParticleParts SimulationOf<2>::particle_parts() const;
template ParticleParts SimulationOf<3>::particle_parts() const;
template Scene SimulationOf<2>::in_box(Scene) const;
template Scene SimulationOf<3>::in_box(Scene) const;

}  // namespace softgrain
