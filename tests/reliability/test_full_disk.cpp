#include <doctest/doctest.h>

#include "reliability/tiny_cases.hpp"
#include "support/small_disk.hpp"

namespace fs = std::filesystem;
using namespace softgrain::test;

namespace {

/// Every file that a program may read under its final name is whole, and none is left unfinished.
void check_nothing_partial(const Workshop& workshop, const std::string& run) {
  for (const fs::path& snapshot : workshop.snapshots(run))
    CHECK(workshop.softgrain({"info", snapshot.string()}).exit_code == 0);
  for (const auto& entry : fs::recursive_directory_iterator(workshop.path(run))) {
    const std::string text = entry.is_regular_file() ? read_text(entry.path()) : "";
    CAPTURE(entry.path().string());
    CHECK(entry.path().extension() != ".tmp");
    if (entry.path().filename() == "run.json") CHECK(nlohmann::json::accept(text));
    if (entry.path().extension() == ".vtp") CHECK(text.ends_with("</VTKFile>\n"));
    if (entry.path().filename() == "series.csv") CHECK((text.empty() || text.back() == '\n'));
  }
}

TinyCase diametral() {
  TinyCase tiny{"full", "diametral-mpm", tiny_settings("diametral-mpm")};
  tiny.settings.push_back("output.report=true");
  return tiny;
}

}  // namespace

TEST_CASE(
    "on a full disk a run ends with code 4, the path and the bytes, leaves nothing partial, and goes on "
    "later") {
  const Workshop workshop;
  REQUIRE(run_tiny(workshop, diametral(), "whole").exit_code == 0);
  int full = 0;
  for (const std::string size : {"8k", "40k", "100k", "300k", "500k", "1m"}) {
    const SmallDisk disk(workshop.path("disk"), size);
    if (!disk.mounted()) {
      MESSAGE("may not mount a small disk here");
      return;
    }
    CAPTURE(size);
    const ProcessResult result = run_tiny(workshop, diametral(), "disk/run", {"--force"});
    CAPTURE(result.err);
    if (result.exit_code == 0) continue;  // it had room for all
    ++full;
    CHECK(result.exit_code == 4);
    CHECK(result.err.find("error: disk/run") == 0);
    CHECK(result.err.find("No space left on device") != std::string::npos);
    if (fs::exists(workshop.path("disk/run"))) check_nothing_partial(workshop, "disk/run");
    disk.enlarge("20m");
    CHECK(run_tiny(workshop, diametral(), "disk/run", {"--resume"}).exit_code == 0);
    CHECK(workshop.last_hash("disk/run") == workshop.last_hash("whole"));
  }
  CHECK(full >= 4);
}

TEST_CASE("a limit on the size of files is a full disk, not a crash") {
  const Workshop workshop;
  case_file(workshop, diametral());
  std::string line = "ulimit -f 60; exec $SG run full/case.toml -o out -q";  // blocks of 512 bytes
  for (const std::string& setting : diametral().settings) line += " --set '" + setting + "'";
  const ProcessResult result = workshop.shell(line);
  CAPTURE(result.err);
  CHECK(result.exit_code == 4);
  CHECK(result.err.find("error: out/snap/s0000") == 0);
  CHECK(result.err.find("bytes: File too large") != std::string::npos);
  check_nothing_partial(workshop, "out");
}

TEST_CASE("an output to a full device is code 4 for every verb, and an unwritable stderr is no crash") {
  const Workshop workshop;
  REQUIRE(run_tiny(workshop, diametral(), "out").exit_code == 0);
  const std::string problem = std::string(SOFTGRAIN_TEST_DATA) + "/contact/FrictionContactProblem00237.hdf5";
  for (const std::string& verb :
       {std::string("info out"), std::string("info --json out"), std::string("verify out"),
        std::string("check full/case.toml"), std::string("check --json full/case.toml"),
        std::string("schema"), std::string("doctor"), "solve " + problem, std::string("--help"),
        std::string("--version"), std::string("report out -o page.html")}) {
    CAPTURE(verb);
    const ProcessResult result = workshop.shell("$SG " + verb + " > /dev/full");
    CAPTURE(result.err);
    CHECK(result.exit_code == 4);
  }
  CHECK(workshop.shell("$SG info nowhere 2> /dev/full").exit_code == 2);
  CHECK(workshop.shell("$SG nonsense 2> /dev/full").exit_code == 2);
  CHECK(workshop.shell("$SG info out > /dev/full 2> /dev/full").exit_code == 4);
  CHECK(workshop.shell("$SG check full/case.toml 2> /dev/full > /dev/null").exit_code == 4);
}
