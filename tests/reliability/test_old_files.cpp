#include <doctest/doctest.h>

#include "softgrain/experiment/create.hpp"
#include "softgrain/io/case_file.hpp"
#include "softgrain/io/snapshot.hpp"

namespace fs = std::filesystem;

TEST_CASE("snapshots of earlier versions load, and their runs go on") {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(SOFTGRAIN_TEST_DATA) / "snapshots")) {
    if (entry.path().extension() != ".h5") continue;
    ++files;
    const std::string name = entry.path().filename().string();
    CAPTURE(name);
    const softgrain::Snapshot snapshot = softgrain::read_snapshot(entry.path());
    const auto simulation = softgrain::create_simulation(softgrain::parse_case(snapshot.case_text, name));
    simulation->restore(snapshot.checkpoint);
    CHECK(simulation->steps_done() == snapshot.checkpoint.step);
    CHECK(simulation->time() == snapshot.checkpoint.time);
    const softgrain::Checkpoint again = simulation->checkpoint();  // may say more than the old one did
    for (const auto& array : snapshot.checkpoint.arrays) CHECK(again.arrays.contains(array.first));
    simulation->step();
    CHECK(simulation->steps_done() == snapshot.checkpoint.step + 1);
  }
  CHECK(files == 4);
}
