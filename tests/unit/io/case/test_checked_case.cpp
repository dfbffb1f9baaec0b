#include <doctest/doctest.h>

#include <string>

#include "softgrain/io/case/checked_case.hpp"

using namespace softgrain;

namespace {

std::string refusal(const std::string& text, const std::vector<std::string>& sets = {}) {
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
  CHECK(refusal(box).starts_with("case.toml:8:1: error: sample.packing_fraction = 0.7: could not place"));
  CHECK(refusal(box).find("    8 | packing_fraction = 0.7\n") != std::string::npos);
  CHECK(refusal(box).ends_with("1 error; nothing was run"));
  CHECK(refusal(box, {"sample.packing_fraction=0.75"})
            .starts_with("--set sample.packing_fraction=0.75: error: sample.packing_fraction = 0.75: could"));
  CHECK(refusal(box + "[box]\nx = 'periodic'\n", {"sample.packing_fraction=0.5"})
            .starts_with("case.toml:10:1: error: box.x: the periodic cell is"));
  CHECK(refusal(box + "[time]\nstep = '1 ms'\n", {"mpm.integrator=explicit", "sample.packing_fraction=0.5"})
            .starts_with("case.toml:10:1: error: time.step 1000 us is beyond the longest stable step"));
}

TEST_CASE("what names no key that was given names the file") {
  const std::string dense = box.substr(0, box.find("grains = 2")) + "aspect = 30\n";
  CHECK(refusal(dense).starts_with("case.toml: error: sample.packing_fraction = 0.7: could not place"));
}
