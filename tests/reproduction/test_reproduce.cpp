#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/program_runs.hpp"
#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace {

/// Whether every verdict whose statement contains `words` agrees; fails if there is none.
bool agrees(const nlohmann::json& verdicts, const std::string& words) {
  int found = 0;
  bool all = true;
  for (const auto& verdict : verdicts) {
    if (verdict["statement"].get<std::string>().find(words) == std::string::npos) continue;
    ++found;
    all = all && verdict["agrees"].get<bool>();
  }
  REQUIRE(found > 0);
  return all;
}

}  // namespace

TEST_CASE(
    "the paper's figures come out small: what must hold at any size holds, and each statement is judged") {
  const TemporaryDirectory folder;
  const std::string out = folder.path() / "out";
  std::vector<std::string> words{SOFTGRAIN_PROGRAM, "reproduce", "all", "-o", out};
  if (!softgrain::test::torture())
    words.insert(words.end(), {"--seeds", "1", "--set", "sample.grains=20", "--set", "bpm.primaries=60",
                               "--set", "mpm.cells=4"});
  const auto result = softgrain::test::run(words);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto verdicts = nlohmann::json::parse(read_text(out + "/verdicts.json"));
  CHECK(verdicts.size() == 29);
  CHECK(agrees(verdicts, "Phi = 0.7 exp(eps)"));
  CHECK(agrees(verdicts, "the grain does not break"));
  CHECK(agrees(verdicts, "BPM: friction has no effect on Z"));
  CHECK(agrees(verdicts, "MPM: friction has little effect on Z"));
  CHECK(agrees(verdicts, "BPM, mu = 0: sigma/sigma0 over eps' is convex"));
  // known not to be so, and said: a frictionless aggregate yields far below its cohesive pressure
  CHECK_FALSE(agrees(verdicts, "the threshold is almost equal to sigma_I"));
  for (const char* figure :
       {"fig1", "fig2", "fig3", "fig4", "packing_bpm_mu0_seed1", "packing_mpm_mu0.5_seed1"})
    CHECK(std::filesystem::file_size(out + "/" + figure + ".png") > 10000);
  const std::string page = read_text(out + "/reproduction.html");
  CHECK(page.find("<script") == std::string::npos);
  CHECK(page.find("http") == std::string::npos);
}
