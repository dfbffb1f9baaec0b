#pragma once
#include <span>

#include "softgrain/geometry/periodic_cell.hpp"
#include "softgrain/model/model.hpp"

namespace softgrain {

/// Shows each grain through its image whose centre lies in the cell, with the edges of the cell in place of
/// walls that are not there, in the order of BoxWall. Grains reach across the edges; their other images are
/// not shown, but scene.cell says where they are.
template <int Dim>
void move_into_cell(const PeriodicCell<Dim>& cell, std::span<const Vec<Dim>> centres, Scene& scene);

/// That of a scene; without lattice vectors nothing repeats.
template <int Dim>
PeriodicCell<Dim> cell_of(const Scene& scene);

}  // namespace softgrain
