#include <doctest/doctest.h>

#include <cerrno>

#include "reliability/tiny_cases.hpp"

namespace fs = std::filesystem;
using namespace softgrain::test;

namespace {

TinyCase tiny_compaction() {
  TinyCase tiny{"compaction-mpm", "compaction-mpm", tiny_settings("compaction-mpm")};
  tiny.settings.insert(tiny.settings.end(), {"loading.max_strain=0.05", "loading.unload_at=[]"});
  return tiny;
}

bool same_runs(const Workshop& workshop, const std::string& a, const std::string& b) {
  return workshop.last_hash(a) == workshop.last_hash(b) && workshop.series(a) == workshop.series(b);
}

/// From now on every flock fails with this error, in the program and in what it starts.
void take_locks_away(Workshop& workshop, int error) {
  workshop.environment["LD_PRELOAD"] = SOFTGRAIN_FAILING_CALLS;
  workshop.environment["SOFTGRAIN_FAIL"] = "flock:1+";
  workshop.environment["SOFTGRAIN_FLOCK_ERROR"] = std::to_string(error);
}

}  // namespace

TEST_CASE("a file system without locks costs a warning, not the run") {
  for (const int error : {ENOSYS, ENOLCK, EOPNOTSUPP, EINVAL}) {
    CAPTURE(error);
    Workshop workshop;
    const TinyCase tiny = tiny_compaction();
    const std::string path = case_file(workshop, tiny);
    take_locks_away(workshop, error);
    const auto run = workshop.softgrain(with_settings({"run", path, "-o", "out"}, tiny.settings));
    CHECK(run.exit_code == 0);
    CHECK(run.err.find("warning: out cannot be locked (") != std::string::npos);
    CHECK_FALSE(fs::exists(workshop.path("out/.lock")));
    CHECK(read_text(workshop.path("out/log.txt")).find("cannot be locked") != std::string::npos);
    const std::string series = workshop.series("out");
    fs::remove(workshop.snapshots("out").back());
    CHECK(workshop.softgrain({"resume", "out", "-q"}).exit_code == 0);
    CHECK(workshop.series("out") == series);
    CHECK_FALSE(fs::exists(workshop.path("out/.lock")));
    CHECK(workshop.softgrain({"info", "out"}).out.find("out: a run, done\n") != std::string::npos);
    if (error != ENOLCK) continue;
    const auto read = workshop.softgrain({"export", "out", "--to", "csv"});  // h5py locks by default
    CHECK_MESSAGE(read.exit_code == 0, read.err);
  }
}

TEST_CASE("a sweep runs where the file system has no locks") {
  Workshop workshop;
  const std::string path = workshop.file(
      "case.toml",
      "[bpm]\nprimaries = 20\n[loading]\nmax_strain = 0.01\nunload_at = []\nwall_velocity = \"2 m/s\"\n"
      "[output]\nsamples = 5\nsnapshots = 1\nreport = false\n");
  take_locks_away(workshop, ENOLCK);
  const auto swept = workshop.softgrain({"sweep", path, "--vary", "sample.seed=1..2", "-o", "out"});
  CHECK_MESSAGE(swept.exit_code == 0, swept.err);
  CHECK(read_text(workshop.path("out/results.csv")).find("seed_2,done,") != std::string::npos);
}

TEST_CASE("a run goes on after somebody tidied up: without vtk/, run.json or case.toml") {
  const Workshop workshop;
  const TinyCase tiny = tiny_compaction();
  REQUIRE(run_tiny(workshop, tiny, "whole", {"--set", "output.vtk=true"}).exit_code == 0);
  const auto go_on = [&](const std::string& run) {
    return run_tiny(workshop, tiny, run, {"--set", "output.vtk=true", "--resume"});
  };
  for (const std::string missing : {"vtk", "run.json", "case.toml"}) {
    CAPTURE(missing);
    const std::string run = "without_" + missing;
    copy_cut_off(workshop, "whole", run, 3);
    fs::remove_all(workshop.path(run + "/" + missing));
    const auto resumed = go_on(run);
    CHECK_MESSAGE(resumed.exit_code == 0, resumed.err);
    CHECK(same_runs(workshop, run, "whole"));
    for (const char* file : {"/vtk", "/run.json", "/case.toml"}) CHECK(fs::exists(workshop.path(run + file)));
    CHECK(read_text(workshop.path(run + "/case.toml")) == read_text(workshop.path("whole/case.toml")));
  }
  copy_cut_off(workshop, "whole", "resumed", 3);
  fs::remove_all(workshop.path("resumed/vtk"));
  CHECK(workshop.softgrain({"resume", "resumed", "-q"}).exit_code == 0);
  CHECK(same_runs(workshop, "resumed", "whole"));

  copy_cut_off(workshop, "whole", "nameless", 3);
  fs::remove(workshop.path("nameless/case.toml"));
  const auto nameless = workshop.softgrain({"resume", "nameless"});
  CHECK(nameless.exit_code == 2);
  CHECK(nameless.err.find("nameless has no case.toml; `softgrain run CASE -o nameless --resume`") !=
        std::string::npos);
  fs::remove(workshop.path("nameless/run.json"));
  const auto other = run_tiny(workshop, tiny, "nameless", {"--set", "contact.wall_friction=0.1", "--resume"});
  CHECK(other.exit_code == 2);
  CHECK(other.err.find("is not the case that the run was begun with") != std::string::npos);
}
