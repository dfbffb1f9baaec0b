#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

namespace fs = std::filesystem;
using softgrain::test::ProcessResult;
using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace {

constexpr auto tiny_case =
    "[time]\nstep = 0.25e-6\n[bpm]\nprimaries = 20\n[loading]\nmax_strain = 0.01\nunload_at = "
    "[]\nwall_velocity = \"2 m/s\"\n"
    "[output]\nsamples = 5\nsnapshots = 1\nreport = false\n";

/// `softgrain sweep case.toml --vary sample.seed=1..3 -o out` and more words.
ProcessResult sweep(const TemporaryDirectory& folder, const std::vector<std::string>& more) {
  std::vector<std::string> words{SOFTGRAIN_PROGRAM, "sweep", folder.file("case.toml", tiny_case), "--vary",
                                 "sample.seed=1..3"};
  words.insert(words.end(), more.begin(), more.end());
  words.insert(words.end(), {"-o", "out"});
  return softgrain::test::run(words, {}, folder.path().string());
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::istringstream text(read_text(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("a sweep makes each run as `softgrain run` would and sums them up in a table") {
  const TemporaryDirectory folder;
  const auto swept = sweep(folder, {"--jobs", "2", "--set", "contact.wall_friction=0.3", "--column", "step"});
  REQUIRE_MESSAGE(swept.exit_code == 0, swept.err);
  const auto one = softgrain::test::run({SOFTGRAIN_PROGRAM, "run", (folder.path() / "case.toml").string(),
                                         "--set", "sample.seed=2", "--set", "contact.wall_friction=0.3",
                                         "--set", "output.snapshots=4", "--set", "output.vtk=false", "-q"});
  REQUIRE(one.exit_code == 0);
  const auto case_of = [&](const char* run) { return read_text(folder.path() / run / "case.toml"); };
  CHECK(case_of("out/runs/seed_2") == case_of("case_run"));
  const auto last_row = lines_of(folder.path() / "case_run" / "series.csv").back();
  const auto step = last_row.substr(0, last_row.find(','));
  const auto table = lines_of(folder.path() / "out" / "results.csv");
  REQUIRE(table.size() == 4);
  CHECK(table[0] == "run,state,sample.seed,step_last,step_max");
  CHECK(table[2] == "seed_2,done,2," + step + "," + step);
}

TEST_CASE("a run that cannot be made stops no other run of the sweep, and exit code 3 names it") {
  const TemporaryDirectory folder;
  fs::create_directories(folder.path() / "out/runs/seed_1");
  std::ofstream(folder.path() / "out/runs/seed_1/thesis.txt") << "not to be overwritten";
  const auto swept = sweep(folder, {});
  CHECK(swept.exit_code == 3);
  CHECK(swept.err.find("1 of 3 runs failed: seed_1") != std::string::npos);
  CHECK(fs::exists(folder.path() / "out/runs/seed_3/run.json"));
  CHECK(read_text(folder.path() / "out/runs/seed_1/thesis.txt") == "not to be overwritten");
}

TEST_CASE(
    "a run that is not to be trusted stops no other run of the sweep: exit code 5 and the table say so") {
  const TemporaryDirectory folder;
  // in single precision no step converges to 1e-12
  const std::vector<std::string> unsolved{"--vary", "solver.tolerance=1e-12,1e-5"};
  const auto swept = sweep(folder, unsolved);
  CHECK(swept.exit_code == 5);
  CHECK(swept.err.find("3 of 6 runs are doubtful") != std::string::npos);
  int doubtful = 0, done = 0;
  for (const std::string& line : lines_of(folder.path() / "out" / "results.csv")) {
    doubtful += line.find(",doubtful,") != std::string::npos ? 1 : 0;
    done += line.find(",done,") != std::string::npos ? 1 : 0;
  }
  CHECK(doubtful == 3);
  CHECK(done == 3);
  CHECK(sweep(folder, unsolved).exit_code == 5);  // all done before
}

TEST_CASE("a sweep called again does nothing twice, and one of its runs can be made by its number") {
  const TemporaryDirectory folder;
  REQUIRE(sweep(folder, {"--index", "1"}).exit_code == 0);
  CHECK(fs::exists(folder.path() / "out/runs/seed_2/series.csv"));
  CHECK_FALSE(fs::exists(folder.path() / "out/runs/seed_1"));
  const auto written = fs::last_write_time(folder.path() / "out/runs/seed_2/run.json");
  CHECK(sweep(folder, {}).err.find("1 of 3 runs: done before") != std::string::npos);
  CHECK(fs::last_write_time(folder.path() / "out/runs/seed_2/run.json") == written);
}

TEST_CASE("a sweep leaves a plan that goes on with it and tells how far it is, and a dozen files for a run") {
  const TemporaryDirectory folder;
  REQUIRE(sweep(folder, {"--index", "1"}).exit_code == 0);
  const std::string plan = folder.file("plan.toml", "case = 'case.toml'\noutput = 'out'\nseeds = 3\n");
  const auto call = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all{SOFTGRAIN_PROGRAM, "sweep"};
    all.insert(all.end(), words.begin(), words.end());
    return softgrain::test::run(all, {}, folder.path().string());
  };
  CHECK(call({plan}).err.find("1 of 3 runs: done before") != std::string::npos);
  const auto told = call({"status", "out"});
  CHECK_MESSAGE(told.out.starts_with("out: 3 runs, 100.0 %"), told.err);
  CHECK(call({"out", "--list"}).out.find("\n2\tdone\t") != std::string::npos);
  CHECK(call({"out", "--vary", "sample.seed=4"}).exit_code == 2);
  const fs::recursive_directory_iterator all(folder.path() / "out/runs/seed_1");
  const auto is_file = [](const fs::directory_entry& entry) { return entry.is_regular_file(); };
  CHECK(std::count_if(begin(all), end(all), is_file) <= 12);
}

TEST_CASE("sweep refuses a value out of range before it runs anything") {
  const TemporaryDirectory folder;
  const auto swept = sweep(folder, {"--vary", "contact.friction=0,-1"});
  CHECK(swept.exit_code == 2);
  CHECK(swept.err.find("contact.friction = -1 is out of range") != std::string::npos);
  CHECK_FALSE(fs::exists(folder.path() / "out"));
}
