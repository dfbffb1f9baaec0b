#include "softgrain/io/case/outline_file.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/shape_of_case.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_in_folder.hpp"
#include "support/simulations.hpp"

using namespace softgrain;
using test::mentions;

namespace {

std::string refusal_of(const std::string& text) {
  const OutlineText outline = read_outline_text(text);
  REQUIRE(outline.issues.size() == 1);
  const auto& [at, message] = outline.issues.front();
  return std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + message;
}

/// A case with the file house.csv beside it.
struct HouseCase : test::CaseInFolder {
  explicit HouseCase(const std::string& more,
                     const std::string& house = "x, y\n0, 0\n2, 0\n2, 1\n1, 2\n0, 1\n0, 0\n")
      : CaseInFolder("[mpm]\ncells = 4\n" + more, "house.csv", house) {}
};
const std::string alone =
    "[experiment]\nmodel = 'mpm'\n[grain]\noutline = 'house.csv'\n[loading]\nmax_strain = 0.1\nwall_velocity "
    "= '1 m/s'\n";
const std::string among =
    "[experiment]\nloading = 'compaction'\nmodel = 'mpm'\n[loading]\nmax_strain = 0.1\nwall_velocity = '1 "
    "m/s'\n"
    "[[kind]]\nname = 'house'\nnumber = 3\noutline = 'house.csv'\n"
    "[[kind]]\nname = 'stone'\nnumber = 3\nmodel = 'rigid'\nshape = 'polygon'\nsides = 3\n";

}  // namespace

TEST_CASE("points of an outline stand in a file, corners in a column or where the outline turns sharply") {
  const OutlineText house =
      read_outline_text("\xEF\xBB\xBF# a house\r\n y [mm], x [mm]\r\n0, 0\n0,2\n1, 2\n2,1\n1,0\n");
  CHECK(house.issues.empty());
  REQUIRE(house.points.size() == 5);
  CHECK(house.points[1].x == Vec<2>{2, 0});
  for (const OutlinePoint& point : house.points) CHECK(point.corner);
  CHECK(house.lines == std::vector{3, 4, 5, 6, 7});
  const OutlineText soft = read_outline_text("x, corner, y\n0,1, 0\n2,0,0\n2,0, 1\n1,1,2\n0,0,1\n0,1,0\n");
  REQUIRE(soft.points.size() == 5);  // the first point again
  CHECK((soft.points[0].corner && !soft.points[1].corner && soft.points[3].corner));
}

TEST_CASE("what is wrong with an outline is told with its line, column, value and remedy") {
  CHECK(refusal_of("x, y\n0, 0\n1, one\n1, 1\n") == "3:4: y = 'one' is not a number");
  CHECK(refusal_of("x, z\n").starts_with("1:4: unknown column 'z'"));
  CHECK(refusal_of("x, corner\n").starts_with("1:1: no column 'y': the first line names the columns"));
  CHECK(refusal_of("x, y, y\n").starts_with("1:7: column 'y' stands twice"));
  CHECK(refusal_of("x, y\n0, 0, 1\n").starts_with("2:1: 3 values, but 2 columns"));
  CHECK(refusal_of("x, y, corner\n0, 0, 2\n").starts_with("2:7: corner = 2 must be 1, or 0"));
  CHECK(mentions(refusal_of("x, y\n0, 0\n1, 1\n"), "an outline needs at least 3 points, got 2"));
  CHECK(mentions(refusal_of(""), "an outline needs at least 3 points, got 0"));
  CHECK(refusal_of("x, y\n0,0\n1,1\n1,0\n0,1\n")
            .starts_with("4:1: the edge from here to the next point crosses or touches that from line 2"));
}

TEST_CASE("a grain between walls takes the outline of a file, and its case keeps the points") {
  const HouseCase house(alone);
  const Case c = house.read();
  CHECK(c.grain.shape == ShapeOfGrain::outline);
  CHECK(c.grain.outline.size() == 5);
  const std::string resolved = resolved_case_text(c);
  CHECK(mentions(resolved, "shape = \"outline\""));
  const Case again = parse_case(resolved, "again.toml", {});
  CHECK(again.grain.outline == c.grain.outline);
  CHECK(resolved_case_text(again) == resolved);
  CHECK(house.read({"grain.shape=disk"}).grain.shape == ShapeOfGrain::disk);
  // the centre of area is 7/9 above the ground: the walls touch ground and gable
  const auto [low, high] = between_walls(c);
  const double unit = c.grain.radius / std::hypot(1, 7.0 / 9);
  CHECK(std::abs(low / (-7.0 / 9 * unit) - 1) < 1e-12);
  CHECK(std::abs(high / ((2 - 7.0 / 9) * std::min(unit, c.grain.radius / (2 - 7.0 / 9))) - 1) < 0.03);
}

TEST_CASE("kinds have shapes, of files too, and what they fill is their true area") {
  const HouseCase house(among);
  const Case c = house.read();
  CHECK(case_of_kind(c, 0).grain.shape == ShapeOfGrain::outline);
  const std::string resolved = resolved_case_text(c);
  CHECK(resolved_case_text(parse_case(resolved, "again.toml", {})) == resolved);
  const Simulation simulation = test::simulation_of(c);
  const double phi = test::value_of(row_of(simulation.observe()), "phi_0");
  CHECK(std::abs(phi / first_packing_fraction(c) - 1) < 0.05);  // in the mean over sizes
  CHECK(std::abs(area_share(case_of_kind(c, 0)) * std::acos(-1.0) * (2 - 7.0 / 9) * (2 - 7.0 / 9) / 3 - 1) <
        0.1);
  CHECK(mentions(house.refusal({"kind.house.outline=nothing.csv"}), "nothing.csv: cannot open"));
}

TEST_CASE("shapes that cannot be are refused with place and remedy") {
  const HouseCase crossing(alone, "x, y\n0,0\n1,1\n1,0\n0,1\n");
  CHECK(mentions(crossing.refusal(), "house.csv:4:1: error: the edge from here"));
  const std::string ell = "x, y\n0, 0\n1, 0\n1, 0.2\n0.2, 0.2\n0.2, 1\n0, 1\n";
  CHECK(mentions(HouseCase(alone, ell).refusal(),
                 "house.csv:5:1: error: at the point (0.2, 0.2) the outline is so concave"));
  CHECK(mentions(HouseCase(among, ell).refusal(),
                 "house.csv:5:1: error: at the point (0.2, 0.2) the outline is so concave"));
  CHECK(HouseCase(among, ell).refusal({"kind.house.model=rigid", "experiment.model=rigid"}).empty());
  const HouseCase house(alone);
  CHECK(mentions(house.refusal({"grain.shape=polygon", "grain.sides=40"}),
                 "a grain of 40 corners needs mpm.cells >= 10, got 4"));
  CHECK(mentions(house.refusal({"grain.shape=ellipse", "grain.aspect=12"}),
                 "grain.aspect of elastic ellipses must be at most 10"));
  CHECK(mentions(house.refusal({"mpm.formulation=updated_lagrangian"}),
                 "takes disks, not grain.shape \"outline\""));
  CHECK(mentions(house.refusal({"experiment.model=bpm"}), "not yet: bonded grains of shape \"outline\""));
  CHECK(mentions(house.refusal({"grain.outline=[[0,0],[1,0],[2]]"}), "takes two numbers for each point"));
}
