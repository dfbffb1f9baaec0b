#include "softgrain/model/scene_in_cell.hpp"

#include <cmath>

namespace softgrain {
namespace {

/// H n that brings a point into the cell.
Vec<2> shift_into(const PeriodicCell<2>& cell, const Vec<2>& x) {
  const Vec<2> share = inverse(cell.edges) * x;
  PeriodicCell<2>::Image n{};
  for (std::size_t k = 0; k < 2; ++k)
    if (cell.repeats[k]) n[k] = -static_cast<int>(std::floor(share[static_cast<int>(k)]));
  return cell.shift(n);
}

/// Moves each row of "position" as its grain, `grain_of(row)`, is moved.
template <class GrainOf>
void move_rows(Arrays& arrays, std::span<const Vec<2>> shift, const GrainOf& grain_of) {
  const auto found = arrays.find("position");
  if (found == arrays.end()) return;
  auto& x = std::get<std::vector<double>>(found->second.values);
  for (std::size_t row = 0; 2 * row < x.size(); ++row)
    for (std::size_t d = 0; d < 2; ++d)
      x[2 * row + d] += shift[static_cast<std::size_t>(grain_of(row))][static_cast<int>(d)];
}

void move_with_grains(Arrays& arrays, std::span<const Vec<2>> shift) {
  if (!arrays.contains("grain")) return;
  const auto& grain = std::get<std::vector<std::int64_t>>(arrays.at("grain").values);
  move_rows(arrays, shift, [&](std::size_t row) { return grain[row]; });
}

}  // namespace

PeriodicCell<2> cell_of(const Scene& scene) {
  PeriodicCell<2> cell;
  if (scene.cell.size() != 4) return cell;
  for (int k = 0; k < 2; ++k) {
    const double* vector = &scene.cell[static_cast<std::size_t>(2 * k)];
    if (vector[0] == 0 && vector[1] == 0) continue;
    cell.repeats[static_cast<std::size_t>(k)] = true;
    for (int d = 0; d < 2; ++d) cell.edges(d, k) = vector[d];
  }
  return cell;
}

void move_into_cell(const PeriodicCell<2>& cell, std::span<const Vec<2>> centres, Scene& scene) {
  std::vector<Vec<2>> shift;
  for (const Vec<2>& x : centres) shift.push_back(shift_into(cell, x));
  move_with_grains(scene.particles, shift);
  move_with_grains(scene.outlines, shift);
  if (scene.contacts.contains("position")) {
    const auto& pair = std::get<std::vector<std::int64_t>>(scene.contacts.at("pair").values);
    move_rows(scene.contacts, shift, [&](std::size_t row) { return pair[2 * row]; });
  }
  const Mat<2>& H = cell.edges;
  scene.cell = {cell.repeats[0] ? H(0, 0) : 0, 0, cell.repeats[1] ? H(0, 1) : 0,
                cell.repeats[1] ? H(1, 1) : 0};
}

}  // namespace softgrain
