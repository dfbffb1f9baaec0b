#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/io/case/case_extension.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_refusal.hpp"
#include "support/simulations.hpp"

using namespace softgrain;
using test::mentions;
using test::refusal;

namespace {

const std::string in_box = "[experiment]\nloading = 'compaction'\nmodel = 'mpm'\n";
const std::string mixture = in_box + R"(
[mpm]
cells = 4
poisson_ratio = 0.3
[contact]
friction = 0.1
[sample]
packing_fraction = 0.6
[[kind]]
name = "rubber"
number = 7
density = "1000 kg/m^3"
diameter = "2 mm"
law.young_modulus = "1 MPa"
[[kind]]
name = "lead"
number = 3
density = "11000 kg/m^3"
diameter = { values = ["1 mm", "1.5 mm"], numbers = [1, 2] }
law = { name = "von_mises", young_modulus = "16 MPa", yield_stress = "0.1 MPa" }
cells = 5
[[pair]]
between = ["lead", "rubber"]
friction = 0.5
[[pair]]
between = ["wall", "lead"]
friction = 0.7
)";

Case read(const std::string& text, const std::vector<std::string>& sets = {}) {
  return parse_case(text, "case.toml", sets);
}

}  // namespace

TEST_CASE("each of several kinds has its law, density, sizes and number, and what is common stands outside") {
  const Case c = read(mixture);
  REQUIRE(c.kinds.size() == 2);
  const auto& rubber = c.kinds[0];
  const auto& lead = c.kinds[1];
  CHECK(rubber.name == "rubber");
  CHECK(rubber.law == MaterialLaw::neo_hookean);
  CHECK(rubber.material.young_modulus == 1e6);
  CHECK(rubber.material.poisson_ratio == 0.3);
  CHECK(rubber.cells == 4);
  CHECK(rubber.sizes.smallest_diameter == 2e-3);
  CHECK(rubber.sizes.largest_diameter == 2e-3);
  CHECK(lead.law == MaterialLaw::von_mises);
  CHECK(lead.material.yield_stress == 1e5);
  CHECK(lead.material.poisson_ratio == 0.3);
  CHECK(lead.grain.density == 11000);
  CHECK(lead.cells == 5);
  CHECK(lead.sizes.sizes == SizeLaw::list);
  CHECK(c.sample.grains == 10);
  CHECK(c.sample.smallest_diameter == 1e-3);
  CHECK(c.sample.largest_diameter == 2e-3);
  REQUIRE(c.pairs.size() == 2);
  CHECK(c.pairs[0].kind == 1);
  CHECK(c.pairs[0].other == 0);
  CHECK(c.pairs[0].friction == 0.5);
  CHECK(c.pairs[1].kind == 1);
  CHECK(c.pairs[1].other == Case::Pair::wall);
}

TEST_CASE("the resolved case of several kinds reads as the same case") {
  for (const std::string set : {"sample.seed=2", "kind.rubber.law.name=yeoh", "mpm.cells=6"}) {
    const std::string text = resolved_case_text(read(mixture, {set}));
    CAPTURE(text);
    const CaseReading again = parse_case_with_notes(text, "case.toml");
    CHECK(resolved_case_text(again.the_case) == text);
    CHECK(again.notes.empty());
    CHECK(again.without_effect.empty());
    CHECK(mentions(case_json(again.the_case), "\"name\": \"lead\""));
  }
}

TEST_CASE("--set changes one kind by its name, or all that do not say it themselves") {
  const Case c = read(mixture, {"kind.lead.law.yield_stress=2e5", "kind.rubber.number=9", "mpm.cells=3"});
  CHECK(c.kinds[1].material.yield_stress == 2e5);
  CHECK(c.sample.grains == 12);
  CHECK(c.kinds[0].cells == 3);
  CHECK(c.kinds[1].cells == 5);
  CHECK(
      mentions(refusal(mixture, {"kind.density=1"}), "write kind.NAME.key=value, NAME one of rubber, lead"));
  CHECK(mentions(refusal(mixture, {"kind.lead.densty=1"}), "unknown key 'kind.lead.densty'"));
}

TEST_CASE("shares of kinds are of area: as many grains as give it, by largest remainders") {
  const auto numbers = [](const std::string& share) {
    const Case c = read(in_box + "[sample]\ngrains = 20\n[[kind]]\nname = 'big'\nshare = " + share +
                        "\ndiameter = '2 mm'\n[[kind]]\nname = 'small'\nshare = 0.5\ndiameter = '1 mm'\n");
    return std::vector{c.kinds[0].grains, c.kinds[1].grains};
  };
  CHECK(numbers("0.5") == std::vector{4, 16});  // four small ones have the area of a big one
  CHECK(numbers("2") == std::vector{10, 10});
  CHECK(mentions(refusal(in_box + "[[kind]]\nname = 'a'\nshare = 1\n[[kind]]\nname = 'b'\nnumber = 2\n"),
                 "give all of them kind.number, or all of them kind.share"));
  CHECK(mentions(refusal(in_box + "[[kind]]\nname = 'a'\nshare = 1\n[[kind]]\nname = 'b'\nshare = 1e-6\n"),
                 "is less than a grain of the kind 'b'"));
}

TEST_CASE("a sample of two kinds of one material lies as that of one kind") {
  const std::string kind = "diameter = { smallest = '1 mm', largest = '2 mm' }\n";
  const BoxSample one = sample_box(read(in_box + "[sample]\ngrains = 12\nsmallest_diameter = '1 mm'\n"
                                                 "largest_diameter = '2 mm'\npacking_fraction = 0.6\n"));
  const BoxSample two =
      sample_box(read(in_box + "[sample]\npacking_fraction = 0.6\n[[kind]]\nname = 'a'\nnumber = 5\n" + kind +
                      "[[kind]]\nname = 'b'\nnumber = 7\n" + kind));
  REQUIRE(two.grains.size() == one.grains.size());
  for (std::size_t g = 0; g < one.grains.size(); ++g) {
    CHECK(two.grains[g].centre == one.grains[g].centre);
    CHECK(two.grains[g].radius == one.grains[g].radius);
    CHECK(two.grains[g].kind == (g < 5 ? 0 : 1));
  }
}

TEST_CASE("placed grains name their kind, also in the resolved case") {
  const std::string text = in_box +
                           "[sample]\nplaced = [[1e-3, 1e-3, 1e-3, 0], [3e-3, 1e-3, 1e-3, 0, 1]]\n"
                           "[[kind]]\nname = 'a'\n[[kind]]\nname = 'b'\nlaw.young_modulus = 1e8\n";
  const Case c = read(text);
  CHECK(c.sample.placed[1].kind == 1);
  CHECK(c.kinds[0].grains == 1);
  CHECK(resolved_case_text(read(resolved_case_text(c))) == resolved_case_text(c));
  CHECK(mentions(refusal(text + "number = 1\n"), "kind.number: the places of the grains say their number"));
  CHECK(mentions(refusal(text + "[[kind]]\nname = 'c'\n"), "no grain of the sample is of the kind 'c'"));
}

TEST_CASE("mistakes in several kinds are told with line, column and remedy") {
  const std::string two = in_box + "[[kind]]\nname = 'a'\nnumber = 2\n[[kind]]\nname = 'b'\nnumber = 2\n";
  CHECK(refusal(two).empty());
  CHECK(mentions(refusal(in_box + "[[kind]]\nnumber = 2\n[[kind]]\nname = 'b'\nnumber = 2\n"),
                 "case.toml:4:1: error: kind.name: each of several [[kind]] needs a name"));
  CHECK(mentions(refusal(in_box + "[[kind]]\nname = 'b'\n[[kind]]\nname = 'b'\n"),
                 "two [[kind]] have the name 'b'"));
  CHECK(
      mentions(refusal(two + "law = { name = 'von_mises' }\n"), "case.toml:10:9: error: kind 'b': mpm.law"));
  CHECK(
      mentions(refusal(two + "density = -1\n"), "case.toml:10:11: error: kind.density = -1 is out of range"));
  CHECK(mentions(refusal(two + "density = 1\ndensity = 2\n"), "case.toml:11"));
  CHECK(mentions(refusal(two + "[[pair]]\nbetween = ['a', 'c']\nfriction = 1\n"),
                 "no [[kind]] has the name 'c'"));
  const std::string pair = "[[pair]]\nbetween = ['a', 'b']\nfriction = 1\n";
  CHECK(mentions(refusal(two + pair + pair), "two [[pair]] are between 'a' and 'b'"));
  CHECK(refusal(two, {"experiment.model=bpm"}).empty());
  CHECK(mentions(refusal(two, {"experiment.loading=diametral"}), "several [[kind]] need a box"));
  CHECK(mentions(refusal(two + "model = 'bpm'\n"), "not yet: bonded grains among elastic ones"));
  CHECK(mentions(refusal(two, {"sample.grains=5"}), "the numbers of all [[kind]] are together 4"));
  const CaseReading vain = parse_case_with_notes(two + "law.yield_stress = 1e5\n", "case.toml");
  REQUIRE(vain.notes.size() == 1);
  CHECK(mentions(vain.notes[0], "mpm.yield_stress has no effect"));
}

namespace {

const std::string soft_and_rigid = in_box + R"(
[mpm]
cells = 4
law = "von_mises"
yield_stress = "0.1 MPa"
[sample]
packing_fraction = 0.5
[[kind]]
name = "glass"
model = "rigid"
number = 2
shape = "polygon"
sides = 4
density = "2500 kg/m^3"
diameter = "1 mm"
[[kind]]
name = "lead"
number = 3
diameter = "2 mm"
)";

}  // namespace

TEST_CASE("rigid kinds mix with elastic ones, and a resolved case says so") {
  const Case c = read(soft_and_rigid);
  REQUIRE(c.kinds.size() == 2);
  CHECK(c.experiment.model == GrainModel::mpm);
  const Case glass = case_of_kind(c, 0), lead = case_of_kind(c, 1);
  CHECK(is_rigid(glass));
  CHECK(glass.grain.shape == ShapeOfGrain::polygon);
  CHECK(glass.grain.sides == 4);
  CHECK(is_elastic(lead));
  CHECK(lead.mpm.law == MaterialLaw::von_mises);
  const std::string resolved = resolved_case_text(c);
  const Case again = read(resolved);
  CHECK(resolved_case_text(again) == resolved);
  CHECK(is_rigid(case_of_kind(again, 0)));
  CHECK(why_no_extension(c, again).empty());
  CHECK(is_rigid(read(soft_and_rigid, {"kind.lead.model=rigid"})));
  // without a word of it a kind beside a rigid one is elastic
  std::string silent = soft_and_rigid;
  silent.erase(silent.find("model = 'mpm'"), 13);
  CHECK(is_elastic(case_of_kind(read(silent), 1)));
}

TEST_CASE("a square fills 2 over pi of its circle, and so do packing fractions of a sample of squares") {
  const Case c =
      read(soft_and_rigid, {"kind.lead.model=rigid", "kind.lead.shape=polygon", "kind.lead.sides=4"});
  const Simulation simulation = test::simulation_of(c);
  const double phi = test::value_of(row_of(simulation.observe()), "phi_0");
  CHECK(phi == doctest::Approx(0.5 * 2 / 3.141592653589793).epsilon(1e-9));
  CHECK(first_packing_fraction(c) == doctest::Approx(phi).epsilon(1e-9));
}

TEST_CASE("what rigid grains cannot do is told with a remedy") {
  CHECK(mentions(refusal("[experiment]\nmodel = 'rigid'\n"),
                 "case.toml:2:1: error: a rigid grain between two walls does not give way"));
  CHECK(mentions(refusal(soft_and_rigid, {"kind.lead.shape=ellipse", "kind.lead.aspect=11"}),
                 "kind 'lead': grain.aspect of elastic ellipses must be at most 10"));
  CHECK(mentions(refusal(soft_and_rigid, {"kind.glass.sides=2"}), "kind.sides = 2 is out of range"));
  CHECK(mentions(refusal(soft_and_rigid, {"kind.lead.model=bpm"}),
                 "kind 'glass': rigid grains among bonded ones come in other shapes with a later version"));
}

TEST_CASE("a run goes on with the kinds with which it began") {
  const Case c = read(mixture);
  CHECK(why_no_extension(c, read(mixture, {"loading.max_strain=0.5"})).empty());
  CHECK(mentions(why_no_extension(c, read(mixture, {"kind.lead.law.yield_stress=2e5"})), "kinds"));
}

TEST_CASE("the grains of a mixture are what their kinds say") {
  for (const std::string integrator : {"implicit", "explicit"}) {
    CAPTURE(integrator);
    const Simulation simulation = test::simulation_of(read(mixture, {"mpm.integrator=" + integrator}));
    const auto check = [](const auto& dynamics) {
      const SoftGrains& grains = dynamics.grains;
      CHECK(grains.kinds() == 2);
      CHECK(grains.size() == 10);
      CHECK(grains.kind(6) == 0);
      CHECK(grains.kind(7) == 1);
      CHECK(grains.radius(9) == 0.75e-3);
      CHECK(grains.mass(9) == doctest::Approx(11000 * 3.14159265 * 0.75e-3 * 0.75e-3).epsilon(0.01));
      CHECK(dynamics.options.pair_friction.size() == 2);
    };
    if (integrator == "implicit")
      check(test::elastic<ImplicitDynamics>(simulation));
    else
      check(test::elastic<ExplicitDynamics>(simulation));
    CHECK(simulation.model().scene(simulation.box()).particles.contains("kind"));
  }
}
