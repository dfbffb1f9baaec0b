#include <doctest/doctest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

namespace fs = std::filesystem;
using softgrain::test::Process;
using softgrain::test::ProcessResult;
using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace {

constexpr auto small_case =
    "[time]\nstep = 0.25e-6\n[bpm]\nprimaries = 60\n[loading]\nmax_strain = 0.02\nunload_at = "
    "[]\nwall_velocity = \"1 m/s\"\n"
    "[output]\nsamples = 20\nsnapshots = 5\n";

std::vector<std::string> command(const std::vector<std::string>& words) {
  std::vector<std::string> argv{SOFTGRAIN_PROGRAM};
  argv.insert(argv.end(), words.begin(), words.end());
  return argv;
}

ProcessResult softgrain_run(const TemporaryDirectory& directory, const std::vector<std::string>& words) {
  return softgrain::test::run(command(words), {}, directory.path().string());
}

/// Waits until the run's first snapshot is there.
void wait_for_start(const fs::path& root) {
  for (int k = 0; k < 2000 && !fs::exists(root / "snap" / "s000000.h5"); ++k) usleep(5000);
}

std::string physics(const fs::path& root) {
  std::istringstream series(read_text(root / "series.csv"));
  std::string text;
  for (std::string line; std::getline(series, line);) text += line.substr(0, line.rfind(',')) + "\n";
  return text;
}

std::string last_hash(const TemporaryDirectory& directory, const std::string& run) {
  const auto described = softgrain_run(directory, {"info", "--json", run});
  const std::string newest = nlohmann::json::parse(described.out).at("snapshots").back();
  return nlohmann::json::parse(softgrain_run(directory, {"info", "--json", newest}).out).at("content_hash");
}

std::string state_of(const fs::path& root) {
  return nlohmann::json::parse(read_text(root / "run.json")).at("state");
}

void flip_a_bit(const fs::path& path) {
  std::string bytes = read_text(path);
  bytes[bytes.size() / 3] ^= 4;
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace

TEST_CASE("softgrain run leaves a directory that tells all about the run, beside the case") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  const auto result = softgrain_run(directory, {"run", "small.toml", "--set", "output.snapshots=4"});
  CHECK(result.exit_code == 0);
  CHECK(result.out.starts_with("converged "));
  CHECK(result.out.find("next: look at small_run/report.html in a browser, or softgrain plot small_run") !=
        std::string::npos);
  CHECK(result.err.find(" 50 %  strain ") != std::string::npos);
  const fs::path root = directory.path() / "small_run";
  for (const char* name : {"case.toml", "run.json", "series.csv", "log.txt", "run.pvd", "report.html",
                           "vtk/particles_000000.vtp"})
    CHECK(fs::exists(root / name));
  const auto json = nlohmann::json::parse(read_text(root / "run.json"));
  CHECK(json.at("state") == "done");
  CHECK(json.at("command").at(4) == "output.snapshots=4");
  CHECK(json.at("step") == json.at("steps_planned"));
  CHECK(json.at("machine").at("peak_memory_bytes") > 1000000);
  CHECK(softgrain_run(directory, {"check", "small_run/case.toml"}).exit_code == 0);
}

TEST_CASE("softgrain run refuses a directory with something in it, and --force replaces a run") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  CHECK(softgrain_run(directory, {"run", "small.toml", "-q"}).exit_code == 0);
  const std::string before = read_text(directory.path() / "small_run" / "log.txt");
  const auto refused = softgrain_run(directory, {"run", "small.toml"});
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("small_run is not empty; --resume") != std::string::npos);
  CHECK(read_text(directory.path() / "small_run" / "log.txt") == before);
  const auto forced =
      softgrain_run(directory, {"run", "small.toml", "--force", "-q", "--set", "output.snapshots=2"});
  CHECK(forced.exit_code == 0);
  CHECK(forced.out + forced.err == "");
  const auto snapshots = fs::directory_iterator(directory.path() / "small_run" / "snap");
  CHECK(std::distance(begin(snapshots), end(snapshots)) == 3);
}

TEST_CASE("softgrain run never overwrites its own case file") {
  const TemporaryDirectory directory;
  directory.file("case.toml", small_case);
  const auto result = softgrain_run(directory, {"run", "case.toml", "-o", ".", "--force"});
  CHECK(result.exit_code == 2);
  CHECK(read_text(directory.path() / "case.toml") == small_case);
}

TEST_CASE("a run stopped by signals and resumed equals the one that was not, to the last bit") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  const std::vector<std::string> longer{"--set", "loading.max_strain=0.5", "--set", "time.step=0.1e-6", "-q"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), longer.begin(), longer.end());
    return words;
  };
  CHECK(softgrain_run(directory, with({"run", "small.toml", "-o", "whole"})).exit_code == 0);
  Process first(command(with({"run", "small.toml", "-o", "parts"})), {}, directory.path().string());
  wait_for_start(directory.path() / "parts");
  first.send(SIGINT);
  CHECK(first.wait().exit_code == 130);
  CHECK(state_of(directory.path() / "parts") == "stopped");
  Process second(command({"resume", "parts"}), {}, directory.path().string());
  for (int k = 0; k < 2000 && state_of(directory.path() / "parts") != "running"; ++k) usleep(5000);
  second.send(SIGTERM);
  CHECK(second.wait().exit_code == 75);
  CHECK(softgrain_run(directory, with({"run", "small.toml", "-o", "parts", "--resume"})).exit_code == 0);
  CHECK(physics(directory.path() / "parts") == physics(directory.path() / "whole"));
  CHECK(last_hash(directory, "parts") == last_hash(directory, "whole"));
}

TEST_CASE("a second run in the same directory exits 2 and names the first one's process") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  const std::vector<std::string> words{"run", "small.toml", "-o", "out", "--set", "loading.max_strain=0.5"};
  Process first(command(words), {}, directory.path().string());
  wait_for_start(directory.path() / "out");
  first.send(SIGSTOP);  // it must not end before the others have looked at it
  const auto second = softgrain_run(directory, words);
  CHECK(second.exit_code == 2);
  CHECK(second.err.find("in use by another run, process ") != std::string::npos);
  CHECK(softgrain_run(directory, {"info", "out"}).out.find("running, process ") != std::string::npos);
  first.send(SIGKILL);
  first.wait();
  CHECK(softgrain_run(directory, {"info", "out"}).out.find(": a run, killed") != std::string::npos);
}

TEST_CASE("softgrain verify finds a flipped bit and exits 4") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  CHECK(softgrain_run(directory, {"run", "small.toml", "-o", "out", "-q"}).exit_code == 0);
  CHECK(softgrain_run(directory, {"verify", "out"}).exit_code == 0);
  flip_a_bit(directory.path() / "out" / "snap" / "s000000.h5");
  const auto result = softgrain_run(directory, {"verify", "out"});
  CHECK(result.exit_code == 4);
  CHECK(result.out.find("s000000.h5: not a snapshot, or a damaged one") != std::string::npos);
  CHECK(result.err.find("1 of 6 snapshots are bad") != std::string::npos);
  CHECK(softgrain_run(directory, {"info", "out/snap/s000000.h5"}).exit_code == 4);
}

TEST_CASE("a case that differs from the stored one is not resumed") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  CHECK(softgrain_run(directory, {"run", "small.toml", "-o", "out", "--stop-after", "1 us"}).exit_code == 75);
  const auto other =
      softgrain_run(directory, {"run", "small.toml", "-o", "out", "--resume", "--set", "sample.seed=2"});
  CHECK(other.exit_code == 2);
  CHECK(other.err.find("softgrain resume out") != std::string::npos);
  CHECK(state_of(directory.path() / "out") == "stopped");
}

TEST_CASE("a run that was begun under another meaning of a key is shown, but not resumed") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  REQUIRE(softgrain_run(directory, {"run", "small.toml", "-o", "out", "--stop-after", "1 us"}).exit_code ==
          75);
  // contact.friction was the friction between the primaries of one grain
  const std::string text = read_text(directory.path() / "out/case.toml");
  const std::size_t at = text.find("[contact]\nfriction = 0.0");
  REQUIRE(at != std::string::npos);
  directory.file("out/case.toml", text.substr(0, at) + "[contact]\nfriction = 0.3" + text.substr(at + 24));
  CHECK(softgrain_run(directory, {"info", "out"}).exit_code == 0);
  CHECK(softgrain_run(directory, {"report", "out"}).exit_code == 0);
  const auto resumed = softgrain_run(directory, {"resume", "out"});
  CHECK(resumed.exit_code == 2);
  CHECK(resumed.err.find("write bpm.inner_friction = 0.3") != std::string::npos);
  CHECK(resumed.err.find("resume it with that version, or begin it anew") != std::string::npos);
}

TEST_CASE("an output that cannot be written is exit 4, and a broken pipe does not end a run") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  const auto shell = [&](const std::string& line) {
    return softgrain::test::run({"/bin/sh", "-c", line}, {{"SG", SOFTGRAIN_PROGRAM}},
                                directory.path().string());
  };
  const auto full = shell("$SG run small.toml -o a > /dev/full");
  CHECK(full.exit_code == 4);
  CHECK(full.err.find("cannot write to stdout") != std::string::npos);
  CHECK(state_of(directory.path() / "a") == "done");
  CHECK(shell("$SG info a > /dev/full").exit_code == 4);
  CHECK(shell("$SG run small.toml -o b 2> /dev/full > /dev/null").exit_code == 0);
  shell("$SG run small.toml -o c 2>&1 | true");
  CHECK(state_of(directory.path() / "c") == "done");
}

TEST_CASE("what cannot be run or read is the user's mistake, exit 2") {
  const TemporaryDirectory directory;
  directory.file("small.toml", small_case);
  CHECK(softgrain_run(directory, {"resume", "nowhere"}).exit_code == 2);
  CHECK(softgrain_run(directory, {"info", "nowhere"}).exit_code == 2);
  CHECK(softgrain_run(directory, {"info", "."}).exit_code == 2);
  CHECK(softgrain_run(directory, {"verify", "small.toml"}).exit_code == 2);
  CHECK(softgrain_run(directory, {"run", "small.toml", "-j", "0"}).exit_code == 2);
  CHECK(softgrain_run(directory, {"run", "small.toml", "--stop-after", "10 m"}).exit_code == 2);
  CHECK(softgrain_run(directory, {"run", "small.toml", "-o", "small.toml"}).exit_code == 2);
  CHECK_FALSE(fs::exists(directory.path() / "small_run"));
}
