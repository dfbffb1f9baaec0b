#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/format/snapshot.hpp"

namespace fs = std::filesystem;

namespace {

/// Does something with the snapshots of a model that an earlier version wrote; how many there are.
template <class Work>
int for_each_snapshot(const std::string& model, const Work& work) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(SOFTGRAIN_TEST_DATA) / "snapshots")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".h5" || name.find(model) == std::string::npos) continue;
    ++files;
    CAPTURE(name);
    const softgrain::Snapshot snapshot = softgrain::read_snapshot(entry.path());
    const auto simulation = softgrain::create_simulation(softgrain::parse_case(snapshot.case_text, name));
    work(snapshot, *simulation);
  }
  return files;
}

}  // namespace

TEST_CASE(
    "snapshots of a version with other arrays are refused, with the remedy, and can still be looked at") {
  const auto check = [](const softgrain::Snapshot& snapshot, softgrain::Simulation& simulation) {
    std::string message;
    try {
      simulation.restore(snapshot.checkpoint);
    } catch (const softgrain::IoError& error) {
      message = error.what();
    }
    CHECK(message.find("another version of softgrain") != std::string::npos);
    CHECK(message.find("--force") != std::string::npos);
    CHECK(snapshot.scene.particles.contains("position"));
    CHECK(snapshot.scene.wall_segments.size() >= 8);
  };
  CHECK(for_each_snapshot("bpm", check) == 2);
  CHECK(for_each_snapshot("mpm", check) == 2);
}
