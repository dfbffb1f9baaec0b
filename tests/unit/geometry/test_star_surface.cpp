#include "softgrain/geometry/star_surface.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/meshes.hpp"

using namespace softgrain;

namespace {

/// What is said of a mesh, and of which triangle; empty if nothing.
std::pair<std::string, int> fault_of(const TriangleMesh& mesh) {
  try {
    StarSurface{mesh};
    return {"", -1};
  } catch (const MeshFault& fault) {
    return {fault.what(), fault.triangle};
  }
}

bool says(const TriangleMesh& mesh, const std::string& words) {
  return fault_of(mesh).first.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("a cube far from the origin has its volume, centre and moments, and its faces in each direction") {
  const double a = 2e-3;
  TriangleMesh mesh = test::cube_mesh(a, {0.3, -0.2, 0.7});
  for (const bool inside_out : {false, true}) {
    if (inside_out)
      for (auto& t : mesh.triangle) std::swap(t[0], t[1]);
    const StarSurface cube(mesh);
    CHECK(norm(cube.centre() - Vec<3>{0.3, -0.2, 0.7}) < 1e-12);
    CHECK(std::abs(cube.reach() / (std::sqrt(3) * a) - 1) < 1e-12);
    const double half = 1 / std::sqrt(3), volume = 8 * half * half * half;
    CHECK(std::abs(cube.volume() / volume - 1) < 1e-12);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        CHECK(std::abs(cube.moments()(i, j) - (i == j ? volume * half * half / 3 : 0)) < 1e-13);
    CHECK(std::abs(cube.distance({0, -1, 0}) - half) < 1e-12);
    CHECK(std::abs(cube.distance((1 / std::sqrt(3)) * Vec<3>{1, -1, 1}) - 1) < 1e-12);
    CHECK(std::abs(cube.distance((1 / std::sqrt(1.25)) * Vec<3>{1, 0.5, 0}) - half * std::sqrt(1.25)) <
          1e-12);
  }
}

TEST_CASE("an ellipsoid of many triangles has the moments of the closed form, and its error falls fourfold") {
  const Vec<3> axes{1, 0.8, 0.5};
  double last = 1;
  for (const int times : {3, 4}) {
    const StarSurface surface(test::ellipsoid_mesh(axes, times));
    const double volume = 4 * std::numbers::pi / 3 * axes[0] * axes[1] * axes[2];
    const double error = 1 - surface.volume() / volume;
    CHECK(error > 0);  // the vertices lie on it
    CHECK(error < (times == 3 ? 0.03 : 0.008));
    if (times == 4) CHECK(std::abs(last / error - 4) < 0.1);
    last = error;
    for (int i = 0; i < 3; ++i)
      CHECK(std::abs(surface.moments()(i, i) / (volume * axes[i] * axes[i] / 5) - 1) < 2 * error);
  }
}

TEST_CASE("a surface with a hole, a turned triangle, a fold or two shells is refused at its triangle") {
  TriangleMesh hole = test::cube_mesh(1);
  hole.triangle.pop_back();
  CHECK(says(hole, "has one triangle alone: the surface has a hole there"));
  TriangleMesh turned = test::cube_mesh(1);
  std::swap(turned.triangle[7][0], turned.triangle[7][1]);
  CHECK(says(turned, "has another triangle of the same sense"));
  TriangleMesh folded = test::ellipsoid_mesh({1, 1, 1}, 2);
  folded.vertex[4] = {0.9, 0, 0.2};  // the top is drawn down to the side
  CHECK(says(folded, "the triangle is not seen from the centre of mass: the surface folds"));
  CHECK(fault_of(folded).second >= 0);
  TriangleMesh shells = test::cube_mesh(1);
  const TriangleMesh inner = test::cube_mesh(0.5);
  for (auto t : inner.triangle) {
    for (int& v : t) v += 8;
    shells.triangle.push_back(t);
  }
  shells.vertex.insert(shells.vertex.end(), inner.vertex.begin(), inner.vertex.end());
  CHECK(says(shells, "lies round the centre 2 times"));
  CHECK_THROWS_AS(StarSurface{TriangleMesh{}}, UsageError);
}
