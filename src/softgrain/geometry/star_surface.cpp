#include "softgrain/geometry/star_surface.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace softgrain {
namespace {

using Triangle = std::array<int, 3>;
using Edge = std::pair<int, int>;

constexpr std::array<Edge, 3> sides{Edge{0, 1}, {1, 2}, {2, 0}};

Edge edge_of(const Triangle& triangle, const Edge& side) {
  return {triangle[static_cast<std::size_t>(side.first)], triangle[static_cast<std::size_t>(side.second)]};
}

/// Each edge has two triangles, which run along it in opposite senses.
void check_closed(const TriangleMesh& mesh) {
  std::map<Edge, int> triangle_at;
  const auto place = [&](int v) {
    const Vec<3>& x = mesh.vertex[static_cast<std::size_t>(v)];
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
  };
  const auto fault = [&](std::size_t t, const Edge& edge, const char* what) {
    return MeshFault(static_cast<int>(t),
                     fmt::format("the edge from {} to {} {}", place(edge.first), place(edge.second), what));
  };
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const Edge& side : sides) {
      const Edge edge = edge_of(mesh.triangle[t], side);
      if (!triangle_at.emplace(edge, static_cast<int>(t)).second)
        throw fault(t, edge,
                    "has another triangle of the same sense: all triangles must be seen counter-clockwise "
                    "from outside, and no two lie on each other");
    }
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const Edge& side : sides) {
      const Edge edge = edge_of(mesh.triangle[t], side);
      if (!triangle_at.contains({edge.second, edge.first}))
        throw fault(t, edge,
                    "has one triangle alone: the surface has a hole there; close it, or merge vertices that "
                    "should be one");
    }
}

/// Six times the volume of the tetrahedron with the origin.
double six_volumes(const TriangleMesh& mesh, const Triangle& t) {
  const auto at = [&](std::size_t k) -> const Vec<3>& { return mesh.vertex[static_cast<std::size_t>(t[k])]; };
  return dot(at(0), cross(at(1), at(2)));
}

double volume_of(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangle) volume += six_volumes(mesh, t) / 6;
  return volume;
}

Vec<3> sum_of_corners(const TriangleMesh& mesh, const Triangle& t) {
  Vec<3> sum;
  for (const int v : t) sum += mesh.vertex[static_cast<std::size_t>(v)];
  return sum;
}

/// Solid angle of a triangle seen from the origin (van Oosterom and Strackee 1983).
double solid_angle(const TriangleMesh& mesh, const Triangle& t) {
  const auto at = [&](std::size_t k) -> const Vec<3>& { return mesh.vertex[static_cast<std::size_t>(t[k])]; };
  const double a = norm(at(0)), b = norm(at(1)), c = norm(at(2));
  return 2 * std::atan2(six_volumes(mesh, t),
                        a * b * c + a * dot(at(1), at(2)) + b * dot(at(2), at(0)) + c * dot(at(0), at(1)));
}

/// Every triangle is seen from the origin, and each direction meets one.
void check_star(const TriangleMesh& mesh) {
  double seen = 0;
  for (std::size_t k = 0; k < mesh.triangle.size(); ++k) {
    if (!(six_volumes(mesh, mesh.triangle[k]) > 0))
      throw MeshFault(
          static_cast<int>(k),
          "the triangle is not seen from the centre of mass: the surface folds over itself there; "
          "a grain's surface lies at one distance from the centre in each direction "
          "(star-shaped): take out the fold, or divide the body");
    seen += solid_angle(mesh, mesh.triangle[k]);
  }
  if (const double times = seen / (4 * std::numbers::pi); std::abs(times - 1) > 0.5)
    throw MeshFault(
        0, fmt::format("the surface lies round the centre {:.0f} times: give one of its shells", times));
}

/// About the middle of the vertices first: those of a file may lie far from the origin.
void move(TriangleMesh& mesh, const Vec<3>& way, double scale) {
  for (Vec<3>& x : mesh.vertex) x = scale * (x + way);
}

}  // namespace

StarSurface::StarSurface(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  require(!mesh_.vertex.empty() && mesh_.triangle.size() >= 4,
          "a closed surface has at least 4 triangles, got {}", mesh_.triangle.size());
  check_closed(mesh_);
  for (const Vec<3>& x : mesh_.vertex) centre_ += (1.0 / static_cast<double>(mesh_.vertex.size())) * x;
  move(mesh_, Vec<3>{} - centre_, 1);
  volume_ = volume_of(mesh_);
  if (volume_ < 0) {
    for (Triangle& t : mesh_.triangle) std::swap(t[1], t[2]);
    volume_ = -volume_;
  }
  if (!(volume_ > 0)) throw MeshFault(0, "the surface has no volume");
  Vec<3> of_mass;
  for (const Triangle& t : mesh_.triangle)
    of_mass += six_volumes(mesh_, t) / 24 / volume_ * sum_of_corners(mesh_, t);
  move(mesh_, Vec<3>{} - of_mass, 1);
  centre_ += of_mass;
  for (const Vec<3>& x : mesh_.vertex) reach_ = std::max(reach_, norm(x));
  move(mesh_, {}, 1 / reach_);
  volume_ = volume_of(mesh_);
  check_star(mesh_);
  for (const Triangle& t : mesh_.triangle) {
    const double volume = six_volumes(mesh_, t) / 6;
    const Vec<3> s = sum_of_corners(mesh_, t);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double sum = s[i] * s[j];
        for (const int v : t) {
          const Vec<3>& x = mesh_.vertex[static_cast<std::size_t>(v)];
          sum += x[i] * x[j];
        }
        moments_(i, j) += volume / 20 * sum;
      }
  }
}

/// The ray leaves through the triangle whose three sides it passes within, or, between two of them by
/// round-off, through the one that it misses least.
double StarSurface::distance(const Vec<3>& d) const {
  double best = -1e300, r = 0;
  for (const Triangle& t : mesh_.triangle) {
    const auto at = [&](std::size_t k) -> const Vec<3>& {
      return mesh_.vertex[static_cast<std::size_t>(t[k])];
    };
    const double a = dot(d, cross(at(1), at(2))), b = dot(d, cross(at(2), at(0))),
                 c = dot(d, cross(at(0), at(1))), sum = a + b + c;
    if (!(sum > 0)) continue;
    const double within = std::min({a, b, c}) / sum;
    if (within <= best) continue;
    best = within;
    r = six_volumes(mesh_, t) / sum;  // d r = (a X_0 + b X_1 + c X_2)/(a + b + c) r-scaled: n . X = n . d r
    if (within >= 0) break;
  }
  return r;
}

}  // namespace softgrain
