#include <doctest/doctest.h>
#include <sys/stat.h>

#include <random>

#include "reliability/tiny_cases.hpp"

namespace fs = std::filesystem;
using namespace softgrain::test;

namespace {

/// The program with 2 GB of address space and 20 s of time.
ProcessResult confined(const Workshop& workshop, const std::string& words) {
  return workshop.shell("ulimit -v 2000000; ulimit -t 20; exec $SG " + words);
}

/// Refused in the orderly way: a message, exit code 2 or 4.
void check_refused(const ProcessResult& result) {
  CAPTURE(result.err.substr(0, 300));
  CHECK((result.exit_code == 2 || result.exit_code == 4));
  CHECK(result.err.find("error") != std::string::npos);
  CHECK(result.err.find("this is a bug") == std::string::npos);
  CHECK(result.err.size() < 100000);
}

}  // namespace

TEST_CASE("hostile case files are refused within 2 GB: sizes, depths, devices, pipes, links") {
  const Workshop workshop;
  workshop.file("deep.toml", "a = " + std::string(1000000, '['));
  workshop.file("deep_tables.toml", std::string(900000, '[') + "\n");
  workshop.file("long_key.toml", std::string(900000, 'k') + " = 1\n");
  workshop.file("huge.toml", "");
  fs::resize_file(workshop.path("huge.toml"), 4'000'000'000);  // a sparse file: 4 GB of zeros
  fs::create_symlink("loop.toml", workshop.path("loop.toml"));
  fs::create_symlink("/dev/zero", workshop.path("zero.toml"));
  fs::create_directory(workshop.path("folder.toml"));
  for (const std::string name : {"deep.toml", "deep_tables.toml", "long_key.toml", "huge.toml", "loop.toml",
                                 "zero.toml", "folder.toml", "nowhere/../../nothing.toml"}) {
    CAPTURE(name);
    check_refused(confined(workshop, "check " + name));
  }
}

TEST_CASE("no number of a case may be NaN, infinite, negative where that is meaningless, or a list") {
  const Workshop workshop;
  workshop.softgrain({"new", "a"});
  for (const std::string key :
       {"grain.radius", "grain.density", "bpm.primaries", "bpm.exponent", "contact.friction",
        "solver.max_sweeps", "loading.wall_velocity", "loading.max_strain", "time.step", "sample.grains",
        "mpm.cells", "output.samples", "output.snapshots"})
    for (const std::string value : {"nan", "inf", "-inf", "-1", "1e400", "[]", "[[1]]"}) {
      CAPTURE(key);
      CAPTURE(value);
      check_refused(confined(workshop, "check a/case.toml --set '" + key + "=" + value + "'"));
    }
}

TEST_CASE("damaged contact problems are solved or refused, within 2 GB, and never crash the program") {
  const Workshop workshop;
  const std::string bytes =
      read_text(fs::path(SOFTGRAIN_TEST_DATA) / "contact" / "FrictionContactProblem00237.hdf5");
  std::mt19937 random(3);
  int crashes = 0;
  for (int trial = 0; trial < repeats(40, 600); ++trial) {
    std::string damaged = bytes;
    if (trial % 4 == 0) damaged.resize(random() % bytes.size());
    if (trial % 4 != 0)
      for (int k = 0; k < 1 + trial % 8; ++k)
        damaged[random() % damaged.size()] = static_cast<char>(random());
    workshop.file("problem.hdf5", damaged);
    const ProcessResult result = confined(workshop, "solve problem.hdf5 --max-sweeps 50");
    CAPTURE(trial);
    CAPTURE(result.err);
    if (result.exit_code >= 128) ++crashes;
    CHECK((result.exit_code == 0 || result.exit_code == 2 || result.exit_code == 3));
  }
  CHECK(crashes == 0);
}

TEST_CASE("a run's directory full of traps is read without harm") {
  const Workshop workshop;
  const TinyCase tiny{"trap", "diametral-mpm", tiny_settings("diametral-mpm")};
  REQUIRE(run_tiny(workshop, tiny, "whole").exit_code == 0);
  copy_cut_off(workshop, "whole", "trap_run", 4);
  const fs::path snap = workshop.path("trap_run/snap");
  fs::create_symlink("/dev/zero", snap / "s000090.h5");
  REQUIRE(mkfifo((snap / "s000091.h5").c_str(), 0600) == 0);
  fs::create_symlink("s000092.h5", snap / "s000092.h5");
  workshop.file("trap_run/snap/s999999999999999999999.h5", "a number too large");
  workshop.file("trap_run/snap/s-00001.h5", "a negative one");
  workshop.file("trap_run/series.csv",
                std::string(3000000, 'x') + "\n" + std::string(100, ',') + "\nnan,inf\n");
  CHECK(confined(workshop, "info trap_run").exit_code == 0);
  CHECK(confined(workshop, "verify trap_run").exit_code == 4);
  const ProcessResult resumed = confined(workshop, "resume trap_run -q");
  CAPTURE(resumed.err.substr(0, 500));
  CHECK(resumed.exit_code != 0);  // the series is not one
  CHECK(resumed.exit_code < 128);
  fs::remove(workshop.path("trap_run/series.csv"));
  CHECK(confined(workshop, "resume trap_run -q").exit_code == 0);
  fs::remove(snap / "s999999999999999999999.h5");
  fs::remove(snap / "s-00001.h5");
  CHECK(workshop.last_hash("trap_run") == workshop.last_hash("whole"));
  workshop.file("trap_run/run.json", std::string(100000, '['));
  CHECK(confined(workshop, "info trap_run").exit_code == 4);
}
