#include "softgrain/soft/topology.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {
namespace {

/// A vertex that turns by less than this, over their number, has no arc: 2 pi for a regular polygon.
constexpr double straight_turn = 1;

/// A vertex that turns by more than this many times what one of its neighbours does is a corner without an
/// arc.
constexpr double corner_turn = 2;

/// Below this a vertex lies on a straight side [rad].
constexpr double least_turn = 1e-6;

BlockPattern pattern_of(const ReferenceGrid& grid) {
  if (grid.cell.empty()) return {0, {}, 0};
  std::vector<std::array<int, 2>> edges;
  for (const auto& cell : grid.cell)
    for (int a = 1; a < 4; ++a)
      for (int b = 0; b < a; ++b) edges.push_back({cell[a], cell[b]});
  return {grid.nodes(), edges, grid.outline_nodes()};
}

CellShape shape_of(std::span<const MaterialPoint, 4> points) {
  const auto L = [&](int a, int b) {
    double sum = 0;
    for (const MaterialPoint& p : points) sum += p.volume * dot(p.gradient[a], p.gradient[b]);
    return sum;
  };
  CellShape shape{
      .L_11 = L(1, 1), .L_12 = L(1, 2), .L_13 = L(1, 3), .L_22 = L(2, 2), .L_23 = L(2, 3), .L_33 = L(3, 3)};
  double volume = 0;
  for (std::size_t p = 0; p < 4; ++p)
    shape.inverse_area[p] = 1 / (4 * points[p].volume), volume += points[p].volume;
  shape.inverse_volume = 1 / volume;
  return shape;
}

/// By how much a closed outline turns at each vertex.
std::vector<double> turns_of(std::span<const Vec<2>> outline) {
  const std::size_t n = outline.size();
  const auto at = [&](std::size_t v) { return outline[v % n]; };
  std::vector<double> turn;
  for (std::size_t v = 0; v < n; ++v) {
    const Vec<2> before = at(v) - at(v + n - 1), after = at(v + 1) - at(v);
    turn.push_back(std::atan2(-dot(before, perpendicular(after)), dot(before, after)));
  }
  return turn;
}

OutlineArc arc_of(std::span<const Vec<2>> outline, std::size_t v, double turn) {
  const std::size_t n = outline.size();
  const double l = norm(outline[(v + 1) % n] - outline[(v + n - 1) % n]) / 2;
  return {.half_chord = l, .radius = l / std::sin(turn), .end_sine = std::sin(turn / 2)};
}

/// The arcs of a closed outline, counter-clockwise, whose corners show by its turns alone.
std::vector<OutlineArc> arcs_of(std::span<const Vec<2>> outline) {
  const std::size_t n = outline.size();
  const std::vector<double> turn = turns_of(outline);
  std::vector<OutlineArc> arcs(n);
  for (std::size_t v = 0; v < n; ++v) {
    const double beside = std::min(turn[(v + n - 1) % n], turn[(v + 1) % n]);
    if (turn[v] < straight_turn / static_cast<double>(n) || turn[v] > corner_turn * beside) continue;
    arcs[v] = arc_of(outline, v, turn[v]);
  }
  return arcs;
}

/// True for a regular polygon about the origin.
bool is_round(std::span<const Vec<2>> outline) {
  constexpr double nothing = 1e-9;
  const double side = norm(outline[1] - outline[0]);
  for (std::size_t v = 0; v < outline.size(); ++v)
    if (std::abs(norm(outline[v]) - norm(outline[0])) > nothing ||
        std::abs(norm(outline[(v + 1) % outline.size()] - outline[v]) - side) > nothing)
      return false;
  return true;
}

}  // namespace

std::vector<OutlineArc> arcs_between(std::span<const Vec<2>> outline, std::span<const char> corner) {
  const std::vector<double> turn = turns_of(outline);
  std::vector<OutlineArc> arcs(outline.size());
  for (std::size_t v = 0; v < outline.size(); ++v)
    if (corner[v] == 0 && turn[v] > least_turn) arcs[v] = arc_of(outline, v, turn[v]);
  return arcs;
}

Topology::Topology(ReferenceGrid reference_grid)
    : grid(std::move(reference_grid)),
      points(material_points(grid)),
      node_volume(grid.nodes(), 0),
      arc(arcs_of(grid.outline())),
      area(grid.fullness * polygon_area(grid.outline())),
      round(is_round(grid.outline())),
      pattern(pattern_of(grid)) {
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int a = 0; a < 4; ++a)
      node_volume[grid.cell[p / 4][a]] += grid.fullness * points[p].shape[a] * points[p].volume;
  for (std::size_t p = 0; p < points.size(); p += 4)
    cell_shapes.push_back(shape_of(std::span(points).subspan(p).first<4>()));
  for (const auto& cell : grid.cell)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b <= a; ++b)
        cell_blocks.push_back(
            {pattern.block(cell[a], cell[b]), a != b && pattern.transposed(cell[a], cell[b])});
}

Topology::Topology(ReferenceGrid reference_grid, std::vector<char> corners)
    : Topology(std::move(reference_grid)) {
  corner = std::move(corners);
  arc = arcs_between(grid.outline(), corner);
}

double reach_of(const Topology& shape, const Vec<2>& direction) {
  const std::span<const Vec<2>> X = shape.grid.outline();
  const std::size_t n = X.size();
  double reach = dot(X[0], direction);
  for (std::size_t v = 0; v < n; ++v) {
    double of_vertex = dot(X[v], direction);
    if (const OutlineArc& arc = shape.arc[v]; arc.end_sine > 0) {
      const double s = dot(X[(v + 1) % n] - X[(v + n - 1) % n], direction) / 2;
      const double sine = std::clamp(s / arc.half_chord, -arc.end_sine, arc.end_sine);
      const double cosine = std::sqrt(1 - sine * sine);
      of_vertex += arc.radius * (sine / arc.half_chord * s / cosine - (1 / cosine - 1));
    }
    reach = std::max(reach, of_vertex);
  }
  return reach;
}

/// Of a rigid grain whose vertices do not lie evenly about its centre of mass: their shares are
/// c (1 + b . X), so that sum m X = 0 and sum m |X|^2 = moment.
void Topology::balance(double moment) {
  Vec<2> first;
  Mat<2> second;
  for (const Vec<2>& X : grid.outline()) {
    first += X;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) second(i, j) += X[i] * X[j];
  }
  const Vec<2> b = -(inverse(second) * first);
  double squares = 0, sum = 0;
  for (const Vec<2>& X : grid.outline()) squares += (1 + dot(b, X)) * dot(X, X);
  for (int i = grid.outline_begin; i < grid.nodes(); ++i) {
    const Vec<2>& X = grid.node[i];
    require(1 + dot(b, X) > 0,
            "the outline of a rigid grain is too uneven: too many vertices on one side of its centre");
    sum += node_volume[i] = moment / squares * (1 + dot(b, X));
  }
  node_volume[0] = area - sum;
}

Topology::Topology(ReferenceGrid outline, double moment, std::vector<char> corners)
    : Topology(std::move(outline)) {
  corner = std::move(corners);
  for (std::size_t v = 0; v < corner.size(); ++v)
    if (corner[v] != 0) arc[v] = {}, round = false;
  double squares = 0;
  for (const Vec<2>& X : grid.outline()) squares += dot(X, X);
  node_volume.assign(grid.nodes(), moment / squares);
  node_volume[0] = area - grid.outline_nodes() * (moment / squares);
  Vec<2> first;
  for (const Vec<2>& X : grid.outline()) first += X;
  constexpr double nothing = 1e-9;
  if (norm(first) > nothing * grid.outline_nodes()) balance(moment);
}

}  // namespace softgrain
