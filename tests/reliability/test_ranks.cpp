#ifdef SOFTGRAIN_MPI_PROGRAM
#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "reliability/tiny_cases.hpp"
#include "support/small_disk.hpp"

using namespace softgrain::test;

namespace {

using Clock = std::chrono::steady_clock;

/// `softgrain-mpi` on ranks of this machine, more than it has cores if need be.
struct Ranks {
  Workshop workshop;

  Ranks() {
    workshop.environment = {{"OMPI_MCA_mpi_yield_when_idle", "1"},
                            {"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                            {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                            {"OMPI_MCA_rmaps_base_oversubscribe", "1"}};
  }

  static Words command(int ranks, const Words& words) {
    Words argv{SOFTGRAIN_MPIRUN,      "--oversubscribe",    "--bind-to", "none", "-np",
               std::to_string(ranks), SOFTGRAIN_MPI_PROGRAM};
    argv.insert(argv.end(), words.begin(), words.end());
    return argv;
  }
  ProcessResult on(int ranks, const Words& words) const {
    return run(command(ranks, words), workshop.environment, workshop.here());
  }
  Words begin(const TinyCase& tiny, const std::string& directory, const Words& options = {}) const {
    Words words = with_settings({"run", case_file(workshop, tiny), "-o", directory, "-q"}, tiny.settings);
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
};

/// Enough grains for three batches of eight, so that three ranks have work.
TinyCase packing(const std::string& name, const std::string& base, const Words& more) {
  TinyCase tiny{name, base, tiny_settings(base)};
  const Words of_all{"sample.grains=18", "output.vtk=false", "output.samples=60", "output.snapshots=30"};
  for (const Words& words : {of_all, more})
    tiny.settings.insert(tiny.settings.end(), words.begin(), words.end());
  return tiny;
}

std::vector<TinyCase> packings() {
  const Words quick{"loading.max_strain=0.2", "loading.unload_at=[0.18]", "loading.unload_by=0.02"};
  const auto with = [&](Words words) {
    words.insert(words.end(), quick.begin(), quick.end());
    return words;
  };
  return {
      packing("smooth-bonded", "compaction-bpm",
              with({"contact.friction=0", "contact.wall_friction=0", "bpm.inner_friction=0"})),
      packing("rough-bonded", "compaction-bpm",
              with({"contact.friction=0.5", "contact.surface_energy=4", "contact.wall_surface_energy=4"})),
      packing("explicit", "compaction-mpm",
              with({"mpm.integrator=\"explicit\"", "time.step=0", "contact.friction=0.5"})),
      packing("implicit", "compaction-mpm", with({"contact.friction=0.5"}))};
}

/// The processes that a process has begun.
std::vector<pid_t> children_of(pid_t parent) {
  std::ifstream file("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children");
  std::vector<pid_t> children;
  for (pid_t child = 0; file >> child;) children.push_back(child);
  return children;
}

/// The most memory that a rank of a run has held [bytes].
struct PeakMemory {
  double mean = 0, largest = 0;
};
PeakMemory peak_memory(const Ranks& ranks, const std::string& run) {
  const auto told = nlohmann::json::parse(read_text(ranks.workshop.path(run) / "run.json")).at("ranks");
  return {told.at("peak_memory_bytes_mean"), told.at("peak_memory_bytes_largest")};
}

void wait_for_snapshots(const Ranks& ranks, const std::string& run, std::size_t count) {
  for (int tenths = 0; tenths < 300 && ranks.workshop.snapshots(run).size() < count; ++tenths) usleep(100000);
  REQUIRE(ranks.workshop.snapshots(run).size() >= count);
}

}  // namespace

// Ranks that are more than the cores wait for one another, so that in `make test` they carry out the last
// thirtieth.
TEST_CASE("a run has the same bits on any number of ranks and threads") {
  const Ranks ranks;
  std::vector<TinyCase> cases = packings();
  if (torture())
    for (const TinyCase& tiny : tiny_cases()) cases.push_back(tiny);
  struct Team {
    int ranks, threads;
  };
  const std::vector<Team> teams = torture() ? std::vector<Team>{{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 1},
                                                                {3, 2}, {4, 1}, {4, 2}, {8, 1}, {8, 2}}
                                            : std::vector<Team>{{3, 1}};
  for (const TinyCase& tiny : cases) {
    CAPTURE(tiny.name);
    const std::string alone = tiny.name + "_alone";
    const ProcessResult plain = run_tiny(ranks.workshop, tiny, alone, {"-j", "1"});
    for (const auto& [count, threads] : teams) {
      CAPTURE(count);
      CAPTURE(threads);
      const std::string together = tiny.name + "_" + std::to_string(count) + "_" + std::to_string(threads);
      if (!torture())
        copy_cut_off(ranks.workshop, alone, together, ranks.workshop.snapshots(alone).size() - 1);
      const ProcessResult result =
          ranks.on(count, ranks.begin(tiny, together, {"-j", std::to_string(threads), "--resume"}));
      CAPTURE(result.err);
      REQUIRE(result.exit_code == plain.exit_code);
      CHECK(ranks.workshop.last_hash(together) == ranks.workshop.last_hash(alone));
      const bool same_series = ranks.workshop.series(together) == ranks.workshop.series(alone);
      CHECK(same_series);
    }
  }
}

TEST_CASE("a run has the same bits however unequal the parts of the ranks are") {
  Ranks ranks;
  for (const TinyCase& tiny : packings()) {
    CAPTURE(tiny.name);
    const std::string alone = tiny.name + "_alone";
    const ProcessResult plain = run_tiny(ranks.workshop, tiny, alone, {"-j", "1"});
    for (const char* seed : torture() ? std::vector{"1", "2", "3", "4"} : std::vector{"1"}) {
      CAPTURE(seed);
      const std::string together = tiny.name + "_parts_" + seed;
      if (!torture())
        copy_cut_off(ranks.workshop, alone, together, ranks.workshop.snapshots(alone).size() - 1);
      ranks.workshop.environment["SOFTGRAIN_PARTITION"] = seed;
      const ProcessResult result = ranks.on(4, ranks.begin(tiny, together, {"-j", "1", "--resume"}));
      ranks.workshop.environment.erase("SOFTGRAIN_PARTITION");
      CAPTURE(result.err);
      REQUIRE(result.exit_code == plain.exit_code);
      CHECK(ranks.workshop.last_hash(together) == ranks.workshop.last_hash(alone));
      const bool same_series = ranks.workshop.series(together) == ranks.workshop.series(alone);
      CHECK(same_series);
    }
  }
}

TEST_CASE("a killed rank ends all, and other numbers of ranks go on to the same end") {
  Ranks ranks;
  TinyCase tiny = packings()[1];
  REQUIRE(run_tiny(ranks.workshop, tiny, "whole").exit_code == 0);
  if (!torture())
    copy_cut_off(ranks.workshop, "whole", "killed", ranks.workshop.snapshots("whole").size() - 4);
  std::vector<int> counts{3, 2};
  if (torture())
    for (int k = 0; k < 20; ++k) counts.push_back(std::vector{4, 3, 1, 8}[k % 4]);
  for (std::size_t k = 0; k + 1 < counts.size(); ++k) {
    CAPTURE(k);
    ranks.workshop.environment["SOFTGRAIN_PARTITION"] = std::to_string(k);  // each time other grains
    const std::size_t before = ranks.workshop.snapshots("killed").size();
    Process mpirun(Ranks::command(counts[k], ranks.begin(tiny, "killed", {"--resume"})),
                   ranks.workshop.environment, ranks.workshop.here());
    const bool ends = before + 2 > ranks.workshop.snapshots("whole").size();
    if (!ends) wait_for_snapshots(ranks, "killed", before + 1);
    const std::vector<pid_t> children = children_of(mpirun.id());
    if (!children.empty()) kill(children.back(), SIGKILL);
    const auto begin = Clock::now();
    const int exit_code = mpirun.wait().exit_code;
    CHECK(Clock::now() - begin < std::chrono::seconds(30));
    if (!ends) CHECK(exit_code == 128 + SIGKILL);
  }
  ranks.workshop.environment.erase("SOFTGRAIN_PARTITION");
  CHECK(ranks.on(counts.back(), {"resume", "killed", "-q"}).exit_code == 0);
  CHECK(ranks.workshop.intact("killed"));
  CHECK(ranks.workshop.last_hash("killed") == ranks.workshop.last_hash("whole"));
  const bool same_series = ranks.workshop.series("killed") == ranks.workshop.series("whole");
  CHECK(same_series);
}

// The first rank once held all material points for each snapshot, 300 bytes for each, and all ranks held a
// snapshot from which they went on, 400 bytes.
TEST_CASE("the first rank holds hardly more than the others, also while it writes, and while all read") {
  const Ranks ranks;
  const TinyCase tiny = packing("many_points", "compaction-mpm",
                                {"mpm.integrator=\"explicit\"", "mpm.cells=24", "sample.grains=24",
                                 "output.samples=2", "output.snapshots=2", "loading.wall_velocity=\"20 m/s\"",
                                 "loading.max_strain=0.0002", "loading.unload_at=[]", "time.step=0"});
  constexpr double points = 24 * 14 * 24 * 24, few = 60 * points;  // [bytes]
  const ProcessResult begin = ranks.on(3, ranks.begin(tiny, "large", {"-j", "1"}));
  CAPTURE(begin.err);
  REQUIRE(begin.exit_code == 0);
  const PeakMemory begun = peak_memory(ranks, "large");
  CAPTURE(begun.mean);
  CAPTURE(begun.largest);
  CHECK(begun.largest - begun.mean < few);
  copy_cut_off(ranks.workshop, "large", "on", ranks.workshop.snapshots("large").size() - 1);
  REQUIRE(ranks.on(3, {"resume", "on", "-q", "-j", "1"}).exit_code == 0);
  CHECK(ranks.workshop.last_hash("on") == ranks.workshop.last_hash("large"));
  const PeakMemory gone_on = peak_memory(ranks, "on");
  CAPTURE(gone_on.largest);
  CHECK(gone_on.largest - begun.mean < few);
}

TEST_CASE("what stops one rank stops all of them with its exit code, and with its error once") {
  const Ranks ranks;
  const auto lines_with = [](const std::string& text, const std::string& words) {
    int lines = 0;
    for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++lines;
    return lines;
  };
  SUBCASE("a signal to mpirun") {
    const TinyCase tiny = packings()[1];
    Process mpirun(Ranks::command(2, ranks.begin(tiny, "stopped")), ranks.workshop.environment,
                   ranks.workshop.here());
    wait_for_snapshots(ranks, "stopped", 2);
    mpirun.send(SIGUSR2);
    CHECK(mpirun.wait().exit_code == 75);
    CHECK(ranks.workshop.intact("stopped"));
  }
  SUBCASE("the error of a grain of the last rank") {
    TinyCase tiny = packings()[2];
    for (const char* more : {"loading.wall_velocity=\"250 m/s\"", "loading.unload_at=[]"})
      tiny.settings.push_back(more);
    const ProcessResult alone = run_tiny(ranks.workshop, tiny, "alone");
    const ProcessResult result = ranks.on(3, ranks.begin(tiny, "ranks"));
    REQUIRE(alone.exit_code == 3);
    CHECK(result.exit_code == 3);
    const std::string sentence = alone.err.substr(0, alone.err.find('\n'));
    CAPTURE(result.err);
    CHECK(lines_with(result.err, sentence) == 1);
  }
  SUBCASE("a folder that the rank that writes finds no more") {
    const TinyCase tiny = packings()[1];
    Process mpirun(Ranks::command(2, ranks.begin(tiny, "lost")), ranks.workshop.environment,
                   ranks.workshop.here());
    wait_for_snapshots(ranks, "lost", 2);
    std::filesystem::rename(ranks.workshop.path("lost") / "snap", ranks.workshop.path("lost") / "gone");
    const auto begin = Clock::now();
    const ProcessResult result = mpirun.wait();
    CHECK(Clock::now() - begin < std::chrono::seconds(30));
    CAPTURE(result.err);
    CHECK(result.exit_code == 4);
    CHECK(lines_with(result.err, "error:") == 1);
  }
  SUBCASE("a disk that is full while the others give their particles") {
    const SmallDisk disk(ranks.workshop.path("disk"), "200k");
    if (!disk.mounted()) {
      MESSAGE("may not mount a small disk here");
      return;
    }
    const auto begin = Clock::now();
    const ProcessResult result = ranks.on(3, ranks.begin(packings()[2], "disk/run", {"--force"}));
    CHECK(Clock::now() - begin < std::chrono::seconds(30));
    CAPTURE(result.err);
    CHECK(result.exit_code == 4);
    CHECK(lines_with(result.err, "bytes: No space left on device") == 1);
    CHECK(std::filesystem::is_empty(ranks.workshop.path("disk/run/snap")));
  }
  SUBCASE("a rank that answers no more, as behind a link that is cut") {
    if (!torture()) return;
    auto environment = ranks.workshop.environment;
    environment["SOFTGRAIN_WATCHDOG"] = "3";
    Process mpirun(Ranks::command(3, ranks.begin(packings()[1], "cut")), environment, ranks.workshop.here());
    wait_for_snapshots(ranks, "cut", 1);
    const std::vector<pid_t> children = children_of(mpirun.id());
    REQUIRE(children.size() == 3);
    kill(children.back(), SIGSTOP);
    const auto begin = Clock::now();
    CHECK(mpirun.wait().exit_code == 75);
    CHECK(Clock::now() - begin < std::chrono::seconds(30));
    CHECK(ranks.workshop.intact("cut"));
  }
  SUBCASE("a verb without work for ranks") {
    const ProcessResult result = ranks.on(2, {"schema"});
    CHECK(result.exit_code == 2);
    CHECK(lines_with(result.err, "'schema' is no work for 2 ranks: only run, resume, bench are") == 1);
  }
}
#endif
