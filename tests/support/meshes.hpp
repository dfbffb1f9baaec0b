#pragma once
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "softgrain/geometry/star_surface.hpp"

namespace softgrain::test {

/// A cube with its sides along the axes, of half side a about a place.
inline TriangleMesh cube_mesh(double a, const Vec<3>& place = {}) {
  TriangleMesh mesh;
  for (const double z : {-a, a})
    for (const double y : {-a, a})
      for (const double x : {-a, a}) mesh.vertex.push_back(place + Vec<3>{x, y, z});
  mesh.triangle = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Of an octahedron whose triangles are divided `times` times, on the ellipsoid with these half axes.
inline TriangleMesh ellipsoid_mesh(const Vec<3>& axes, int times) {
  TriangleMesh mesh{
      .vertex = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      .triangle = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (; times > 0; --times) {
    std::map<std::pair<int, int>, int> middle;
    const auto between = [&](int a, int b) {
      const auto [at, is_new] = middle.emplace(std::minmax(a, b), static_cast<int>(mesh.vertex.size()));
      if (is_new) {
        const Vec<3> x = mesh.vertex[static_cast<std::size_t>(a)] + mesh.vertex[static_cast<std::size_t>(b)];
        mesh.vertex.push_back((1 / norm(x)) * x);
      }
      return at->second;
    };
    const auto before = std::exchange(mesh.triangle, {});
    for (const auto& [a, b, c] : before) {
      const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
      mesh.triangle.insert(mesh.triangle.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
  }
  for (Vec<3>& x : mesh.vertex)
    for (int k = 0; k < 3; ++k) x[k] *= axes[k];
  return mesh;
}

/// The mesh as an STL file in text.
inline std::string text_stl(const TriangleMesh& mesh) {
  std::string text = "solid cube\n";
  for (const auto& t : mesh.triangle) {
    text += "facet normal 0 0 0\n  outer loop\n";
    for (const int v : t) {
      const Vec<3>& x = mesh.vertex[static_cast<std::size_t>(v)];
      text += fmt::format("    vertex {} {} {}\n", x[0], x[1], x[2]);
    }
    text += "  endloop\nendfacet\n";
  }
  return text + "endsolid cube\n";
}

}  // namespace softgrain::test
