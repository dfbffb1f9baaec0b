#include <doctest/doctest.h>

#include <random>

#include "reliability/tiny_cases.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/io/format/snapshot.hpp"

namespace fs = std::filesystem;
using namespace softgrain::test;

namespace {

bool refused(const std::string& bytes) {
  try {
    softgrain::decode_snapshot(bytes, "snapshot");
    return false;
  } catch (const softgrain::IoError&) {
    return true;
  }
}

}  // namespace

TEST_CASE("no flipped bit, truncation or mutation of a real snapshot is accepted") {
  for (const std::string name : {"diametral-bpm", "compaction-mpm"}) {
    const Workshop workshop;
    REQUIRE(run_tiny(workshop, {name, name, tiny_settings(name)}, "out").exit_code == 0);
    const std::string bytes = read_text(workshop.snapshots("out").back());
    REQUIRE_FALSE(refused(bytes));
    std::mt19937 random(5);
    int accepted = 0;
    for (int trial = 0; trial < 800; ++trial) {
      std::string damaged = bytes;
      damaged[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      accepted += refused(damaged) ? 0 : 1;
    }
    for (int trial = 0; trial < 200; ++trial)
      accepted += refused(bytes.substr(0, random() % bytes.size())) ? 0 : 1;
    for (int trial = 0; trial < 2500; ++trial) {  // a piece overwritten, removed, or put in twice
      std::string damaged = bytes;
      const std::size_t length = 1 + random() % 256, at = random() % (bytes.size() - length);
      if (trial % 3 == 0)
        for (std::size_t k = 0; k < length; ++k) damaged[at + k] ^= static_cast<char>(1 + random() % 255);
      if (trial % 3 == 1) damaged.erase(at, length);
      if (trial % 3 == 2) damaged.insert(at, bytes.substr(at, length));
      accepted += refused(damaged) ? 0 : 1;
    }
    CHECK(accepted == 0);
  }
}

TEST_CASE("resume falls back to the newest snapshot that is good, says why, and ends the same") {
  const Workshop workshop;
  const TinyCase tiny{"fall", "diametral-mpm", tiny_settings("diametral-mpm")};
  REQUIRE(run_tiny(workshop, tiny, "whole").exit_code == 0);
  fs::copy(workshop.path("whole"), workshop.path("bad"), fs::copy_options::recursive);
  const auto snapshots = workshop.snapshots("bad");
  fs::resize_file(snapshots[8], fs::file_size(snapshots[8]) / 2);
  fs::resize_file(snapshots[7], 0);
  std::string bytes = read_text(snapshots[6]);
  bytes[bytes.size() / 2] ^= 1;
  workshop.file(fs::relative(snapshots[6], workshop.here()).string(), bytes);
  fs::remove(snapshots[5]);
  fs::create_directory(snapshots[5]);  // not even a file
  const ProcessResult verified = workshop.softgrain({"verify", "bad"});
  CHECK(verified.exit_code == 4);
  CHECK(verified.err.find("4 of 9 snapshots are bad") != std::string::npos);
  const ProcessResult resumed = workshop.softgrain({"resume", "bad"});
  CAPTURE(resumed.err);
  CHECK(resumed.exit_code == 0);
  for (int k : {5, 6, 7, 8})
    CHECK(resumed.err.find("skipped a snapshot: bad/snap/" + snapshots[k].filename().string()) !=
          std::string::npos);
  CHECK(resumed.err.find("a damaged one: the hash at its end is wrong") != std::string::npos);
  CHECK(workshop.last_hash("bad") == workshop.last_hash("whole"));
  const bool same_series = workshop.series("bad") == workshop.series("whole");
  CHECK(same_series);
}
