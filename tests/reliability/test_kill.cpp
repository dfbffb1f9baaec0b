#include <doctest/doctest.h>
#include <unistd.h>

#include <csignal>
#include <random>

#include "reliability/tiny_cases.hpp"

using namespace softgrain::test;

namespace {

/// How many lines of the text are not finished or do not have as many fields as the first.
int torn_lines(const std::string& text) {
  std::istringstream lines(text);
  int torn = text.empty() || text.back() == '\n' ? 0 : 1;
  std::ptrdiff_t commas = -1;
  for (std::string line; std::getline(lines, line) && !lines.eof();) {
    const auto count = std::count(line.begin(), line.end(), ',');
    if (commas < 0) commas = count;
    if (count != commas) ++torn;
  }
  return torn;
}

}  // namespace

TEST_CASE("a run killed at random moments while it writes often loses nothing that was on the disk") {
  const Workshop workshop;
  TinyCase tiny{"often", "compaction-mpm", tiny_settings("compaction-mpm")};
  for (const char* more : {"output.samples=10000", "output.snapshots=10000"}) tiny.settings.push_back(more);
  REQUIRE(run_tiny(workshop, tiny, "whole").exit_code == 0);
  const Words begin =
      with_settings({"run", case_file(workshop, tiny), "-o", "killed", "-q", "--resume"}, tiny.settings);
  std::mt19937 random(7);
  int kills = 0, snapshots_seen = 0;
  for (int trial = 0; trial < repeats(10, 100); ++trial) {
    Process process(Workshop::command(begin), workshop.environment, workshop.here());
    usleep(static_cast<unsigned>(30000 + random() % 150000));
    process.send(SIGKILL);
    if (process.wait().exit_code == 128 + SIGKILL) ++kills;
    CAPTURE(trial);
    CHECK(torn_lines(read_text(workshop.path("killed") / "series.csv")) <= 1);
    const auto snapshots = workshop.snapshots("killed");
    if (snapshots.empty()) continue;
    ++snapshots_seen;
    CHECK(workshop.softgrain({"info", snapshots.back().string()}).exit_code == 0);  // the newest is intact
    if (trial % 10 == 9) std::filesystem::remove_all(workshop.path("killed"));      // begin anew
  }
  MESSAGE(kills << " kills, " << snapshots_seen << " of them after the first snapshot");
  CHECK(kills > 0);
  CHECK(workshop.softgrain(begin).exit_code == 0);
  CHECK(workshop.intact("killed"));
  CHECK(torn_lines(read_text(workshop.path("killed") / "series.csv")) == 0);
  CHECK(workshop.last_hash("killed") == workshop.last_hash("whole"));
  const bool same_series = workshop.series("killed") == workshop.series("whole");
  CHECK(same_series);
}

TEST_CASE("a run that was killed before its first snapshot, or as it began anew, is begun by --resume") {
  const Workshop workshop;
  const TinyCase tiny{"early", "diametral-mpm", tiny_settings("diametral-mpm")};
  REQUIRE(run_tiny(workshop, tiny, "whole").exit_code == 0);
  for (const char* left : {"mkdir -p r", "mkdir -p r/snap r/vtk && touch r/.lock",
                           "mkdir -p r && touch r/run.json.tmp", "mkdir -p r/snap && cp whole/run.json r"}) {
    CAPTURE(left);
    REQUIRE(workshop.shell(std::string("rm -rf r && ") + left).exit_code == 0);
    CHECK(run_tiny(workshop, tiny, "r", {"--resume"}).exit_code == 0);
    CHECK(workshop.last_hash("r") == workshop.last_hash("whole"));
  }
  REQUIRE(workshop.shell("rm -rf r && mkdir -p r/snap && touch r/snap/mine").exit_code == 0);
  CHECK(run_tiny(workshop, tiny, "r", {"--resume"}).exit_code == 2);  // what is not a run's stays
}

TEST_CASE("a torn last line of the series is repaired on resume") {
  const Workshop workshop;
  const TinyCase tiny{"torn", "diametral-mpm", tiny_settings("diametral-mpm")};
  REQUIRE(run_tiny(workshop, tiny, "whole").exit_code == 0);
  const std::string text = read_text(workshop.path("whole") / "series.csv");
  for (std::size_t cut :
       {text.size() - 1, text.size() - 40, text.size() / 2, std::size_t{10}, std::size_t{0}}) {
    const std::string run = "cut" + std::to_string(cut);
    CAPTURE(run);
    copy_cut_off(workshop, "whole", run, 1);
    workshop.file(run + "/series.csv", text.substr(0, cut));
    CHECK(workshop.softgrain({"resume", run, "-q"}).exit_code == 0);
    CHECK(torn_lines(read_text(workshop.path(run) / "series.csv")) == 0);
    const std::string end = workshop.series(run);
    CHECK(workshop.series("whole").ends_with(end.substr(end.find('\n'))));
  }
}

TEST_CASE("a run killed before its first file was whole can be begun again") {
  const Workshop workshop;
  std::filesystem::create_directory(workshop.path("out"));
  workshop.file("out/.lock", "1\n");
  workshop.file("out/run.json.tmp", "{\"for");
  const TinyCase tiny{"early", "diametral-mpm", tiny_settings("diametral-mpm")};
  CHECK(run_tiny(workshop, tiny, "out", {"--resume"}).exit_code == 0);
}
