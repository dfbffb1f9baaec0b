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

/// The resolved case, all that a case says.
std::string resolved(const std::string& text, const std::vector<std::string>& sets = {}) {
  return resolved_case_text(parse_case(text, "case.toml", sets));
}

const std::string box = "[experiment]\nloading = 'compaction'\nmodel = 'mpm'\n";

}  // namespace

TEST_CASE("a kind and its pairs say what the short form says") {
  const std::string in_short = R"(
[experiment]
loading = "compaction"
model = "mpm"
[grain]
density = "8960 kg/m^3"
[mpm]
law = "hencky"
young_modulus = "120 MPa"
poisson_ratio = 0.34
cells = 8
[contact]
friction = 0.1
wall_friction = 0.2
[sample]
grains = 210
smallest_diameter = "1 mm"
largest_diameter = "2 mm"
[loading]
max_strain = 0.3
)";
  const std::string in_long = R"(
[experiment]
dimension = 2
loading = "compaction"
[[pair]]
between = ["copper", "copper"]
friction = 0.1
[[pair]]
between = ["wall", "copper"]
friction = 0.2
surface_energy = 0
[[kind]]
name = "copper"
model = "mpm"
share = 1
number = 210
shape = "disk"
density = "8960 kg/m^3"
diameter = { smallest = "1 mm", largest = "2 mm", distribution = "uniform" }
law = { name = "hencky", young_modulus = "120 MPa", poisson_ratio = 0.34 }
cells = 8
[box]
x = "walls"
y = "walls"
[loading]
max_strain = 0.3
)";
  CHECK(resolved(in_long) == resolved(in_short));
  CHECK(resolved(in_long, {"loading.max_strain=0.4", "kind.density=1000"}) ==
        resolved(in_short, {"loading.max_strain=0.4", "grain.density=1000"}));
}

TEST_CASE("laws of diameters are implied by what is given, and shares are of area") {
  const auto sample = [](const std::string& diameter) {
    return parse_case(box + "[[kind]]\ndiameter = { " + diameter + " }\n", "case.toml").sample;
  };
  const Case::Sample list = sample("values = ['1 mm', '2 mm'], shares = [0.5, 0.5]");
  CHECK(list.sizes == SizeLaw::list);
  CHECK(list.diameters == std::vector{1e-3, 2e-3});
  CHECK(list.smallest_diameter == 1e-3);
  CHECK(list.largest_diameter == 2e-3);
  CHECK(sample("median = '2 mm', deviation = 0.2").sizes == SizeLaw::lognormal);
  CHECK(sample("smallest = '2 mm'").sizes == SizeLaw::uniform);
  CHECK(mentions(refusal(box + "[[kind]]\ndiameter = { median = '9 mm' }\n"),
                 "case.toml:5:14: error: sample.smallest_diameter and sample.largest_diameter must enclose"));
  CHECK(mentions(refusal(box + "[sample]\nsizes = 'list'\n"), "needs sample.diameters, as in"));
  for (const std::string model : {"bpm", "mpm"})
    CHECK(mentions(refusal("[experiment]\nloading = 'compaction'\nmodel = '" + model +
                           "'\n[contact]\nsurface_energy = 1\n[sample]\nsizes = 'list'\n"),
                   "needs sample.diameters, as in"));
  CHECK(mentions(refusal(box + "[sample]\nsizes = 'list'\ndiameters = [1]\nshares = [1]\nnumbers = [1]\n"),
                 "both say how many grains"));
  CHECK(mentions(refusal(box + "[sample]\nsizes = 'list'\ndiameters = [1]\nnumbers = [1, 2]\n"),
                 "sample.numbers must have a number for each of sample.diameters: 2 for 1"));
}

TEST_CASE("what comes with later versions is refused by key and line, and says what there is today") {
  const auto check_not_yet = [](const std::string& text, const std::string& place, const std::string& today) {
    const std::string message = refusal(text);
    CAPTURE(message);
    CHECK(mentions(message, "case.toml:" + place + ": error: not yet: "));
    CHECK(mentions(message, today));
    CHECK(mentions(message, "1 error; nothing was run"));
  };
  check_not_yet("[[kind]]\nshape = 'ellipse'\n", "2:1", "today these are disks");  // bonded
  check_not_yet("[box]\ndie_friction = 0.2\n", "2:1", "[[pair]]");
  check_not_yet("[[kind]]\nname = 'a'\n[[pair]]\nbetween = ['a', 'bottom']\n", "4:1", "is all of them");
}

TEST_CASE("mistakes in the long form are told with line, column and remedy") {
  CHECK(refusal("[[kind]]\ndensty = 1\n") ==
        "case.toml:2:1: error: unknown key 'kind.densty'; did you mean 'kind.density'?\n"
        "    2 | densty = 1\n"
        "      | ^\n"
        "1 error; nothing was run");
  CHECK(mentions(refusal("[kind]\nname = 'a'\n"), "'kind' may stand several times: write [[kind]]"));
  CHECK(mentions(refusal("kind = 1\n"), "write [[kind]]"));
  CHECK(mentions(refusal("kind = [1]\n"), "'kind' is a list of tables: write [[kind]]"));
  CHECK(mentions(refusal("[[knd]]\n"), "unknown key 'knd'"));
  CHECK(mentions(refusal("[knd]\n"), "unknown table 'knd'; did you mean 'kind'?"));
  CHECK(mentions(
      refusal("[[kind]]\nlaw = { young_modulus = '5 mm' }\n"),
      "case.toml:2:25: error: kind.law.young_modulus: unit 'mm' has the wrong dimension for a stress"));
  CHECK(mentions(refusal("[[kind]]\nlaw = 'hencky'\n"), "'kind.law' is a table"));
  CHECK(mentions(
      refusal("[[kind]]\nshape = 'dsk'\n"),
      "kind.shape takes one of \"disk\", \"ellipse\", \"polygon\", \"outline\", \"surface\", got 'dsk'; did "
      "you mean 'disk'?"));
  CHECK(mentions(refusal("[[kind]]\nname = 'wall'\n"), "\"wall\" is taken"));
  CHECK(mentions(refusal("[[kind]]\nshare = 0.7\n"),
                 "case.toml:2:1: error: kind.share = 0.7: there is only one"));
  CHECK(mentions(refusal("[[kind]]\nname = 3\n"), "kind.name takes a text"));
  CHECK(mentions(
      refusal("[grain]\ndensity = 1\n[[kind]]\ndensity = 2\n"),
      "case.toml:4:1: error: 'kind.density' says again what 'grain.density' says: give one of them"));
  CHECK(mentions(refusal("[[kind]]\nname = 'a'\n[[pair]]\nbetween = ['b', 'a']\n"),
                 "case.toml:4:1: error: pair.between: no [[kind]] has the name 'b'"));
  CHECK(mentions(refusal("[[pair]]\nfriction = 1\n"), "pair.between takes two names"));
  CHECK(mentions(refusal("[[pair]]\nbetween = ['wall', 'wall']\n"), "two walls never meet"));
  CHECK(mentions(refusal("[[kind]]\nname = 'a'\n[[pair]]\nbetween = ['a', 'wall']\nfriction = -1\n"),
                 "case.toml:5:12: error: pair.friction of a wall = -1 is out of range"));
  CHECK(
      mentions(refusal("[[stage]]\nyy = { velocity = '1 m' }\n"),
               "case.toml:2:19: error: stage.yy.velocity: unit 'm' has the wrong dimension for a velocity"));
  CHECK(mentions(refusal("[[stage]]\nuntil = { stress_yy = -1 }\n"),
                 "stage.until.stress_yy = -1 is out of range: it must be >= 0\n"));
  CHECK(mentions(refusal("[[stage]]\nyy = 'roll'\n"),
                 "stage.yy takes one of \"rest\", \"quasi-static\", got 'roll'"));
  CHECK(mentions(refusal("", {"stage.yy.velocity=1"}), "stands in a table of the file only"));
  CHECK(mentions(refusal("", {"kind.law.young_modulus=5 mm"}), "--set kind.law.young_modulus=5 mm: error:"));
}

TEST_CASE("one key holds the time step of all models, and the old one says what to write now") {
  const auto reading = [](const std::string& text, const std::vector<std::string>& sets = {}) {
    return parse_case_with_notes(text, "case.toml", sets);
  };
  const std::string mpm = "experiment.model = 'mpm'\n";
  CHECK(reading(mpm + "time.step = 'auto'").the_case.time.step == 0);
  CHECK(reading(mpm + "time.step = '5 us'").the_case.time.step == 5e-6);
  const CaseReading old = reading(mpm + "mpm.time_step = '5 us'");
  CHECK(old.the_case.time.step == 5e-6);
  CHECK(old.notes ==
        std::vector<std::string>{"note: mpm.time_step is an old name; write time.step = \"5 us\""});
  // a former version wrote both keys: each model had its own
  CHECK(reading(mpm + "time.step = '1 us'\nmpm.time_step = '5 us'").the_case.time.step == 5e-6);
  CHECK(reading(mpm + "time.step = '1 us'\nmpm.time_step = 0").the_case.time.step == 0);
  CHECK(reading("time.step = '1 us'\nmpm.time_step = '5 us'").the_case.time.step == 1e-6);
  CHECK(reading("time.step = '1 us'\nmpm.time_step = 0").notes.empty());
  CHECK(reading(mpm + "mpm.time_step = '5 us'", {"time.step=1 us"}).the_case.time.step == 1e-6);
  CHECK(reading(mpm + "time.step = '5 us'", {"mpm.time_step=1 us"}).the_case.time.step == 1e-6);
  CHECK(mentions(refusal(mpm + "mpm.time_step = '5 m'"), "case.toml:2:17: error: mpm.time_step: unit 'm'"));
}

TEST_CASE("contact.friction never acts inside a grain") {
  CHECK(mentions(refusal("[contact]\nfriction = 0.3\n"),
                 "case.toml:2:1: error: contact.friction acts between grains"));
  CHECK(mentions(refusal("", {"contact.friction=0.3"}), "write bpm.inner_friction = 0.3"));
  CHECK(refusal("contact.friction = 0\nbpm.inner_friction = 0.3").empty());
  CHECK(refusal("contact.friction = 0.3\nexperiment.loading = 'compaction'").empty());
}
