#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/scope.hpp"
#include "support/case_refusal.hpp"

using namespace softgrain;
using test::mentions;
using test::refusal;

namespace {

const std::string mpm = "[experiment]\nmodel = 'mpm'\n[mpm]\n";

}  // namespace

TEST_CASE("a law takes its parameters by name, in the short form and in a kind") {
  const Case in_short = parse_case(
      mpm +
          "law = 'von_mises'\nyield_stress = '70 MPa'\nhardening_modulus = '1 GPa'\nviscosity = '5 kPa s'\n",
      "case.toml", {});
  const Case in_long = parse_case(
      "[[kind]]\nmodel = 'mpm'\nlaw = { name = 'von_mises', yield_stress = '70 MPa', hardening_modulus = '1 "
      "GPa', "
      "viscosity = '5 kPa s' }\n",
      "case.toml", {});
  for (const Case& c : {in_short, in_long}) {
    CHECK(c.mpm.law == MaterialLaw::von_mises);
    CHECK(c.mpm.material.yield_stress == 70e6);
    CHECK(c.mpm.material.hardening_modulus == 1e9);
    CHECK(c.mpm.material.viscosity == 5e3);
    CHECK(c.mpm.material.young_modulus == Case{}.mpm.material.young_modulus);
  }
}

TEST_CASE("what a law cannot have is an error of the case, with the line of its last key") {
  CHECK(mentions(
      refusal(mpm + "law = 'von_mises'\n"),
      "case.toml:4:1: error: mpm.law \"von_mises\": a law that flows needs a yield_stress > 0 Pa, got 0"));
  CHECK(mentions(
      refusal(mpm + "law = 'von_mises'\nyield_stress = 1e5\nsaturation_stress = 2e5\n"),
      "case.toml:6:1: error: mpm.law \"von_mises\": saturation_stress and saturation_rate belong together"));
  CHECK(mentions(refusal(mpm + "law = 'yeoh'\nc30 = '-1 MPa'\n"), "stretched rubber must resist"));
  CHECK(mentions(refusal(mpm + "law = 'von_mises'\nyield_stress = '-1 MPa'\n"), "mpm.yield_stress"));
  CHECK(mentions(refusal(mpm + "viscosity = '1 MPa'\n"), "wrong dimension for a viscosity"));
  CHECK(mentions(refusal("[[kind]]\nlaw = { yield_stres = 1 }\n"), "did you mean 'kind.law.yield_stress'?"));
  CHECK(
      mentions(refusal(mpm + "law = 'von_mises'\nyield_stress = 1e5\nformulation = 'updated_lagrangian'\n"),
               "mpm.formulation \"updated_lagrangian\" takes elastic laws only, not mpm.law \"von_mises\""));
}

TEST_CASE("a parameter that the law does not take is named as without effect") {
  const Case c = parse_case(mpm + "c20 = 1e4\n", "case.toml", {});
  const std::vector<std::string> notes = notes_on_effect(c, {"mpm.c20", "mpm.young_modulus"});
  REQUIRE(notes.size() == 1);
  CHECK(notes[0] == "note: mpm.c20 has no effect on mpm between walls: it acts only with mpm.law yeoh");
  const CaseReading metal = parse_case_with_notes(
      "[[kind]]\nmodel = 'mpm'\nlaw = { name = 'hencky', yield_stress = '70 MPa' }\n", "case.toml", {});
  CHECK(metal.without_effect == std::vector<std::string>{"mpm.yield_stress"});
}

TEST_CASE("laws that creep, relax or pull back take their numbers with units") {
  const Case wax =
      parse_case(mpm + "law = 'norton'\ncreep_rate = '0.1 1/s'\ncreep_stress = '2 MPa'\ncreep_exponent = 5\n",
                 "case.toml", {});
  CHECK(wax.mpm.law == MaterialLaw::norton);
  CHECK(wax.mpm.material.creep_rate == 0.1);
  CHECK(wax.mpm.material.creep_stress == 2e6);
  CHECK(wax.mpm.material.creep_exponent == 5);
  const Case gel = parse_case(
      "[[kind]]\nmodel = 'mpm'\nlaw = { name = 'prony', relaxation_share_1 = 0.4, relaxation_time_1 = '20 "
      "ms' }\n",
      "case.toml", {});
  CHECK(gel.mpm.law == MaterialLaw::prony);
  CHECK(gel.mpm.material.relaxation_time_1 == doctest::Approx(0.02));
  const Case metal = parse_case(mpm + "law = 'von_mises'\nyield_stress = 1e5\nkinematic_modulus = '1 MPa'\n",
                                "case.toml", {});
  CHECK(metal.mpm.material.kinematic_modulus == 1e6);
  CHECK(mentions(refusal(mpm + "law = 'norton'\ncreep_rate = 1\n"),
                 "creep needs a creep_rate > 0 1/s and a creep_stress > 0 Pa, got 1 and 0"));
  CHECK(mentions(refusal(mpm + "law = 'norton'\ncreep_exponent = 0.5\n"), "mpm.creep_exponent"));
  CHECK(mentions(refusal(mpm + "law = 'prony'\n"), "what relaxes needs a relaxation_share_1 > 0"));
  CHECK(mentions(refusal(mpm + "law = 'prony'\nrelaxation_share_2 = 0.4\n"),
                 "relaxation_share_2 and relaxation_time_2 belong together"));
  CHECK(mentions(refusal(mpm + "law = 'ogden'\nogden_exponent_1 = 0\n"), "ogden_exponent_1 must not be 0"));
  CHECK(mentions(refusal(mpm + "law = 'mooney_rivlin'\nc01 = '50 MPa'\n"), "c01 must lie in [0, "));
  CHECK(mentions(refusal(mpm + "law = 'norton'\ncreep_rate = 1\ncreep_stress = 1e5\n"
                               "formulation = 'updated_lagrangian'\n"),
                 "takes elastic laws only, not mpm.law \"norton\""));
}
