#pragma once
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/subprocess.hpp"
#include "support/temporary_directory.hpp"

namespace softgrain::test {

using Words = std::vector<std::string>;

/// A temporary directory in which the program runs.
class Workshop {
 public:
  Process::Environment environment;

  std::filesystem::path path(const std::string& name) const { return directory_.path() / name; }
  std::string file(const std::string& name, const std::string& text) const {
    return directory_.file(name, text);
  }
  std::string here() const { return directory_.path().string(); }

  static Words command(const Words& words) {
    Words argv{SOFTGRAIN_PROGRAM};
    argv.insert(argv.end(), words.begin(), words.end());
    return argv;
  }
  ProcessResult softgrain(const Words& words) const { return run(command(words), environment, here()); }
  /// A line of sh, in which $SG is the program.
  ProcessResult shell(const std::string& line) const {
    auto with_program = environment;
    with_program["SG"] = SOFTGRAIN_PROGRAM;
    return run({"/bin/sh", "-c", line}, with_program, here());
  }

  /// The snapshots of a run, oldest first.
  std::vector<std::filesystem::path> snapshots(const std::string& run) const {
    std::vector<std::filesystem::path> found;
    if (!std::filesystem::exists(path(run) / "snap")) return found;
    for (const auto& entry : std::filesystem::directory_iterator(path(run) / "snap"))
      if (entry.path().extension() == ".h5") found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }
  /// The content hash of the newest snapshot: equal states have equal hashes.
  std::string last_hash(const std::string& run) const {
    const auto described = softgrain({"info", "--json", snapshots(run).back().string()});
    return nlohmann::json::parse(described.out).at("content_hash");
  }
  /// series.csv without its last column, the wall time.
  std::string series(const std::string& run) const {
    std::istringstream rows(read_text(path(run) / "series.csv"));
    std::string text;
    for (std::string line; std::getline(rows, line);) text += line.substr(0, line.rfind(',')) + "\n";
    return text;
  }
  bool intact(const std::string& run) const { return softgrain({"verify", run}).exit_code == 0; }

 private:
  TemporaryDirectory directory_;
};

/// Does `make torture` ask for the long form?
inline bool torture() { return std::getenv("SOFTGRAIN_TORTURE") != nullptr; }

/// How often a test repeats: in `make test`, and in `make torture`.
inline int repeats(int in_test, int in_torture) { return torture() ? in_torture : in_test; }

}  // namespace softgrain::test
