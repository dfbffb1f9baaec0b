#include "softgrain/soft/rigid_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace softgrain {
namespace {

constexpr int conditions = 9;
using Row = std::array<double, conditions>;

/// What the masses of nodes are held to: x, y, z, xx, yy, zz, xy, yz, zx.
Row row_of(const Vec<3>& X) {
  return {X[0], X[1], X[2], X[0] * X[0], X[1] * X[1], X[2] * X[2], X[0] * X[1], X[1] * X[2], X[2] * X[0]};
}

/// c of A c = b, A symmetric and positive definite, by Gauss's elimination.
Row solved(std::array<Row, conditions> A, Row b) {
  constexpr std::size_t n = conditions;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = k + 1; i < n; ++i) {
      const double f = A[i][k] / A[k][k];
      for (std::size_t j = k; j < n; ++j) A[i][j] -= f * A[k][j];
      b[i] -= f * b[k];
    }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
  return b;
}

Vec<3> normal_of(const SolidGrid& outline, const std::array<int, 4>& quad) {
  const Vec<3> n = cross(
      outline.node[static_cast<std::size_t>(quad[2])] - outline.node[static_cast<std::size_t>(quad[0])],
      outline.node[static_cast<std::size_t>(quad[3])] - outline.node[static_cast<std::size_t>(quad[1])]);
  return (1 / norm(n)) * n;
}

/// The edges of a mesh at which it turns by more than least_edge, as places along each.
std::vector<Vec<3>> places_of_edges(const TriangleMesh& mesh) {
  constexpr int places = 33;
  std::map<std::pair<int, int>, Vec<3>> normal_at;  // of the triangle that runs along a side so
  const auto x = [&](int v) -> const Vec<3>& { return mesh.vertex[static_cast<std::size_t>(v)]; };
  for (const auto& [a, b, c] : mesh.triangle) {
    const Vec<3> n = cross(x(b) - x(a), x(c) - x(a));
    const Vec<3> unit = (1 / norm(n)) * n;
    normal_at[{a, b}] = normal_at[{b, c}] = normal_at[{c, a}] = unit;
  }
  std::vector<Vec<3>> all;
  for (const auto& [side, normal] : normal_at) {
    const auto [a, b] = side;
    if (a > b || dot(normal, normal_at.at({b, a})) >= std::cos(least_edge)) continue;
    for (int k = 0; k < places; ++k) {
      const Vec<3> place = x(a) + (static_cast<double>(k) / (places - 1)) * (x(b) - x(a));
      all.push_back((1 / norm(place)) * place);
    }
  }
  return all;
}

/// Marks the sides of patches along which two quads meet at an edge of the mesh.
void find_edges(const std::vector<Vec<3>>& edges, SolidTopology& shape) {
  const SolidGrid& outline = shape.grid;
  const auto node = [&](int v) -> const Vec<3>& { return outline.node[static_cast<std::size_t>(v)]; };
  std::map<std::pair<int, int>, std::size_t> quad_at;  // by a side, as the quad runs along it
  for (std::size_t q = 0; q < outline.quad.size(); ++q)
    for (std::size_t k = 0; k < 4; ++k) quad_at[{outline.quad[q][k], outline.quad[q][(k + 1) % 4]}] = q;
  const auto near_an_edge = [&](int a, int b) {
    const Vec<3> middle = 0.5 * ((1 / norm(node(a))) * node(a) + (1 / norm(node(b))) * node(b));
    const double reach =
        norm((1 / norm(node(a))) * node(a) - middle);  // half of the side, seen from the centre
    return std::any_of(edges.begin(), edges.end(),
                       [&](const Vec<3>& place) { return norm(place - middle) < reach; });
  };
  // from each corner of a patch to the next
  constexpr std::array<unsigned, 4> side{PatchNet::low_v, PatchNet::high_u, PatchNet::high_v,
                                         PatchNet::low_u};
  for (std::size_t q = 0; q < outline.quad.size(); ++q) {
    PatchNet& net = shape.patches[q];
    const Vec<3> here = normal_of(outline, outline.quad[q]);
    for (std::size_t k = 0; k < 4; ++k) {
      const int a = net.vertex[PatchNet::corner[k]], b = net.vertex[PatchNet::corner[(k + 1) % 4]];
      const Vec<3> there = normal_of(outline, outline.quad[quad_at.at({b, a})]);
      if (dot(here, there) < std::cos(least_edge) && near_an_edge(a, b)) net.sharp |= side[k];
    }
  }
}

}  // namespace

std::vector<double> masses_with(std::span<const Vec<3>> outline, double volume, const Mat<3>& moments) {
  double squares = 0;
  for (const Vec<3>& X : outline) squares += dot(X, X);
  const double equal = trace(moments) / squares;
  std::array<Row, conditions> gram{};
  Row lack{0, 0, 0, moments(0, 0), moments(1, 1), moments(2, 2), moments(0, 1), moments(1, 2), moments(2, 0)};
  for (const Vec<3>& X : outline) {
    const Row row = row_of(X);
    for (std::size_t i = 0; i < conditions; ++i) {
      lack[i] -= equal * row[i];
      for (std::size_t j = 0; j < conditions; ++j) gram[i][j] += row[i] * row[j];
    }
  }
  const Row c = solved(gram, lack);
  std::vector<double> mass;
  double rest = volume;
  for (const Vec<3>& X : outline) {
    const Row row = row_of(X);
    double w = equal;
    for (std::size_t i = 0; i < conditions; ++i) w += c[i] * row[i];
    mass.push_back(w);
    rest -= w;
  }
  mass.push_back(rest);
  return mass;
}

SolidTopology rigid_surface(const StarSurface& surface, int n) {
  const SolidGrid ball = ball_grid(n);
  SolidGrid outline;
  for (int i = ball.outline_begin; i < ball.nodes(); ++i) {
    const Vec<3> d = ball.node[static_cast<std::size_t>(i)];
    outline.node.push_back(surface.distance((1 / norm(d)) * d) / norm(d) * d);
  }
  outline.node.push_back({});
  outline.quad = ball.quad;
  for (auto& quad : outline.quad)
    for (int& node : quad) node -= ball.outline_begin;
  SolidTopology shape(std::move(outline), surface.volume(), trace(surface.moments()));
  find_edges(places_of_edges(surface.mesh()), shape);
  shape.middles = middles_of(shape.patches);
  const auto nodes = std::span<const Vec<3>>(shape.grid.node);
  shape.node_volume = masses_with(nodes.first(nodes.size() - 1), surface.volume(), surface.moments());
  shape.patch_fullness = surface.volume() / measure_surface(shape.patches, shape.grid.node.data()).volume;
  return shape;
}

}  // namespace softgrain
