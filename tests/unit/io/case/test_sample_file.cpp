#include "softgrain/io/case/sample_file.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <string>

using namespace softgrain;

namespace {

/// "line:column: message" of the only issue.
std::string refusal(const std::string& text, const std::vector<std::string>& kinds = {""}) {
  const SampleText sample = read_sample_text(text, kinds);
  REQUIRE(sample.issues.size() == 1);
  const auto& [at, message] = sample.issues.front();
  return std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + message;
}

}  // namespace

TEST_CASE("a table of grains is read in its units, exactly, in any order of columns") {
  const SampleText sample = read_sample_text(
      "\xEF\xBB\xBF# three grains\r\n\r\n  radius [mm] ,kind, x [cm], y, angle [deg]\r\n0.9, a, 0.1, 2e-3, "
      "90\r\n# more\n"
      "1, a, -0.25, +1.5e-3, 0\n0.7,a,0,0,-45",
      {""});
  CHECK(sample.issues.empty());
  REQUIRE(sample.grains.size() == 3);
  CHECK(sample.grains[0].radius == 0.9e-3);
  CHECK(sample.grains[0].centre == Vec<2>{1e-3, 2e-3});
  CHECK(sample.grains[0].angle == doctest::Approx(std::numbers::pi / 2));
  CHECK(sample.grains[1].centre == Vec<2>{-2.5e-3, 1.5e-3});
  CHECK(sample.grains[2].angle == doctest::Approx(-std::numbers::pi / 4));
  CHECK(sample.lines == std::vector{4, 6, 7});
}

TEST_CASE("without units a table is in SI, and angles may be left out") {
  const SampleText sample = read_sample_text("x,y,radius\n0.001,0.002,0.0005\n", {""});
  CHECK(sample.issues.empty());
  REQUIRE(sample.grains.size() == 1);
  CHECK(sample.grains[0] == PlacedGrain{{0.001, 0.002}, 0.0005, 0});
}

TEST_CASE("what is wrong with a table is told with its line, column, value and remedy") {
  CHECK(refusal("x, y, radius [mm]\n1, 2, 3\n1, two, 3\n") ==
        "3:4: y = 'two' is not a number; its unit stands in the first line, as in 'x [mm], y [mm], radius "
        "[mm]'");
  CHECK(refusal("x, y, radius\n1, 2, 3 mm\n").starts_with("2:7: radius = '3 mm' is not a number"));
  CHECK(refusal("x, y, radius\n1, 2, inf\n").starts_with("2:7: radius = 'inf' is not a number"));
  CHECK(refusal("x, y, radius\n1,, 1\n").starts_with("2:3: y = '' is not a number"));
  CHECK(refusal("x, y, radius\n1, 2, -3\n") == "2:7: radius = -3 must be > 0");
  CHECK(refusal("x, y, radius\n1, 2\n").starts_with("2:1: 2 values, but 3 columns"));
  CHECK(refusal("x, y, radius\n1,5, 2, 3\n")
            .starts_with("2:1: 4 values, but 3 columns: numbers have a decimal"));
  CHECK(refusal("x, y, diameter\n1, 2, 3\n").starts_with("1:7: unknown column 'diameter'"));
  CHECK(refusal("x, y, raduis\n").starts_with("1:7: unknown column 'raduis'; did you mean 'radius'?"));
  CHECK(refusal("x, y\n1, 2\n").starts_with("1:1: no column 'radius'"));
  CHECK(refusal("x, y, y, radius\n1, 2\n").starts_with("1:7: column 'y' stands twice"));
  CHECK(refusal("x [s], y, radius\n1, 2\n").starts_with("1:1: column 'x [s]': its unit is none of a length"));
  CHECK(refusal("x [mm, y, radius\n").starts_with("1:1: column 'x [mm'"));
  CHECK(refusal("x, y, radius, angle [mm]\n")
            .starts_with("1:15: column 'angle [mm]': its unit is none of an angle"));
  CHECK(refusal("").starts_with("1:1: no grains"));
  CHECK(refusal("x, y, radius\n").starts_with("2:1: no grains"));
  CHECK(refusal("x, y, radius\n1, 2, \x01\n").starts_with("2:1: not text"));
  CHECK(refusal("x, y, radius, kind\n1, 1, 1, a\n2, 2, 1, b\n")
            .starts_with("3:10: kind = 'b' is the name of no [[kind]]: the case has 'a'"));
  CHECK(refusal("x, y, radius, kind\n1, 1, 1, a\n", {"copper"})
            .starts_with("2:10: kind = 'a' is the name of no [[kind]]: the case has 'copper'"));
  CHECK(refusal("x, y, radius\n1, 1, 1\n", {"copper", "lead"})
            .starts_with("1:1: no column 'kind', but the case has several [[kind]]: 'copper', 'lead'"));
}

TEST_CASE("grains of a table are of the kinds that it names") {
  const SampleText sample = read_sample_text(
      "kind, x, y, radius\nlead, 1, 1, 1\ncopper, 3, 1, 1\nlead, 5, 1, 1\n", {"copper", "lead"});
  REQUIRE(sample.grains.size() == 3);
  CHECK(sample.grains[0].kind == 1);
  CHECK(sample.grains[1].kind == 0);
  CHECK(sample.grains[2].kind == 1);
}

TEST_CASE("a table with an error in every line stops after twenty, and one with too many grains is refused") {
  std::string bad = "x, y, radius\n", large = bad;
  for (int line = 0; line < 1000; ++line) bad += "a, b, c\n";
  CHECK(read_sample_text(bad, {""}).issues.size() == 20);
  for (std::size_t line = 0; line <= most_placed_grains; ++line) large += "1, 1, 1\n";
  CHECK(refusal(large).starts_with("10002:1: not yet: more than 10000 grains"));
}

TEST_CASE("a file of spheres has z and no angle, one of disks has no z") {
  const std::vector<std::string> any{""};
  const SampleText spheres = read_sample_text("z [mm], x [mm], y [mm], radius [mm]\n3, 1, 2, 0.5\n", any, 3);
  CHECK(spheres.issues.empty());
  REQUIRE(spheres.grains.size() == 1);
  CHECK(spheres.grains[0].centre[0] == doctest::Approx(1e-3));
  CHECK(spheres.z == std::vector<double>{3e-3});
  const auto issue = [&](const std::string& text, int dimension) {
    const SampleText read = read_sample_text(text, any, dimension);
    return read.issues.empty() ? "" : read.issues.front().message;
  };
  CHECK(issue("x, y, radius\n1, 1, 1\n", 3).find("no column 'z'") != std::string::npos);
  CHECK(issue("x, y, z, radius\n1, 1, 1, 1\n", 2).find("experiment.dimension = 3") != std::string::npos);
  CHECK(issue("x, y, z, radius, angle\n1, 1, 1, 1, 0\n", 3).find("sample.seed turns") != std::string::npos);
}
