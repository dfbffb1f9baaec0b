#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// Triangles of a surface, in any unit of length: corners by number, all seen in one sense from outside.
struct TriangleMesh {
  std::vector<Vec<3>> vertex;
  std::vector<std::array<int, 3>> triangle;

  friend bool operator==(const TriangleMesh& a, const TriangleMesh& b) {
    const auto same = [](const Vec<3>& x, const Vec<3>& y) { return x.c == y.c; };
    return a.triangle == b.triangle && a.vertex.size() == b.vertex.size() &&
           std::equal(a.vertex.begin(), a.vertex.end(), b.vertex.begin(), same);
  }
};

/// What keeps a mesh from being the surface of a grain, and at which triangle.
struct MeshFault : UsageError {
  MeshFault(int at, const std::string& message) : UsageError(message), triangle(at) {}
  int triangle;
};

/// A closed surface each point of which is seen from its centre of mass: it lies at one distance r(d) in each
/// direction d. Lengths in units of the distance of the farthest vertex.
///
/// With the tetrahedra of the triangles and the centre, V = sum V_t, integral X (x) X = sum V_t/20 (sum_a
/// X_a (x) X_a + s (x) s), s the sum of the corners.
class StarSurface {
 public:
  /// Triangles that are all seen from inside are turned about. Raises MeshFault where the surface has a hole,
  /// an edge of more than two triangles or neighbours of different sense, and where a triangle is not seen
  /// from the centre.
  explicit StarSurface(TriangleMesh mesh);

  double volume() const { return volume_; }           ///< [reach^3]
  const Mat<3>& moments() const { return moments_; }  ///< integral of X (x) X over the body [reach^5]
  const TriangleMesh& mesh() const { return mesh_; }  ///< about the centre of mass
  const Vec<3>& centre() const { return centre_; }    ///< of the mesh given, in its unit
  double reach() const { return reach_; }             ///< of it, in that unit
  double distance(const Vec<3>& direction) const;     ///< r(d) of a unit vector, by all triangles

 private:
  TriangleMesh mesh_;
  double volume_ = 0, reach_ = 0;
  Vec<3> centre_;
  Mat<3> moments_;
};

}  // namespace softgrain
