#include <doctest/doctest.h>

#include "reliability/tiny_cases.hpp"

using namespace softgrain::test;

TEST_CASE("numbers that break down are code 3 with what broke, where, the remedy and an intact last state") {
  struct Breakdown {
    std::string base;
    Words settings;
    std::string where;
  };
  for (const auto& [base, settings, where] : std::vector<Breakdown>{
           {"compaction-mpm", {"mpm.integrator=\"explicit\"", "mpm.time_step=\"2 us\""}, "grain "},
           {"diametral-mpm",
            {"mpm.formulation=\"updated_lagrangian\"", "mpm.time_step=\"30 us\"", "contact.friction=0",
             "contact.wall_friction=0"},
            "grain "},
           {"diametral-bpm",
            {"loading.max_strain=2.9", "loading.unload_at=[]", "loading.wall_velocity=\"20 m/s\""},
            "overlap"},
       }) {
    const Workshop workshop;
    CAPTURE(base);
    TinyCase tiny{base, base, tiny_settings(base)};
    tiny.settings.insert(tiny.settings.end(), settings.begin(), settings.end());
    const ProcessResult result = run_tiny(workshop, tiny, "out");
    CAPTURE(result.err);
    CHECK(result.exit_code == 3);
    CHECK(result.err.find(where) != std::string::npos);
    CHECK(result.err.find("use a smaller ") != std::string::npos);
    CHECK(result.err.find("the last good state is out/snap/s") != std::string::npos);
    CHECK(workshop.intact("out"));
    CHECK(nlohmann::json::parse(read_text(workshop.path("out/run.json"))).at("state") == "failed");
  }
}
