#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

using softgrain::test::ProcessResult;
using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace {

const std::string metal =
    "[experiment]\nmodel = 'mpm'\n[mpm]\nlaw = 'von_mises'\nyield_stress = '1 MPa'\nyoung_modulus = '100 "
    "MPa'\n";

ProcessResult law(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {SOFTGRAIN_PROGRAM, "law"});
  return softgrain::test::run(arguments);
}

}  // namespace

TEST_CASE("law prints one line of numbers for each step, under a line of names") {
  const TemporaryDirectory folder;
  const std::string file = folder.file("case.toml", metal);
  const ProcessResult result = law({file, "--path", "shear", "--strain", "0.5", "--steps", "20"});
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK(result.out.starts_with("time,strain,stretch_y,stress_xx,"));
  CHECK(std::ranges::count(result.out, '\n') == 22);
  CHECK(law({file, "--path", "cycle", "--strain", "-0.1", "--steps", "5"}).exit_code == 0);
}

TEST_CASE("law writes its table and draws it") {
  const TemporaryDirectory folder;
  const std::string file = folder.file("case.toml", metal), table = (folder.path() / "law.csv").string();
  const std::string figure = (folder.path() / "law.png").string();
  CHECK(law({file, "-o", table}).out.empty());
  CHECK(read_text(table) == law({file}).out);
  const ProcessResult drawn = law({file, "-o", table, "--plot", figure});
  CHECK_MESSAGE(drawn.exit_code == 0, drawn.err);
  CHECK(drawn.out == figure + "\n");
  CHECK(read_text(figure).starts_with("\x89PNG"));
}

TEST_CASE("law refuses what it cannot drive") {
  const TemporaryDirectory folder;
  const std::string file = folder.file("case.toml", metal);
  CHECK(law({file, "--path", "twist"}).exit_code == 2);
  CHECK(law({file, "--strain", "0"}).err == "error: the strain must be a number other than 0, got 0\n");
  CHECK(law({file, "--plot", "law.png"}).err == "error: --plot draws what -o writes: give -o FILE.csv too\n");
  const ProcessResult bonded = law({folder.file("bonded.toml", "[experiment]\nmodel = 'bpm'\n")});
  CHECK(bonded.exit_code == 2);
  CHECK(bonded.err.find("experiment.model must be \"mpm\"") != std::string::npos);
}
