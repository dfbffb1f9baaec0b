#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/io/run/run_directory.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;
namespace fs = std::filesystem;
using IfNotEmpty = RunDirectory::IfNotEmpty;

TEST_CASE("a run makes its directory, and refuses one that holds something without leaving a trace") {
  const test::TemporaryDirectory directory;
  const fs::path fresh = directory.path() / "a" / "b";
  {
    const RunDirectory made(fresh, IfNotEmpty::refuse);
    CHECK(fs::exists(fresh / ".lock"));
    directory.file("a/b/run.json", "{}");
  }
  CHECK(fs::exists(fresh / ".lock"));
  fs::remove(fresh / "run.json");
  CHECK_NOTHROW(RunDirectory(fresh, IfNotEmpty::refuse));  // a lock file alone does not count
  directory.file("notes.txt", "mine");
  CHECK_THROWS_AS(RunDirectory(directory.path(), IfNotEmpty::refuse), UsageError);
  CHECK_FALSE(fs::exists(directory.path() / ".lock"));
}

TEST_CASE("a run that was refused before it began leaves nothing, and what was there before") {
  const test::TemporaryDirectory directory;
  { const RunDirectory made(directory.path() / "a" / "b", IfNotEmpty::refuse); }
  CHECK_FALSE(fs::exists(directory.path() / "a"));
  directory.file("notes.txt", "mine");
  { const RunDirectory held(directory.path(), IfNotEmpty::keep); }
  CHECK_FALSE(fs::exists(directory.path() / ".lock"));
  CHECK(fs::exists(directory.path() / "notes.txt"));
}

TEST_CASE("a second run in the directory is refused and told the first one's process") {
  const test::TemporaryDirectory directory;
  int ready[2];
  REQUIRE(pipe(ready) == 0);
  const pid_t child = fork();
  if (child == 0) {
    const RunDirectory held(directory.path(), IfNotEmpty::refuse);
    if (write(ready[1], "x", 1) != 1) _exit(1);
    pause();
  }
  char byte = 0;
  REQUIRE(read(ready[0], &byte, 1) == 1);
  const auto message =
      fmt::format("{} is in use by another run, process {}", directory.path().string(), child);
  CHECK_THROWS_WITH_AS(RunDirectory(directory.path(), IfNotEmpty::refuse), message.c_str(), UsageError);
  CHECK(running_process(RunPaths{directory.path()}) == child);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  CHECK(running_process(RunPaths{directory.path()}) == 0);
  CHECK_NOTHROW(RunDirectory(directory.path(), IfNotEmpty::refuse));
}

TEST_CASE("clearing a run's directory removes a run's results and nothing of the user's") {
  const test::TemporaryDirectory directory;
  fs::create_directories(directory.path() / "snap");
  fs::create_directories(directory.path() / "vtk");
  for (const char* name : {"case.toml", "series.csv", "snap/s000001.h5", "snap/mine.h5",
                           "vtk/walls_000001.vtp", "paper.tex", "vtk/view.pvsm", "snap/s000002.h5.tmp"})
    directory.file(name, "");
  RunDirectory(directory.path(), IfNotEmpty::keep).clear();
  std::vector<std::string> left;
  for (const auto& entry : fs::recursive_directory_iterator(directory.path()))
    if (entry.is_regular_file()) left.push_back(entry.path().filename());
  std::sort(left.begin(), left.end());
  CHECK(left == std::vector<std::string>{"mine.h5", "paper.tex", "view.pvsm"});
}

TEST_CASE("snapshots are listed by their step, however many digits it has") {
  const test::TemporaryDirectory directory;
  fs::create_directories(directory.path() / "snap");
  for (const char* name :
       {"s1000000.h5", "s999999.h5", "s000000.h5", "x000001.h5", "s00x.h5", "s000007.h5.damaged"})
    directory.file(std::string("snap/") + name, "");
  std::vector<std::int64_t> steps;
  for (const SnapshotFile& file : list_snapshots(RunPaths{directory.path()})) steps.push_back(file.step);
  CHECK(steps == std::vector<std::int64_t>{0, 999999, 1000000});
}
