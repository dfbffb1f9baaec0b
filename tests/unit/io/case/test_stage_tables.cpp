#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_refusal.hpp"

using namespace softgrain;
using test::mentions;
using test::refusal;

namespace {

const std::string box = "[experiment]\nloading = 'compaction'\nmodel = 'mpm'\n";

}  // namespace

TEST_CASE("stages say what each part does, until what, and how often") {
  const Case read = parse_case(R"(
[[stage]]
name = "press"
yy = { velocity = "1 m/s" }
xx = { stress = "0.2 MPa", speed = "0.5 m/s" }
until = { stress_yy = "1 MPa", strain = 0.4 }
[[stage]]
top = { stress = "1 MPa", stress_amplitude = "0.1 MPa", period = "2 ms", wave = "triangle" }
left = "rest"
until = { time = "3 ms" }
[[stage]]
xx = { strain_amplitude = 0.01, period = "1 ms" }
bottom = { rate = "-20 1/s" }
until = { time = "5 ms", strain_xx = 0.1, stress_bottom = 0, packing_fraction = 0.9, overlap = 0.01, rest = 1e-3 }
repeat = 3
repeat_from = "press"
)",
                               "case.toml");
  CHECK(read.experiment.loading == LoadingPath::stages);
  REQUIRE(read.stages.size() == 3);
  const Stage &press = read.stages[0], &swing = read.stages[1], &last = read.stages[2];
  CHECK(press.name == "press");
  CHECK(press.drives ==
        std::vector<Drive>{{.part = Part::yy, .control = Control::velocity, .value = 1},
                           {.part = Part::xx, .control = Control::stress, .value = 2e5, .speed = 0.5}});
  CHECK(press.until.strain[0] == 0.4);
  CHECK(press.until.stress[static_cast<std::size_t>(Part::yy)] == 1e6);
  CHECK_FALSE(press.until.time);
  CHECK(swing.drives == std::vector<Drive>{{.part = Part::top,
                                            .control = Control::stress,
                                            .value = 1e6,
                                            .amplitude = 1e5,
                                            .period = 2e-3,
                                            .wave = Wave::triangle},
                                           {.part = Part::left}});
  CHECK(last.drives ==
        std::vector<Drive>{{.part = Part::xx, .control = Control::strain, .amplitude = 0.01, .period = 1e-3},
                           {.part = Part::bottom, .control = Control::rate, .value = -20}});
  CHECK(last.until.time == 5e-3);
  CHECK(last.until.strain[1] == 0.1);
  CHECK(last.until.stress[static_cast<std::size_t>(Part::bottom)] == 0);
  CHECK(last.until.packing_fraction == 0.9);
  CHECK(last.until.overlap == 0.01);
  CHECK(last.until.rest == 1e-3);
  CHECK(last.repeat == 3);
  CHECK(last.repeat_from == "press");
}

TEST_CASE("the resolved case keeps its stages, and reads back to itself") {
  const std::string text =
      "[[stage]]\nname = 'pre\"ss'\nyy = { velocity = 0.1 }\nuntil = { stress_top = 12345.678, time = 1e-7 "
      "}\n"
      "[[stage]]\nxx = { stress = 3e5, stress_amplitude = 1e3, period = 1e-3, wave = 'triangle' }\n"
      "yy = { strain_amplitude = 0.1, period = 3 }\nleft = 'rest'\nuntil.time = 2\nrepeat = 4\n";
  const std::string refused = refusal(text);
  CHECK(mentions(refused, "xx and left both move one wall"));
  CHECK(mentions(refused, "1 error; nothing was run"));  // not that the case has no stages, too
  std::string good = text;
  good.replace(good.find("left = 'rest'\n"), 14, "");
  const Case read = parse_case(good, "case.toml"), again = parse_case(resolved_case_text(read), "case.toml");
  CHECK(resolved_case_text(again) == resolved_case_text(read));
  REQUIRE(again.stages.size() == 2);
  CHECK(again.stages[0].name == "pre\"ss");
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(again.stages[k].drives == read.stages[k].drives);
    CHECK(again.stages[k].until == read.stages[k].until);
    CHECK(again.stages[k].repeat == read.stages[k].repeat);
  }
  CHECK(case_json(read).find("\"stress_top\": 12345.678") != std::string::npos);
  CHECK(case_json(Case{}).find("\"stage\"") == std::string::npos);
}

TEST_CASE("a stage sets what may change between stages, in either spelling, and the resolved case keeps it") {
  const std::string stage = "[[stage]]\nyy = { velocity = 1 }\nuntil = { strain = 0.1 }\n";
  const Case read =
      parse_case("[experiment]\nmodel = 'mpm'\n" + stage + stage +
                     "set = { contact.friction = 0.1, 'contact.wall_friction' = 0, mpm = { damping = "
                     "'2 1/ms', tolerance = 1e-5 } }\n" +
                     stage + "set.solver.tolerance = 1e-6\n",
                 "case.toml");
  REQUIRE(read.stages.size() == 3);
  CHECK(read.stages[0].set == Settings{});
  CHECK(read.stages[1].set ==
        Settings{.friction = 0.1, .wall_friction = 0, .newton_tolerance = 1e-5, .damping = 2000});
  CHECK(read.stages[2].set == Settings{.solver_tolerance = 1e-6});
  const Case again = parse_case(resolved_case_text(read), "case.toml");
  for (std::size_t k = 0; k < 3; ++k) CHECK(again.stages[k].set == read.stages[k].set);
  CHECK(case_json(read).find("\"contact.friction\": 0.1") != std::string::npos);
  const CaseReading reading =
      parse_case_with_notes(stage + "set = { mpm.damping = 1, contact.friction = 0.1 }\n", "case.toml");
  CHECK(reading.without_effect == std::vector<std::string>{"mpm.damping"});  // of bpm
}

TEST_CASE("what a stage cannot set is refused by name, with what it can") {
  const auto why = [](const std::string& set, const std::string& place, const std::string& words) {
    const std::string message =
        refusal("[[stage]]\nyy = { velocity = 1 }\nuntil = { strain = 0.1 }\n" + set + "\n");
    CAPTURE(message);
    CHECK(mentions(message, "case.toml:" + place + ": error: "));
    CHECK(mentions(message, words));
  };
  why("set = { grain.density = 3 }", "4:15",
      "'grain.density' may not change between stages; set takes contact.friction");
  why("set = { 'time.step' = 1e-6 }", "4:9", "'time.step' may not change between stages");
  why("set = { contact.frcition = 3 }", "4:17",
      "unknown key 'contact.frcition'; did you mean 'contact.friction'?; set takes");
  why("set = { contact.friction = -1 }", "4:28",
      "stage.set.contact.friction = -1 is out of range: it must be >= 0");
  why("set = { contact.friction = '1 mm' }", "4:28", "stage.set.contact.friction");
  why("set = 3", "4:1", "'stage.set' is a table");
}

TEST_CASE("walls go as fast as the fastest stage says, unless loading.wall_velocity does") {
  const std::string stages =
      "[[stage]]\nyy = { velocity = 1 }\nuntil.strain = 0.1\n[[stage]]\nxx = { velocity = -3 }\nuntil.time = "
      "1\n";
  CHECK(parse_case(stages, "case.toml").loading.wall_velocity == 3);
  CHECK(parse_case(stages, "case.toml", {"loading.wall_velocity=2"}).loading.wall_velocity == 2);
  const std::string kept = "[[stage]]\nyy = { stress = 1e5 }\nuntil.time = 1\n";
  CHECK(parse_case(kept, "case.toml").loading.wall_velocity == Case{}.loading.wall_velocity);
}

TEST_CASE("stages that contradict themselves, or the path of the case, are refused where they stand") {
  const auto why = [](const std::string& text, const std::string& place, const std::string& words) {
    const std::string message = refusal(text);
    CAPTURE(message);
    CHECK(mentions(message, "case.toml:" + place + ": error: "));
    CHECK(mentions(message, words));
  };
  const std::string until = "until = { time = 1 }\n", stage = "[[stage]]\n";
  why(stage + "yy = { velocity = 1, stress = 1e6 }\n" + until, "2:22",
      "stage.yy takes one of velocity, rate, stress");
  why(stage + "yy = { velocity = 1, rate = 1 }\n" + until, "2:22", "got velocity and rate");
  why(stage + "yy = { velocity = 1 }\ntop = { stress = 1e6 }\n" + until, "1:1",
      "yy and top both move one wall");
  why(stage + "yy = { velocity = 1 }\n", "1:1", "it never ends: give until");
  why(stage + "yy = { stress = 1 }\nuntil = { rest = 1e-3 }\n", "1:1", "give until.time too");
  why(stage + "yy = { strain_amplitude = 0.1 }\n" + until, "1:1", "so it needs a period");
  why(stage + "yy = { velocity = 1, period = 1 }\n" + until, "2:22",
      "stage.yy.period needs strain_amplitude");
  why(stage + "yy = { velocity = 1, speed = 1 }\n" + until, "2:22", "stage.yy.speed needs stress");
  why(stage + "yy = { stress = 1, stress_amplitude = 2, period = 1 }\n" + until, "1:1",
      "would pull the grains");
  why(stage + until + "repeat = 1.5\n", "3:1", "stage.repeat takes a whole number");
  why(stage + until + "repeat = 2\nrepeat_from = 'x'\n", "1:1", "no stage before has this name");
  why(stage + until + "repeat_from = 'x'\n", "1:1", "repeat_from needs repeat = 2 or more");
  why(stage + until + "name = 3\n", "3:1", "stage.name takes a text");
  why("[experiment]\nloading = 'compaction'\n" + stage + "yy = { velocity = 1 }\n" + until, "2:1",
      "experiment.loading \"compaction\" and [[stage]] both say what the walls do");
  why("[experiment]\nloading = 'stages'\n", "2:1", "needs tables [[stage]]");
  why("[experiment]\nloading = 'diametral'\n" + stage + "yy = { stress = 1e6 }\n" + until, "3:1",
      "one grain between two walls");
  CHECK(refusal("[experiment]\nloading = 'diametral'\n" + stage + "yy = { velocity = 1 }\n" + until).empty());
}

TEST_CASE("a short form says what it needs, and keys of other paths are without effect") {
  const auto path = [](const std::string& name, const std::string& keys = "") {
    return "[experiment]\nmodel = 'mpm'\nloading = '" + name + "'\n[loading]\n" + keys;
  };
  CHECK(mentions(refusal(path("biaxial")), "needs loading.confining_stress > 0"));
  CHECK(mentions(refusal(path("die")), "needs loading.max_stress > 0"));
  CHECK(mentions(refusal(path("relaxation")), "needs loading.hold > 0"));
  CHECK(refusal(path("biaxial", "confining_stress = 1e5\n")).empty());
  CHECK(refusal(path("die", "max_stress = 1e5\neject = true\n")).empty());
  CHECK(refusal(path("relaxation", "hold = 1e-3\nrest = 1e-4\n")).empty());
  const CaseReading reading = parse_case_with_notes(
      path("die", "max_stress = 1e5\nconfining_stress = 1e5\nunload_at = [0.1]\n"), "case.toml");
  CHECK(reading.without_effect == std::vector<std::string>{"loading.unload_at", "loading.confining_stress"});
  const CaseReading stages = parse_case_with_notes(
      "[loading]\nmax_strain = 0.2\n[[stage]]\nyy = { velocity = 1 }\nuntil.strain = 0.1\n", "case.toml");
  CHECK(stages.without_effect == std::vector<std::string>{"loading.max_strain"});
}

TEST_CASE("a cell takes shear, a box with walls takes single walls, and each says what the other has") {
  const std::string periodic = "[box]\nx = 'periodic'\ny = 'periodic'\n";
  const Case read = parse_case(periodic + R"(
[[stage]]
xy = { rate = "2 1/s" }
yy = { stress = "0.1 MPa" }
until = { strain_xy = 2.5 }
[[stage]]
xy = { stress = "-20 kPa" }
until = { stress_xy = "-10 kPa", time = "1 ms" }
)",
                               "case.toml");
  CHECK(read.box.x == BoxEnd::periodic);
  REQUIRE(read.stages.size() == 2);
  CHECK(read.stages[0].drives.back() == Drive{.part = Part::xy, .control = Control::rate, .value = 2});
  CHECK(read.stages[0].until.strain[2] == 2.5);
  CHECK(read.stages[1].drives.front().value == -2e4);
  CHECK(read.stages[1].until.stress[static_cast<std::size_t>(Part::xy)] == -1e4);
  const Case again = parse_case(resolved_case_text(read), "case.toml");
  CHECK(again.box.y == BoxEnd::periodic);
  CHECK(again.stages[0].drives == read.stages[0].drives);
  CHECK(again.stages[1].until == read.stages[1].until);

  const std::string shear = "[[stage]]\nxy = { rate = 1 }\nuntil = { strain_xy = 1 }\n";
  CHECK(mentions(refusal(shear), "case.toml:1:1: error: [[stage]]: xy shears a cell"));
  CHECK(mentions(refusal("[box]\nx = 'periodic'\n" + shear), "box.x and box.y \"periodic\""));
  CHECK(mentions(refusal(periodic + "[[stage]]\ntop = { rate = 1 }\nuntil = { strain = 1 }\n"),
                 "box.y is \"periodic\", there is no top wall: write yy"));
  CHECK(mentions(refusal(periodic + "[[stage]]\nyy = { rate = 1 }\nuntil = { stress_left = 1 }\n"),
                 "box.x is \"periodic\", there is no left wall: write xx"));
  CHECK(mentions(refusal("[experiment]\nloading = 'compaction'\n[box]\ny = 'periodic'\n"), "turn the box"));
  CHECK(
      mentions(refusal("[experiment]\nloading = 'shear'\n[loading]\nconfining_stress = 1\nshear_rate = 1\n"),
               "it needs box.x and box.y \"periodic\""));
  CHECK(mentions(refusal("[experiment]\nloading = 'die'\n" + periodic + "[loading]\nmax_stress = 1\n"),
                 "\"die\" needs walls"));
  CHECK(mentions(refusal(periodic + "[[stage]]\nxy = { velocity = 1 }\nuntil = { time = 1 }\n"),
                 "unknown key 'stage.xy.velocity'"));
}
