#include "softgrain/io/page/report_surfaces.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "softgrain/io/page/report_arrays.hpp"
#include "softgrain/math/tensor.hpp"

using namespace softgrain;

namespace {

constexpr std::array<std::array<int, 4>, 6> faces{
    {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
constexpr std::array<std::array<double, 3>, 8> corners{
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

/// Two cubes of edge 2 about the origin and about (3, 0, 0), each moved and deformed by x = c + A X.
Scene two_cubes(const std::array<Vec<3>, 2>& c, const std::array<Mat<3>, 2>& A) {
  std::vector<Vec<3>> x;
  std::vector<std::int64_t> grain, quad;
  for (std::size_t g = 0; g < 2; ++g) {
    for (const auto& X : corners) {
      x.push_back(c[g] + A[g] * Vec<3>{X[0], X[1], X[2]});
      grain.push_back(static_cast<std::int64_t>(g));
    }
    for (const auto& face : faces)
      for (const int v : face) quad.push_back(static_cast<std::int64_t>(8 * g) + v);
  }
  Scene scene;
  scene.outlines["position"] = to_array(x);
  scene.outlines["grain"] = {1, grain};
  scene.surface["quad"] = {4, quad};
  scene.surface["walls"] = {12, std::vector<double>{-1, -1, -1, 4, -1, -1, 4, 1, -1, -1, 1, -1}};
  scene.contacts["pair"] = {2, std::vector<std::int64_t>{0, 1, 0, 2, 0, 3}};  // there is no second wall
  scene.contacts["force"] = {1, std::vector<double>{5, 7, 9}};
  return scene;
}

const Mat<3> sheared{{1.1, 0.2, -0.1, 0.0, 0.9, 0.3, 0.1, 0.0, 0.8}};
const std::array<Vec<3>, 2> apart{Vec<3>{0, 0, 0}, Vec<3>{3, 0, 0}};

}  // namespace

TEST_CASE("what a grain moves and deforms as a whole is taken from its vertices, and the rest is nothing") {
  const std::array<Vec<3>, 2> moved{Vec<3>{0.5, -1, 2}, Vec<3>{3, 0.25, 0}};
  std::vector<ReportFrame> frames{frame_of_surfaces(two_cubes(apart, {identity<3>(), identity<3>()})),
                                  frame_of_surfaces(two_cubes(moved, {sheared, identity<3>()}))};
  CHECK(std::abs(frames[1].columns["grain.volume"][0] / (8 * determinant(sheared)) - 1) < 1e-6);
  part_off_motion(frames);
  const auto& columns = frames[1].columns;
  for (const char* axis : {"vertex.x", "vertex.y", "vertex.z"})
    for (const float left : columns.at(axis)) CHECK(std::abs(left) < 1e-6);
  CHECK(columns.at("grain.x") == FrameColumn{0.5F, 3});
  CHECK(columns.at("rest.z") == frames[0].columns.at("rest.z"));
  CHECK(std::abs(columns.at("grain.a12")[0] - 0.3) < 1e-6);
  CHECK(std::abs(columns.at("grain.a20")[0] - 0.1) < 1e-6);
  CHECK(std::abs(columns.at("grain.a22")[1] - 1) < 1e-6);
}

TEST_CASE("a vertex that moves by itself is found again from motion and rest") {
  Scene scene = two_cubes(apart, {sheared, identity<3>()});
  auto& x = std::get<std::vector<double>>(scene.outlines["position"].values);
  x[3 * 6] += 0.4;
  std::vector<ReportFrame> frames{frame_of_surfaces(two_cubes(apart, {identity<3>(), identity<3>()})),
                                  frame_of_surfaces(scene)};
  part_off_motion(frames);
  const auto& columns = frames[1].columns;
  for (std::size_t v = 0; v < 16; ++v) {
    const std::size_t g = v / 8;
    const auto at = [&](const std::string& name, std::size_t i) { return double{columns.at(name)[i]}; };
    const double found = at("grain.x", g) + at("grain.a00", g) * at("rest.x", v) +
                         at("grain.a01", g) * at("rest.y", v) + at("grain.a02", g) * at("rest.z", v) +
                         at("vertex.x", v);
    CHECK(std::abs(found - x[3 * v]) < 1e-6);
  }
  CHECK(columns.at("vertex.x")[6] < 0.4);  // the motion as a whole has taken its share
}

TEST_CASE("fields of surfaces: means round a vertex and over a grain, and of a stress the largest shear") {
  Scene scene = two_cubes(apart, {identity<3>(), identity<3>()});
  std::vector<double> pressure(12, 1), stress(9 * 12, 0);
  pressure[0] = 7;                                          // below the first cube
  for (std::size_t q = 0; q < 12; ++q) stress[9 * q] = -6;  // uniaxial: s_1 - s_3 = 6
  scene.surface["pressure"] = {1, pressure};
  scene.surface["stress"] = {9, stress};
  const ReportFrame frame = frame_of_surfaces(scene);
  CHECK(frame.columns.at("vertex.pressure")[0] == 3);  // one of three faces
  CHECK(frame.columns.at("vertex.pressure")[4] == 1);
  CHECK(frame.columns.at("grain.pressure") == FrameColumn{2, 1});  // one of six
  for (const float shear : frame.columns.at("vertex.stress")) CHECK(std::abs(shear - 3) < 1e-6);
  REQUIRE(fields_of(frame).size() == 2);
  CHECK(fields_of(frame)[1].label == "largest shear stress");
  CHECK(frame.columns.at("contact.force") == FrameColumn{5, 7});
  CHECK(frame.columns.at("wall.3") == FrameColumn{4});
}

TEST_CASE("a chain across the end of a cell in space is left out") {
  Scene scene = two_cubes(apart, {identity<3>(), identity<3>()});
  scene.cell = {5, 0, 0, 0, 0, 0, 0, 0, 0};  // 3 is nearer the other way round
  CHECK(frame_of_surfaces(scene).columns.at("contact.force") == FrameColumn{7});
}

TEST_CASE("many vertices are told apart to a 400th of a grain, which one byte holds") {
  std::vector<ReportFrame> frames;
  for (int k = 0; k < 20000; ++k) {  // beyond what costs little
    const double a = 0.1 * std::sin(0.001 * k);
    Scene scene = two_cubes(apart, {identity<3>(), identity<3>()});
    std::get<std::vector<double>>(scene.outlines["position"].values)[3 * 6] += a;
    frames.push_back(frame_of_surfaces(scene));
  }
  part_off_motion(frames);
  for (const EncodedColumn& column : encode_columns(frames)) {
    if (column.name != "vertex.x") continue;
    CHECK(column.frames == 20000);
    CHECK(column.array.bytes == 1);
    const double diameter = std::cbrt(6 / 3.14159265 * 8);
    CHECK(std::abs(column.array.step / (diameter / 400) - 1) < 0.01);
  }
}
