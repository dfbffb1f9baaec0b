#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "softgrain/math/tensor.hpp"
#include "softgrain/soft/elastic_contacts.hpp"
#include "softgrain/soft/outline_adhesion.hpp"
#include "softgrain/soft/point_states.hpp"
#include "softgrain/soft/soft_view.hpp"

namespace softgrain {
namespace {

/// Of a rigid grain: four points about its centre, as those of a cell are, that share its area and the mean
/// stress of its contacts, A^-1 sum (x - x_c) (x) f. force: on the outline's vertices [N/m].
struct RigidPoints {
  std::array<Vec<2>, 4> position;
  double radius = 0;
  Mat<2> stress;
};
RigidPoints rigid_points(const SoftGrains& grains, int g, std::span<const Vec<2>> outline,
                         std::span<const Vec<2>> force) {
  const Topology& shape = grains.topology(g);
  const double R = grains.radius(g), area = shape.area * R * R;
  const Vec<2> centre = grains.node_position(g, 0);
  RigidPoints points{.position = {}, .radius = std::sqrt(area / 4 / std::numbers::pi), .stress = {}};
  double least = R;
  for (int v = grains.outline_begin(g); v < grains.outline_end(g); ++v) {
    const Vec<2> r = outline[v] - centre;
    least = std::min(least, norm(r));
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) points.stress(i, j) += r[i] * force[v][j] / area;
  }
  const double away = least / std::sqrt(6.0);  // of a square within: 1/sqrt(2), its Gauss points 1/sqrt(3)
  points.position = {centre + Vec<2>{-away, -away}, centre + Vec<2>{away, -away},
                     centre + Vec<2>{-away, away}, centre + Vec<2>{away, away}};
  return points;
}

}  // namespace

Scene soft_scene(const SoftView& view) {
  const SoftGrains& grains = view.grains;
  std::vector<Vec<2>> position;
  std::vector<double> radius, pressure, dilatation, stress, von_mises, plastic_strain;
  std::vector<std::int64_t> grain_of_point, grain_of_vertex;
  std::vector<Vec<2>> outline;
  grains.gather_outline(outline);
  const std::vector<Vec<2>> forces =
      contact_forces(grains, view.contacts, felt_impulses(view.impulse, view.attraction), view.impulse_time);
  for (int g = 0; g < grains.size(); ++g) {
    const Topology& shape = grains.topology(g);
    grain_of_vertex.insert(grain_of_vertex.end(), grains.outline_end(g) - grains.outline_begin(g), g);
    if (shape.rigid()) {
      const RigidPoints points = rigid_points(grains, g, outline, forces);
      for (const Vec<2>& x : points.position) {
        position.push_back(x);
        radius.push_back(points.radius);
        pressure.push_back(-trace(points.stress) / 2);
        von_mises.push_back(0);
        plastic_strain.push_back(0);
        dilatation.push_back(1);
        stress.insert(stress.end(), points.stress.c.begin(), points.stress.c.end());
        grain_of_point.push_back(g);
      }
      continue;
    }
    const std::vector<PointState> states = point_states(grains, g);
    for (std::size_t p = 0; p < states.size(); ++p) {
      Vec<2> x;
      for (int a = 0; a < 4; ++a)
        x += shape.points[p].shape[a] * grains.node_position(g, shape.grid.cell[p / 4][a]);
      const double J = determinant(states[p].F);
      position.push_back(x);
      const double V = shape.grid.fullness * shape.points[p].volume;
      radius.push_back(grains.radius(g) * std::sqrt(J * V / std::numbers::pi));
      pressure.push_back(states[p].pressure);
      von_mises.push_back(states[p].von_mises);
      plastic_strain.push_back(states[p].plastic_strain);
      dilatation.push_back(J);
      stress.insert(stress.end(), states[p].stress.c.begin(), states[p].stress.c.end());
      grain_of_point.push_back(g);
    }
  }
  Scene scene;
  scene.particles["position"] = to_array(position);
  scene.particles["radius"] = {1, std::move(radius)};
  scene.particles["pressure"] = {1, std::move(pressure)};
  scene.particles["J"] = {1, std::move(dilatation)};
  scene.particles["stress"] = {4, std::move(stress)};
  if (grains.has_history()) {
    scene.particles["von_mises_stress"] = {1, std::move(von_mises)};
    scene.particles["plastic_strain"] = {1, std::move(plastic_strain)};
  }
  if (grains.kinds() > 1) {
    std::vector<std::int64_t> kind;
    for (const std::int64_t g : grain_of_point) kind.push_back(grains.kind(static_cast<int>(g)));
    scene.particles["kind"] = {1, std::move(kind)};
  }
  scene.particles["grain"] = {1, std::move(grain_of_point)};
  scene.outlines["position"] = to_array(outline);
  scene.outlines["force"] = to_array(forces);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  scene.contacts = grain_contacts(contact_points(view), grains.size());
  return scene;
}

}  // namespace softgrain
