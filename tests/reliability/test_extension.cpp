#include <doctest/doctest.h>

#include "reliability/tiny_cases.hpp"
#include "softgrain/io/format/snapshot.hpp"

using namespace softgrain::test;

namespace {

TinyCase ending_at(const std::string& name, const std::string& max_strain, const Words& more = {}) {
  TinyCase tiny{name, name, tiny_settings(name)};
  tiny.settings.push_back("loading.max_strain=" + max_strain);
  tiny.settings.insert(tiny.settings.end(), more.begin(), more.end());
  return tiny;
}

/// The last states of two runs, bit for bit. (Their reports may differ: the energy is measured where rows are
/// written, which are shares of the way to the end.)
bool same_states(const Workshop& workshop, const std::string& a, const std::string& b) {
  const auto state = [&](const std::string& run) {
    return softgrain::read_snapshot(workshop.snapshots(run).back()).checkpoint;
  };
  const auto first = state(a), second = state(b);
  if (first.step != second.step || first.arrays.size() != second.arrays.size()) return false;
  return std::all_of(first.arrays.begin(), first.arrays.end(), [&](const auto& named) {
    const auto other = second.arrays.find(named.first);
    return other != second.arrays.end() && other->second.values == named.second.values;
  });
}

}  // namespace

TEST_CASE("a run that was done goes further, and ends as the run that had the later end from the start") {
  struct Ends {
    const char *name, *first, *last;
  };
  // the first ends do not fall on whole steps of the way
  for (const Ends& ends : {Ends{"diametral-bpm", "0.0771", "0.1"}, Ends{"diametral-mpm", "0.0771", "0.1"},
                           Ends{"compaction-mpm", "0.2973", "0.32"}}) {
    CAPTURE(ends.name);
    const Workshop workshop;
    REQUIRE(run_tiny(workshop, ending_at(ends.name, ends.last), "whole").exit_code == 0);
    REQUIRE(run_tiny(workshop, ending_at(ends.name, ends.first), "parts").exit_code == 0);
    CHECK_FALSE(same_states(workshop, "parts", "whole"));
    const auto further = run_tiny(workshop, ending_at(ends.name, ends.last), "parts", {"--resume"});
    CHECK_MESSAGE(further.exit_code == 0, further.err);
    CHECK(same_states(workshop, "parts", "whole"));
    CHECK(read_text(workshop.path("parts/case.toml")) == read_text(workshop.path("whole/case.toml")));
    CHECK(workshop.intact("parts"));
    CHECK(workshop.softgrain({"info", "parts"}).out.find("parts: a run, done\n") != std::string::npos);
  }
}

TEST_CASE("a run that goes further can be stopped and resumed on the way") {
  const Workshop workshop;
  const std::string name = "diametral-bpm";
  REQUIRE(run_tiny(workshop, ending_at(name, "0.1"), "whole").exit_code == 0);
  REQUIRE(run_tiny(workshop, ending_at(name, "0.0771"), "parts").exit_code == 0);
  CHECK(run_tiny(workshop, ending_at(name, "0.1"), "parts", {"--resume", "--stop-after", "1 ms"}).exit_code ==
        75);
  CHECK(workshop.softgrain({"resume", "parts", "-q"}).exit_code == 0);
  CHECK(same_states(workshop, "parts", "whole"));
}

TEST_CASE("what is not the same case with a later end is refused, with the key") {
  const Workshop workshop;
  const std::string name = "diametral-mpm";
  REQUIRE(run_tiny(workshop, ending_at(name, "0.08"), "out").exit_code == 0);
  const std::string hash = workshop.last_hash("out");
  const auto refusal = [&](const std::string& max_strain, const Words& more) {
    const auto refused = run_tiny(workshop, ending_at(name, max_strain, more), "out", {"--resume"});
    CHECK(refused.exit_code == 2);
    return refused.err;
  };
  CHECK(refusal("0.07", {}).find("its end was further away") != std::string::npos);
  CHECK(refusal("0.1", {"mpm.poisson_ratio=0.3"}).find("mpm.poisson_ratio was 0.45, not 0.3") !=
        std::string::npos);
  CHECK(refusal("0.1", {"loading.max_stress=\"1 MPa\""}).find("its end was further away") !=
        std::string::npos);
  CHECK(workshop.last_hash("out") == hash);

  REQUIRE(run_tiny(workshop, ending_at(name, "0.08", {"loading.hold=\"1 ms\""}), "rested").exit_code == 0);
  const auto rested =
      run_tiny(workshop, ending_at(name, "0.1", {"loading.hold=\"1 ms\""}), "rested", {"--resume"});
  CHECK(rested.exit_code == 2);
  CHECK(rested.err.find("rests for loading.hold") != std::string::npos);
}
