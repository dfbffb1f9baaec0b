#include <doctest/doctest.h>

#include <string>

#include "softgrain/io/case/checked_case.hpp"
#include "support/case_refusal.hpp"

using namespace softgrain;

namespace {

std::string fault(const std::string& text, const std::vector<std::string>& sets = {}) {
  const CaseReading reading = parse_case_with_notes(text, "case.toml", sets);
  try {
    check_case(reading);
  } catch (const CaseFileError& error) {
    return error.what();
  }
  return "";
}

const std::string box =
    "[experiment]\nmodel = 'mpm'\nloading = 'compaction'\n[mpm]\ncells = 4\n[sample]\ngrains = 2\n"
    "packing_fraction = 0.7\n";

}  // namespace

TEST_CASE("what is found as grains are placed and built names the line of the key that it is about") {
  CHECK(fault(box).starts_with("case.toml:8:1: error: sample.packing_fraction = 0.7: could not place"));
  CHECK(fault(box).find("    8 | packing_fraction = 0.7\n") != std::string::npos);
  CHECK(fault(box).ends_with("1 error; nothing was run"));
  CHECK(fault(box, {"sample.packing_fraction=0.75"})
            .starts_with("--set sample.packing_fraction=0.75: error: sample.packing_fraction = 0.75: could"));
  CHECK(fault(box + "[box]\nx = 'periodic'\n", {"sample.packing_fraction=0.5"})
            .starts_with("case.toml:10:1: error: box.x: the periodic cell is"));
  CHECK(fault(box + "[time]\nstep = '1 ms'\n", {"mpm.integrator=explicit", "sample.packing_fraction=0.5"})
            .starts_with("case.toml:10:1: error: time.step 1000 us is beyond the longest stable step"));
}

TEST_CASE("what names no key that was given names the file") {
  const std::string dense = box.substr(0, box.find("grains = 2")) + "aspect = 30\n";
  CHECK(fault(dense).starts_with("case.toml: error: sample.packing_fraction = 0.7: could not place"));
}

TEST_CASE("what is wrong between keys stands at the last of those that the message names") {
  const std::string flat =
      "[experiment]\nmodel = 'mpm'\nloading = 'biaxial'\ndimension = 3\n[loading]\n"
      "confining_stress = '1 kPa'\n[mpm]\ncells = 4\n";
  const std::string refused = test::refusal(flat);
  CHECK_MESSAGE(refused.find("4:1: error: not yet with experiment.dimension = 3") != std::string::npos,
                refused);
}

TEST_CASE("--set of the only kind takes its name, too") {
  const std::string text = box.substr(0, box.find("[sample]")) +
                           "[sample]\npacking_fraction = 0.5\n[[kind]]\n"
                           "name = 'rubber'\nnumber = 3\n";
  const std::vector<std::string> sets{"kind.rubber.law.young_modulus=2 MPa", "kind.number=4"};
  const Case c = parse_case(text, "case.toml", sets);
  CHECK(c.mpm.material.young_modulus == 2e6);
  CHECK(c.sample.grains == 4);
}
