#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <type_traits>

#include "softgrain/core/shared_loop.hpp"
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

/// What a scene says of the material points of some grains, column by column.
class PointRows {
 public:
  explicit PointRows(const SoftGrains& grains) : grains_(grains) {}

  void reserve(std::size_t rows) {
    for_each_column([&](const char*, std::size_t columns, auto& values) { values.reserve(columns * rows); });
  }
  void add(int g, const std::vector<PointState>& states);
  void add(int g, const RigidPoints& points);
  /// visit(name, columns, values) for those that scenes of these grains have.
  template <class Visit>
  void for_each_column(Visit&& visit) {
    visit("position", 2, position_);
    visit("radius", 1, radius_);
    visit("pressure", 1, pressure_);
    visit("J", 1, dilatation_);
    visit("stress", 4, stress_);
    if (grains_.has_history()) visit("von_mises_stress", 1, von_mises_), visit("plastic_strain", 1, plastic_);
    if (grains_.kinds() > 1) visit("kind", 1, kind_);
    visit("grain", 1, grain_);
  }
  Arrays take() {
    Arrays arrays;
    for_each_column([&](const char* name, std::size_t columns, auto& values) {
      arrays[name] = {columns, std::move(values)};
    });
    return arrays;
  }

 private:
  void add_point(int g, const Vec<2>& x, double radius, double J, const PointState& state);

  const SoftGrains& grains_;
  std::vector<double> position_, radius_, pressure_, dilatation_, stress_, von_mises_, plastic_;
  std::vector<std::int64_t> kind_, grain_;
};

void PointRows::add_point(int g, const Vec<2>& x, double radius, double J, const PointState& state) {
  position_.insert(position_.end(), x.c.begin(), x.c.end());
  radius_.push_back(radius);
  pressure_.push_back(state.pressure);
  dilatation_.push_back(J);
  stress_.insert(stress_.end(), state.stress.c.begin(), state.stress.c.end());
  if (grains_.has_history()) von_mises_.push_back(state.von_mises), plastic_.push_back(state.plastic_strain);
  if (grains_.kinds() > 1) kind_.push_back(grains_.kind(g));
  grain_.push_back(g);
}

void PointRows::add(int g, const RigidPoints& points) {
  for (const Vec<2>& x : points.position)
    add_point(g, x, points.radius, 1,
              {.F = {}, .stress = points.stress, .pressure = -trace(points.stress) / 2});
}

void PointRows::add(int g, const std::vector<PointState>& states) {
  const Topology& shape = grains_.topology(g);
  for (std::size_t p = 0; p < states.size(); ++p) {
    Vec<2> x;
    for (int a = 0; a < 4; ++a)
      x += shape.points[p].shape[a] * grains_.node_position(g, shape.grid.cell[p / 4][a]);
    const double J = determinant(states[p].F), V = shape.grid.fullness * shape.points[p].volume;
    add_point(g, x, grains_.radius(g) * std::sqrt(J * V / std::numbers::pi), J, states[p]);
  }
}

/// Grains begin .. end - 1, which one rank has.
struct ScenePart {
  int begin = 0, end = 0, rank = 0;
};

std::vector<ScenePart> scene_parts(const SoftGrains& grains) {
  std::vector<ScenePart> parts;
  for (int g = 0; g < grains.size(); ++g) {
    const int rank = grains.shares.rank_of(grains.batch_number(g));
    if (parts.empty() || parts.back().rank != rank || g - parts.back().begin == Wide::size)
      parts.push_back({.begin = g, .end = g, .rank = rank});
    parts.back().end = g + 1;
  }
  return parts;
}

int count_of_points(const SoftGrains& grains, int g) {
  const Topology& shape = grains.topology(g);
  return shape.rigid() ? 4 : static_cast<int>(shape.points.size());
}

std::size_t count_of_points(const SoftGrains& grains) {
  std::size_t count = 0;
  for (int g = 0; g < grains.size(); ++g) count += static_cast<std::size_t>(count_of_points(grains, g));
  return count;
}

/// What the points of rigid grains are made of: outlines, and contact forces on them.
struct OutlineForces {
  std::vector<Vec<2>> outline, force;
};

OutlineForces outline_forces(const SoftView& view) {
  OutlineForces both;
  view.grains.gather_outline(both.outline);
  both.force = contact_forces(view.grains, view.contacts, felt_impulses(view.impulse, view.attraction),
                              view.impulse_time);
  return both;
}

void add_part(const SoftGrains& grains, const OutlineForces& felt, const ScenePart& part, PointRows& rows) {
  std::map<int, std::array<std::vector<PointState>, Wide::size>> states;  // of the part's batches
  std::map<int, unsigned> lanes;
  for (int g = part.begin; g < part.end; ++g)
    if (!grains.topology(g).rigid()) lanes[grains.batch_number(g)] |= 1U << grains.batch_of(g).second;
  for (const auto& [batch, of_part] : lanes)
    states[batch] = point_states(grains, grains.batches[batch], of_part);
  for (int g = part.begin; g < part.end; ++g)
    if (grains.topology(g).rigid())
      rows.add(g, rigid_points(grains, g, felt.outline, felt.force));
    else
      rows.add(g, states[grains.batch_number(g)][grains.batch_of(g).second]);
}

}  // namespace

ParticleParts particle_parts(const SoftView& view) {
  const SoftGrains& grains = view.grains;
  ParticleParts parts;
  const std::size_t rows = count_of_points(grains);
  PointRows(grains).for_each_column([&]<class T>(const char* name, std::size_t columns, std::vector<T>&) {
    parts.arrays[name] = {.rows = rows, .columns = columns, .integers = !std::is_same_v<T, double>};
  });
  const std::vector<ScenePart> all = scene_parts(grains);
  parts.count = static_cast<int>(all.size());
  parts.rows = [&grains, all, felt = grains.has_rigid() ? outline_forces(view) : OutlineForces{}](int k) {
    PointRows of_part(grains);
    tell_first(
        all[k].rank, [&] { add_part(grains, felt, all[k], of_part); },
        [&](Message& message) {
          of_part.for_each_column([&](const char*, std::size_t, auto& values) { message.list(values); });
        });
    return of_part.take();
  };
  return parts;
}

Scene scene_around_points(const SoftView& view) {
  const SoftGrains& grains = view.grains;
  const OutlineForces felt = outline_forces(view);
  std::vector<std::int64_t> grain_of_vertex;
  for (int v = 0; v < grains.outline_size(); ++v) grain_of_vertex.push_back(grains.grain_of_vertex(v));
  Scene scene;
  scene.outlines["position"] = to_array(felt.outline);
  scene.outlines["force"] = to_array(felt.force);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
  scene.contacts = grain_contacts(contact_points(view), grains.size());
  return scene;
}

Scene soft_scene(const SoftView& view) {
  const SoftGrains& grains = view.grains;
  const OutlineForces felt = grains.has_rigid() ? outline_forces(view) : OutlineForces{};
  PointRows rows(grains);
  rows.reserve(count_of_points(grains));
  for (const ScenePart& part : scene_parts(grains)) add_part(grains, felt, part, rows);
  Scene scene = scene_around_points(view);
  scene.particles = rows.take();
  return scene;
}

}  // namespace softgrain
