#include "softgrain/model/scene_in_cell.hpp"

#include <algorithm>
#include <cmath>

namespace softgrain {
namespace {

/// H n that brings a point into the cell.
template <int Dim>
Vec<Dim> shift_into(const PeriodicCell<Dim>& cell, const Vec<Dim>& x) {
  const Vec<Dim> share = inverse(cell.edges) * x;
  typename PeriodicCell<Dim>::Image n{};
  for (std::size_t k = 0; k < Dim; ++k)
    if (cell.repeats[k]) n[k] = -static_cast<int>(std::floor(share[static_cast<int>(k)]));
  return cell.shift(n);
}

/// Moves each row of "position" as its grain, `grain_of(row)`, is moved.
template <int Dim, class GrainOf>
void move_rows(Arrays& arrays, const std::vector<Vec<Dim>>& shift, const GrainOf& grain_of) {
  const auto found = arrays.find("position");
  if (found == arrays.end()) return;
  auto& x = std::get<std::vector<double>>(found->second.values);
  for (std::size_t row = 0; Dim * row < x.size(); ++row)
    for (std::size_t d = 0; d < Dim; ++d)
      x[Dim * row + d] += shift[static_cast<std::size_t>(grain_of(row))][static_cast<int>(d)];
}

template <int Dim>
void move_with_grains(Arrays& arrays, const std::vector<Vec<Dim>>& shift) {
  if (!arrays.contains("grain")) return;
  const auto& grain = std::get<std::vector<std::int64_t>>(arrays.at("grain").values);
  move_rows(arrays, shift, [&](std::size_t row) { return grain[row]; });
}

}  // namespace

template <int Dim>
PeriodicCell<Dim> cell_of(const Scene& scene) {
  PeriodicCell<Dim> cell;
  if (scene.cell.size() != Dim * Dim) return cell;
  for (int k = 0; k < Dim; ++k) {
    const std::span vector(&scene.cell[static_cast<std::size_t>(Dim * k)], Dim);
    if (std::all_of(vector.begin(), vector.end(), [](double x) { return x == 0; })) continue;
    cell.repeats[static_cast<std::size_t>(k)] = true;
    for (int d = 0; d < Dim; ++d) cell.edges(d, k) = vector[static_cast<std::size_t>(d)];
  }
  return cell;
}

template <int Dim>
void move_into_cell(const PeriodicCell<Dim>& cell, std::span<const Vec<Dim>> centres, Scene& scene) {
  std::vector<Vec<Dim>> shift;
  for (const Vec<Dim>& x : centres) shift.push_back(shift_into(cell, x));
  move_with_grains(scene.particles, shift);
  move_with_grains(scene.outlines, shift);
  if (scene.contacts.contains("position")) {
    const auto& pair = std::get<std::vector<std::int64_t>>(scene.contacts.at("pair").values);
    move_rows(scene.contacts, shift, [&](std::size_t row) { return pair[2 * row]; });
  }
  scene.cell.clear();
  for (int k = 0; k < Dim; ++k)
    for (int d = 0; d < Dim; ++d)
      scene.cell.push_back(cell.repeats[static_cast<std::size_t>(k)] ? cell.edges(d, k) : 0);
}

template PeriodicCell<2> cell_of<2>(const Scene&);
template PeriodicCell<3> cell_of<3>(const Scene&);
template void move_into_cell<2>(const PeriodicCell<2>&, std::span<const Vec<2>>, Scene&);
template void move_into_cell<3>(const PeriodicCell<3>&, std::span<const Vec<3>>, Scene&);

}  // namespace softgrain
