#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

using softgrain::test::ProcessResult;
using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace fs = std::filesystem;

namespace {

ProcessResult softgrain_program(std::vector<std::string> arguments, const std::string& directory = "") {
  arguments.insert(arguments.begin(), SOFTGRAIN_PROGRAM);
  return softgrain::test::run(arguments, {}, directory);
}

/// A run of a small aggregate, in `folder`/run.
std::string small_run(const TemporaryDirectory& folder, const std::vector<std::string>& more = {}) {
  const std::string text =
      "[time]\nstep = 0.25e-6\n[bpm]\nprimaries = 50\n[loading]\nmax_strain = 0.02\nunload_at = "
      "[]\n[output]\nsnapshots = 4\nvtk = "
      "false\n";
  const std::string run = (folder.path() / "run").string();
  std::vector<std::string> words{"run", folder.file("case.toml", text), "-o", run};
  words.insert(words.end(), more.begin(), more.end());
  REQUIRE(softgrain_program(words).exit_code == 0);
  return run;
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

const std::string payload = "class=\"run\">";

}  // namespace

TEST_CASE("a run leaves a page of itself beside its results, unless it is told not to") {
  const TemporaryDirectory with, without;
  CHECK(count(read_text(small_run(with) + "/report.html"), payload) == 1);
  CHECK_FALSE(fs::exists(small_run(without, {"--set", "output.report=false"}) + "/report.html"));
}

TEST_CASE("report writes one page of several runs and says where it is") {
  const TemporaryDirectory folder;
  const std::string run = small_run(folder);
  const auto result = softgrain_program({"report", run, run, "-o", "both.html"}, folder.path().string());
  CHECK(result.exit_code == 0);
  CHECK(result.err == "");
  CHECK(result.out.starts_with("both.html: "));
  CHECK(count(read_text(folder.path() / "both.html"), payload) == 2);
}

TEST_CASE("report of a small run takes less than a second") {
  const TemporaryDirectory folder;
  const std::string run = small_run(folder);
  const auto begin = std::chrono::steady_clock::now();
  CHECK(softgrain_program({"report", run}).exit_code == 0);
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(1));
}

TEST_CASE(
    "report warns of a damaged snapshot and shows the others; of none that is intact it makes no page") {
  const TemporaryDirectory folder;
  const std::string run = small_run(folder), page = run + "/report.html";
  std::vector<fs::path> snapshots(fs::directory_iterator(run + "/snap"), {});
  folder.file("run/snap/" + snapshots.front().filename().string(), "bad");
  const auto warned = softgrain_program({"report", run});
  CHECK(warned.exit_code == 0);
  CHECK(warned.err.find(snapshots.front().filename().string()) != std::string::npos);
  fs::remove(page);
  for (const fs::path& snapshot : snapshots) folder.file("run/snap/" + snapshot.filename().string(), "bad");
  const auto refused = softgrain_program({"report", run});
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("softgrain verify") != std::string::npos);
  CHECK_FALSE(fs::exists(page));
}

TEST_CASE("report refuses what is no run with exit code 2 and a remedy, and an unwritable page with 4") {
  const TemporaryDirectory folder;
  for (const std::string& wrong : {folder.path().string(), (folder.path() / "nowhere").string()}) {
    const auto result = softgrain_program({"report", wrong});
    CHECK(result.exit_code == 2);
    CHECK(result.err.find("softgrain run CASE -o " + wrong) != std::string::npos);
  }
  const std::string run = small_run(folder);
  CHECK(softgrain_program({"report", run, "-o", run + "/no/such/page.html"}).exit_code == 4);
  CHECK(softgrain_program({"report", run, "-o", "/dev/full/page.html"}).exit_code == 4);
}
