#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_in_folder.hpp"
#include "support/simulations.hpp"

using namespace softgrain;
using test::mentions;
using test::value_of;

namespace {

const std::string three =
    "x [mm], y [mm], radius [mm], angle [deg], kind\n1, 1, 1, 0, copper\n3.1, 1.2, 0.9, 45, copper\n"
    "2, 2.9, 1, 0, copper\n";

/// A case whose sample is this table, in a folder of its own.
struct PlacedCase : test::CaseInFolder {
  explicit PlacedCase(const std::string& table, const std::string& more = "")
      : CaseInFolder(
            "[experiment]\nloading = 'compaction'\nmodel = 'mpm'\n[mpm]\ncells = "
            "4\n[loading]\nmax_strain = 0.1\nwall_velocity = '5 m/s'\n" +
                more + "[sample]\nfile = 'grains.csv'\n",
            "grains.csv", table) {}
};

}  // namespace

TEST_CASE("grains of a file begin in the box that just holds them, and the rest of the sample follows") {
  const Case c = PlacedCase(three).read();
  CHECK(c.box.width == doctest::Approx(4e-3));  // from 0 to 4 mm
  CHECK(c.box.height == doctest::Approx(3.9e-3));
  CHECK(c.sample.grains == 3);
  CHECK(c.sample.smallest_diameter == 1.8e-3);
  CHECK(c.sample.largest_diameter == 2e-3);
  CHECK(c.sample.packing_fraction == doctest::Approx(std::numbers::pi * (1 + 0.81 + 1) / (4 * 3.9)));
  CHECK(c.sample.aspect == doctest::Approx(4 / 3.9));
  CHECK(c.sample.placed[1] == PlacedGrain{{3.1e-3, 1.2e-3}, 0.9e-3, 45 * std::numbers::pi / 180});
  // far away, they are moved as a whole
  const Case far = PlacedCase("x, y, radius\n-7, 100, 1\n-4, 101, 1\n").read();
  CHECK(far.box.width == 5);
  CHECK(far.box.height == 3);
  CHECK(far.sample.placed[0] == PlacedGrain{{1, 1}, 1, 0});
  CHECK(far.sample.placed[1] == PlacedGrain{{4, 2}, 1, 0});
}

TEST_CASE("a box of the case's own stays, and grains stay where the file has them") {
  const Case c = PlacedCase(three, "[box]\nwidth = '6 mm'\n").read({"box.height=5 mm"});
  CHECK(c.box.width == 6e-3);
  CHECK(c.box.height == 5e-3);
  CHECK(c.sample.placed[0].centre == Vec<2>{1e-3, 1e-3});
  CHECK(c.sample.aspect == doctest::Approx(1.2));
}

TEST_CASE("three grains of a file run in both models, with their places, sizes and weights") {
  const PlacedCase source(three);
  for (const char* model : {"mpm", "bpm"}) {
    CAPTURE(model);
    const Case c =
        source.read({std::string("experiment.model=") + model, "bpm.primaries=30", "bpm.library=2"});
    const auto simulation = create_simulation(c);
    const auto start = test::next_row(*simulation);
    CHECK(value_of(start, "wall_height") == doctest::Approx(3.9e-3));
    CHECK(value_of(start, "width") == doctest::Approx(4e-3));
    CHECK(value_of(start, "phi_0") == doctest::Approx(std::numbers::pi * 2.81 / (4 * 3.9)));
    while (!simulation->finished()) simulation->step();
    CHECK(simulation->strain() == doctest::Approx(0.1).epsilon(1e-6));
    CHECK(value_of(test::next_row(*simulation), "stress_top") > 0);
  }
}

TEST_CASE("what a run keeps of a file needs the file no more") {
  const Case c = PlacedCase(three).read();  // whose folder is gone now
  const std::string text = resolved_case_text(c);
  const CaseReading again = parse_case_with_notes(text, "case.toml");
  CHECK(resolved_case_text(again.the_case) == text);
  CHECK(again.the_case.sample.placed == c.sample.placed);
  CHECK(again.without_effect.empty());
}

TEST_CASE("a file's own mistakes come with the case's, each with its file, line, column and remedy") {
  const PlacedCase bad("x [mm], y [mm], radius [mm]\n1, 1, 1\n1, 3, -1\n5, ?, 1\n", "[grain]\ndensty = 1\n");
  const std::string message = bad.refusal();
  CAPTURE(message);
  CHECK(mentions(message, "case.toml:10:1: error: unknown key 'grain.densty'"));
  CHECK(mentions(message,
                 "grains.csv:3:7: error: radius = -1 must be > 0\n    3 | 1, 3, -1\n      |       ^\n"));
  CHECK(mentions(message, "grains.csv:4:4: error: y = '?' is not a number"));
  CHECK(mentions(message, "3 errors; nothing was run"));
}

TEST_CASE("grains that overlap or lie outside the box are refused by line, with how much is allowed") {
  const std::string header = "x [mm], y [mm], radius [mm]\n";
  CHECK(PlacedCase(header + "1, 1, 1\n2.991, 1, 1\n").refusal().empty());  // 0.9 % of R
  const std::string overlap = PlacedCase(header + "1, 1, 1\n\n2.98, 1, 1\n").refusal();
  CAPTURE(overlap);
  CHECK(mentions(overlap,
                 "grains.csv:4:1: error: the grain overlaps that of line 2 by 0.02 of its radius; at most "
                 "0.01 of the smaller radius are allowed: move one"));
  const std::string box = "[box]\nwidth = '4 mm'\nheight = '2 mm'\n";
  CHECK(PlacedCase(header + "1, 1, 1\n3.005, 1, 1\n", box).refusal().empty());
  const std::string outside = PlacedCase(header + "1, 1, 1\n3.5, 1, 1\n", box).refusal();
  CAPTURE(outside);
  CHECK(mentions(outside, "grains.csv:3:1: error: the grain reaches 0.5 of its radius out of the box"));
  CHECK(mentions(outside, "box.width 0.004 m"));
}

TEST_CASE("a file that is not there, or no file, is refused where it is named") {
  const PlacedCase source(three);
  CHECK(mentions(source.refusal({"sample.file=" + (source.directory.path() / "none.csv").string()}),
                 "error: sample.file: "));
  CHECK(mentions(source.refusal({"sample.file=" + source.directory.path().string()}), "is not a file"));
  CHECK(mentions(source.refusal({"sample.placed=[[0, 0, 1, 0]]"}), "both place the grains"));
  CHECK(mentions(source.refusal({"kind.name=iron"}),
                 "grains.csv:2:13: error: kind = 'copper' is the name of no [[kind]]: the case has 'iron'"));
  CHECK(mentions(PlacedCase("x, y, radius\n0, 0, 1\n", "[sample]\nplaced = [[0, 0, -1, 0]]\n").refusal(),
                 "error"));
  try {
    parse_case("sample.placed = [[0, 0, -1, 0]]", "case.toml");
    CHECK(false);
  } catch (const CaseFileError& error) {
    CHECK(mentions(error.what(), "sample.placed takes four numbers for each grain"));
  }
}

TEST_CASE(
    "keys of random grains are noted as without effect beside a file, and the box beside random grains") {
  const PlacedCase source(three);
  const auto without = [&](const std::vector<std::string>& sets) {
    return read_case_with_notes(source.path, sets).without_effect;
  };
  CHECK(without({}).empty());
  CHECK(without({"sample.grains=7", "sample.seed=3"}) ==
        std::vector<std::string>{"sample.seed", "sample.grains"});
  CHECK(
      parse_case_with_notes("experiment.loading = 'compaction'\nbox.width = 1", "case.toml").without_effect ==
      std::vector<std::string>{"box.width"});
}

TEST_CASE("grains of a file that overlap by what is allowed store no energy to speak of in elastic grains") {
  const Case c =
      PlacedCase("x [mm], y [mm], radius [mm]\n1, 1, 1\n2.991, 1, 1\n").read({"loading.max_strain=0.01"});
  const auto simulation = create_simulation(c);
  simulation->step();
  const auto row = test::next_row(*simulation);
  const double unit = c.mpm.material.young_modulus * 1e-6;  // E R^2
  MESSAGE("elastic ", value_of(row, "elastic_energy") / unit, " kinetic ",
          value_of(row, "kinetic_energy") / unit);
  CHECK(value_of(row, "elastic_energy") < 1e-3 * unit);
}
