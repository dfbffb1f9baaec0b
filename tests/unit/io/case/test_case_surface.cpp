#include <doctest/doctest.h>

#include <numbers>
#include <string>

#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/shape_of_case.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_in_folder.hpp"
#include "support/meshes.hpp"
#include "support/solid_simulations.hpp"

using namespace softgrain;
using test::mentions;

namespace {

const std::string stones = R"(
[experiment]
loading = "compaction"
dimension = 3
[mpm]
cells = 2
[sample]
packing_fraction = 0.3
[[kind]]
name = "ball"
model = "mpm"
number = 2
diameter = "2 mm"
[[kind]]
name = "stone"
model = "rigid"
surface = "stone.stl"
number = 3
diameter = "1.5 mm"
)";

test::CaseInFolder with_stone(const std::string& mesh) { return {stones, "stone.stl", mesh}; }

}  // namespace

TEST_CASE(
    "a kind of rigid grains takes its surface from a file, and the resolved case needs the file no more") {
  const Case c = with_stone(test::text_stl(test::cube_mesh(3))).read();
  REQUIRE(c.kinds.size() == 2);
  CHECK(c.kinds[0].grain.shape == ShapeOfGrain::disk);
  CHECK(c.kinds[1].grain.shape == ShapeOfGrain::surface);
  CHECK(c.kinds[1].grain.surface.triangle.size() == 12);
  const double share = 8 / std::pow(3, 1.5) / (4 * std::numbers::pi / 3);  // of a cube in its sphere
  CHECK(std::abs(area_share(case_of_kind(c, 1)) / share - 1) < 1e-12);
  const std::string resolved = resolved_case_text(c);
  const Case again = parse_case(resolved, "case.toml");
  CHECK(again.kinds[1].grain.surface == c.kinds[1].grain.surface);
  CHECK(resolved_case_text(again) == resolved);
  const SimulationOf<3> simulation = test::solid_simulation_of(c);
  const std::vector<double> radius = simulation.model().radii();
  CHECK(std::abs(radius[4] / (0.75e-3 * std::cbrt(share)) - 1) < 1e-12);
}

TEST_CASE("a surface that cannot be is refused with file, place and remedy") {
  TriangleMesh hole = test::cube_mesh(1);
  hole.triangle.erase(hole.triangle.begin() + 3);
  const std::string refused = with_stone(test::text_stl(hole)).refusal();
  CHECK(mentions(refused, "stone.stl: line "));
  CHECK(mentions(refused, "the surface has a hole there; close it"));
  CHECK(mentions(with_stone("nothing").refusal(), "stone.stl: line 1: neither STL"));
  CHECK(mentions(with_stone("").refusal({"kind.stone.surface=missing.stl"}), "missing.stl"));
  const test::CaseInFolder cube = with_stone(test::text_stl(test::cube_mesh(3)));
  CHECK(mentions(cube.refusal({"kind.stone.model=mpm"}),
                 "not yet with experiment.dimension = 3: elastic grains"));
  CHECK(mentions(cube.refusal({"experiment.dimension=2"}), "belong to experiment.dimension = 3"));
  CHECK(mentions(cube.refusal({"kind.ball.shape=ellipse"}), "ellipses, polygons and outlines"));
  CHECK(mentions(cube.refusal({"kind.ball.shape=surface"}), "needs grain.surface"));
}

TEST_CASE("a run of rigid grains alone goes on from a checkpoint with the same bits") {
  const test::CaseInFolder folder = with_stone(test::text_stl(test::cube_mesh(3)));
  const Case c =
      folder.read({"kind.ball.model=rigid", "loading.wall_velocity=0.5 m/s", "contact.friction=0.3"});
  SimulationOf<3> whole = test::solid_simulation_of(c), second = test::solid_simulation_of(c);
  for (int k = 0; k < 6; ++k) whole.step();
  second.restore(whole.checkpoint());
  for (int k = 0; k < 6; ++k) whole.step(), second.step();
  for (const auto& [name, array] : whole.checkpoint().arrays) {
    CAPTURE(name);
    CHECK(array.values == second.checkpoint().arrays.at(name).values);
  }
}
