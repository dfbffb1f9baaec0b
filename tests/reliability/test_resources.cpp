#include <doctest/doctest.h>

#include "reliability/tiny_cases.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/io/run/resources.hpp"

using namespace softgrain::test;

TEST_CASE(
    "a run that would take more than 90 % of memory or disk is refused with both numbers and remedies") {
  using namespace softgrain;
  const Resources available{.memory = 1e9, .disk = 2e9};
  CHECK_NOTHROW(require_resources({.memory = 0.9e9, .disk = 1.8e9}, available));
  const std::string memory = "needs about 901 MB of memory, and there are 1000 MB; choose fewer grains";
  CHECK_THROWS_WITH_AS(require_resources({.memory = 0.901e9}, available), doctest::Contains(memory.c_str()),
                       UsageError);
  const std::string disk =
      "needs about 1900 MB of disk, and there are 2000 MB; choose fewer output.snapshots";
  CHECK_THROWS_WITH_AS(require_resources({.disk = 1.9e9}, available), doctest::Contains(disk.c_str()),
                       UsageError);
}

TEST_CASE("a case too large for the machine is refused before anything is written, unless forced") {
  const Workshop workshop;
  const std::string line =
      "$SG new a --template compaction-mpm > /dev/null; ulimit -v 600000; exec $SG run a/case.toml "
      "--set sample.grains=300 --set mpm.cells=32 -q ";
  const ProcessResult refused = workshop.shell(line + "-o out");
  CAPTURE(refused.err);
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("MB of memory, and there are 614 MB") != std::string::npos);
  CHECK(refused.err.find("--force") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(workshop.path("out")));
  const ProcessResult forced = workshop.shell(line + "-o out --force");
  CAPTURE(forced.err);
  CHECK(forced.exit_code == 4);
  CHECK(forced.err.find("out of memory") != std::string::npos);
}

TEST_CASE("a run that is refused leaves nothing behind") {
  const Workshop workshop;
  const TinyCase tiny{"full", "compaction-mpm", {"sample.grains=4", "sample.packing_fraction=0.9"}};
  CHECK(run_tiny(workshop, tiny, "deep/out").exit_code == 2);
  CHECK_FALSE(std::filesystem::exists(workshop.path("deep")));
}

TEST_CASE("the disk that a run takes is what the estimate says, to a factor of two and a half") {
  for (const TinyCase& tiny : tiny_cases()) {
    if (tiny.source.starts_with('/')) continue;
    const Workshop workshop;
    CAPTURE(tiny.name);
    REQUIRE(run_tiny(workshop, tiny, "out").exit_code == 0);
    double bytes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(workshop.path("out")))
      if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
    const ProcessResult check =
        workshop.softgrain(with_settings({"check", case_file(workshop, tiny), "--json"}, tiny.settings));
    const double estimate = nlohmann::json::parse(check.out).at("estimate").at("disk_bytes");
    CAPTURE(estimate);
    CAPTURE(bytes);
    CHECK(bytes < 2.5 * estimate);
    CHECK(bytes > estimate / 2.5);
  }
}
