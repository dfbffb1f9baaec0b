#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "softgrain/core/error.hpp"
#include "softgrain/io/format/hdf5_file.hpp"
#include "softgrain/io/run/run_recorder.hpp"
#include "support/fake_simulation.hpp"
#include "support/file_size_limit.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;
using test::BouncingBall;
namespace fs = std::filesystem;

namespace {

RunRequest request(bool resume = false) {
  RunRequest request;
  request.case_text = "[output]\nsamples = 40\n";
  request.the_case.output.samples = 40;
  request.the_case.output.snapshots = 8;
  request.command = {"softgrain", "run", "ball.toml"};
  request.resume = resume;
  return request;
}

/// Runs a ball in the directory, as the program does.
RunOutcome run_ball(const fs::path& root, const RunRequest& asked, const BouncingBall& ball = {}) {
  Simulation simulation = ball.simulation();
  const RunDirectory directory(root, RunDirectory::IfNotEmpty::keep);
  Progress progress(ProgressStyle::none);
  SignalWatch signals;
  return record_run(simulation, directory, asked, progress, signals);
}

RunOutcome run_until_signal(const fs::path& root, int step, int signal, bool resume = false) {
  return run_ball(root, request(resume), {.signals_at = step, .signal = signal});
}

/// series.csv without its last column, the wall clock.
std::string physics(const fs::path& root) {
  std::istringstream series(test::read_text(root / "series.csv"));
  std::string text;
  for (std::string line; std::getline(series, line);) text += line.substr(0, line.rfind(',')) + "\n";
  return text;
}

std::string final_hash(const fs::path& root) {
  return Hdf5Reader(root / "snap" / "s000400.h5").text_attribute("content_hash");
}

nlohmann::json run_json(const fs::path& root) {
  return nlohmann::json::parse(test::read_text(root / "run.json"));
}

void check_equal_runs(const fs::path& a, const fs::path& b) {
  CHECK(physics(a) == physics(b));
  CHECK(final_hash(a) == final_hash(b));
  CHECK(run_json(a)["verdict"] == run_json(b)["verdict"]);
  CHECK(test::read_text(a / "run.pvd") == test::read_text(b / "run.pvd"));
}

void flip_a_bit(const fs::path& path) {
  std::string bytes = test::read_text(path);
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace

TEST_CASE("a run leaves rows and snapshots evenly over its progress, the first and last state among them") {
  const test::TemporaryDirectory directory;
  CHECK(run_ball(directory.path(), request()).exit_code == 0);
  const std::string series = physics(directory.path());
  CHECK(std::count(series.begin(), series.end(), '\n') == 1 + 41);
  CHECK(series.starts_with("step,time[s],strain,leg,wall_height[m],width[m],stress_bottom[Pa],"));
  std::vector<std::int64_t> steps;
  for (const SnapshotFile& file : list_snapshots(RunPaths{directory.path()})) steps.push_back(file.step);
  CHECK(steps == std::vector<std::int64_t>{0, 50, 100, 150, 200, 250, 300, 350, 400});
  CHECK(run_json(directory.path())["state"] == "done");
  CHECK(run_json(directory.path())["report"]["steps_converged"] == 392);
}

TEST_CASE("the solver's columns are means and maxima over the steps since the last row") {
  const test::TemporaryDirectory directory;
  run_ball(directory.path(), request());
  std::istringstream series(physics(directory.path()));
  std::string line;
  for (int k = 0; k < 3; ++k) std::getline(series, line);  // header, step 0, step 10
  // sweeps 1 + k % 7 and residual (1 + k % 11) 1e-6 / 3 for k = 1..10, worst twice that
  CHECK(line.substr(0, 3) == "10,");
  CHECK(line.find(fmt::format(",{},", (2 + 3 + 4 + 5 + 6 + 7 + 1 + 2 + 3 + 4) / 10.0)) != std::string::npos);
  const auto row = *read_last_row(directory.path() / "series.csv");
  const auto find = [&row](const std::string& name) {
    return std::find_if(row.begin(), row.end(), [&](const Quantity& q) { return q.name == name; })->value;
  };
  double sum = 0;
  for (int k = 391; k <= 400; ++k) sum += 1e-6 / 3 * (1 + k % 11);
  CHECK(find("residual_mean") == doctest::Approx(sum / 10).epsilon(1e-14));
  CHECK(find("residual_max") == doctest::Approx(2e-6 / 3 * 11).epsilon(1e-14));
}

TEST_CASE("a run that was stopped anywhere and resumed is bit for bit the run that was not") {
  const test::TemporaryDirectory whole, parts;
  run_ball(whole.path(), request());
  CHECK(run_until_signal(parts.path(), 3, SIGTERM).exit_code == 75);
  CHECK(run_json(parts.path())["state"] == "stopped");
  CHECK(run_until_signal(parts.path(), 137, SIGHUP, true).exit_code == 75);
  CHECK(run_until_signal(parts.path(), 250, SIGUSR2, true).exit_code == 75);
  CHECK(run_until_signal(parts.path(), 399 - 10, SIGINT, true).exit_code == 130);
  CHECK(run_ball(parts.path(), request(true)).exit_code == 0);
  CHECK(physics(parts.path()) == physics(whole.path()));
  CHECK(final_hash(parts.path()) == final_hash(whole.path()));
  CHECK(run_json(parts.path())["verdict"] == run_json(whole.path())["verdict"]);
  CHECK(run_json(parts.path())["resumes"] == 4);
  CHECK(run_ball(parts.path(), request(true)).exit_code == 0);  // resuming what is done changes nothing
  CHECK(physics(parts.path()) == physics(whole.path()));
  CHECK(run_json(parts.path())["verdict"] == run_json(whole.path())["verdict"]);
}

TEST_CASE("the case that a run goes on with is the one that was read before, whatever the file holds since") {
  const test::TemporaryDirectory directory;
  run_ball(directory.path(), request());
  RunRequest again = request(true);
  again.case_before = again.case_text;
  std::ofstream(directory.path() / "case.toml") << "# a note of somebody else\n";
  CHECK(run_ball(directory.path(), again).exit_code == 0);
  CHECK(test::read_text(directory.path() / "case.toml") == "# a note of somebody else\n");
}

TEST_CASE("the state at which the load turns is kept") {
  const test::TemporaryDirectory directory;
  BouncingBall ball;
  ball.turns_at = 123;
  run_ball(directory.path(), request(), ball);
  CHECK_NOTHROW(read_snapshot(directory.path() / "snap" / "s000123.h5"));
}

TEST_CASE("SIGUSR1 writes a snapshot and the run goes on") {
  const test::TemporaryDirectory directory;
  CHECK(run_until_signal(directory.path(), 122, SIGUSR1).exit_code == 0);
  CHECK_NOTHROW(read_snapshot(directory.path() / "snap" / "s000123.h5"));
  CHECK(run_json(directory.path())["state"] == "done");
}

TEST_CASE(
    "a snapshot is due when output.snapshot_every has passed by the clock, and a long time brings none") {
  RunRequest by_the_clock = request();
  by_the_clock.the_case.output.snapshots = 0;
  const auto run_with = [&](const fs::path& root, double seconds, const BouncingBall& ball) {
    by_the_clock.the_case.output.snapshot_every = seconds;
    const int exit_code = run_ball(root, by_the_clock, ball).exit_code;
    by_the_clock.resume = true;
    return exit_code;
  };
  const test::TemporaryDirectory whole, parts;
  run_ball(whole.path(), request());
  CHECK(run_with(parts.path(), 1e-9, {.signals_at = 20, .signal = SIGTERM}) == 75);
  CHECK(list_snapshots(RunPaths{parts.path()}).size() == 22);  // of 21 steps, and the first state
  CHECK(run_with(parts.path(), 3600, {}) == 0);
  CHECK(list_snapshots(RunPaths{parts.path()}).size() == 23);  // and the last
  CHECK(physics(parts.path()) == physics(whole.path()));
  CHECK(final_hash(parts.path()) == final_hash(whole.path()));
}

TEST_CASE("resuming skips damaged snapshots, sets them aside and still gives the same run") {
  const test::TemporaryDirectory whole, parts;
  run_ball(whole.path(), request());
  run_until_signal(parts.path(), 270, SIGTERM);
  flip_a_bit(parts.path() / "snap" / "s000271.h5");
  flip_a_bit(parts.path() / "snap" / "s000250.h5");
  run_ball(parts.path(), request(true));
  check_equal_runs(parts.path(), whole.path());
  CHECK(fs::exists(parts.path() / "snap" / "s000271.h5.damaged"));
  CHECK(test::read_text(parts.path() / "log.txt").find("skipped a snapshot: " + parts.path().string()) !=
        std::string::npos);
}

TEST_CASE("a run without any intact snapshot cannot be resumed and stays as it is") {
  const test::TemporaryDirectory directory;
  run_until_signal(directory.path(), 20, SIGTERM);
  for (const SnapshotFile& file : list_snapshots(RunPaths{directory.path()})) flip_a_bit(file.path);
  const std::string before = test::read_text(directory.path() / "run.json");
  CHECK_THROWS_AS(run_ball(directory.path(), request(true)), IoError);
  CHECK(test::read_text(directory.path() / "run.json") == before);
  CHECK(list_snapshots(RunPaths{directory.path()}).size() == 2);
}

TEST_CASE("a run that was killed at any moment resumes to the run that was not") {
  const test::TemporaryDirectory whole, parts;
  run_ball(whole.path(), request());
  BouncingBall slow;
  slow.pause = 200;
  for (int kill_number = 0; kill_number < 12; ++kill_number) {
    const pid_t child = fork();
    if (child == 0) {
      try {
        run_ball(parts.path(), request(true), slow);
      } catch (...) {
        _exit(1);
      }
      _exit(0);
    }
    usleep(3000 + 7919 * kill_number % 20000);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    CHECK((WIFSIGNALED(status) || WEXITSTATUS(status) == 0));
  }
  run_ball(parts.path(), request(true));
  check_equal_runs(parts.path(), whole.path());
}

TEST_CASE("a numerical failure names the last good snapshot and leaves the run failed") {
  const test::TemporaryDirectory directory;
  BouncingBall broken;
  broken.breaks_at = 120;
  const auto last_good = directory.path() / "snap" / "s000100.h5";
  const auto message = fmt::format(
      "step 121: position of particle 0 is not finite\nthe last good state is {}", last_good.string());
  CHECK_THROWS_WITH_AS(run_ball(directory.path(), request(), broken), message.c_str(), NumericalError);
  CHECK_NOTHROW(read_snapshot(last_good));
  CHECK(run_json(directory.path())["state"] == "failed");
  CHECK(run_json(directory.path())["message"] == message);
}

TEST_CASE("a full disk ends the run with the path and the bytes needed, and what was written stays good") {
  const test::TemporaryDirectory whole, parts;
  run_ball(whole.path(), request());
  for (const rlim_t size : {100, 600, 1500, 2500}) {  // run.json is the first, then series.csv
    std::string message;
    try {
      const test::FileSizeLimit limit(size);
      run_ball(parts.path(), request(true));
    } catch (const IoError& error) {
      message = error.what();
    }
    CHECK(message.starts_with(parts.path().string()));
    CHECK(message.find(" bytes: File too large") != std::string::npos);
    for (const auto& entry : fs::recursive_directory_iterator(parts.path()))
      CHECK(entry.path().extension() != ".tmp");
  }
  run_ball(parts.path(), request(true));
  check_equal_runs(parts.path(), whole.path());
}

TEST_CASE("a run is resumed only with the case that it was begun with") {
  const test::TemporaryDirectory directory;
  run_until_signal(directory.path(), 20, SIGTERM);
  RunRequest other = request(true);
  other.case_text += "[grain]\nradius = 1.0\n";
  other.the_case.grain.radius = 1;
  CHECK_THROWS_AS(run_ball(directory.path(), other), UsageError);
  CHECK(run_json(directory.path())["state"] == "stopped");
}

TEST_CASE("a time limit stops the run, ready to be resumed, with exit code 75") {
  const test::TemporaryDirectory directory;
  RunRequest limited = request();
  limited.stop_after = 1e-9;
  const RunOutcome outcome = run_ball(directory.path(), limited);
  CHECK(outcome.exit_code == 75);
  CHECK(outcome.record.step == 1);
  CHECK(run_json(directory.path())["message"] == "time limit");
}
