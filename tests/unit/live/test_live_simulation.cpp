#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "live_case.hpp"
#include "live_simulation.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "softgrain/observe/columns.hpp"
#include "softgrain/observe/outlines.hpp"
#include "softgrain/observe/stress.hpp"

using namespace softgrain;

namespace {

/// As viewer/live/src/case.ts writes them.
const std::string elastic = R"(# a comment
[experiment]
loading = "compaction"
model = "mpm"

[mpm]
law = "mooney_rivlin"
c01 = 5e4  # Pa
young_modulus = 1e6  # Pa
poisson_ratio = 0.41
cells = 4

[contact]
friction = 0.35
wall_friction = 0

[time]
step = 0.000015  # s

[sample]
grains = 7
packing_fraction = 0.7
seed = 12

[loading]
wall_velocity = 3.2  # m/s
max_strain = 0.44
)";

std::string with(std::string text, const std::string& old, const std::string& now) {
  return text.replace(text.find(old), old.size(), now);
}

const std::string bonded =
    with(with(with(elastic, "\"mpm\"", "\"bpm\""),
              elastic.substr(elastic.find("[mpm]"), elastic.find("[contact]") - elastic.find("[mpm]")),
              "[bpm]\nprimaries = 30\nlibrary = 2\n"),
         "step = 0.000015", "step = 0.000001");

double number(const LivePicture& picture, const std::string& name) {
  const auto& names = live_numbers();
  return picture.numbers.at(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

TEST_CASE("the live page makes the case of its text that the program makes") {
  const std::string plastic = with(with(elastic, "mooney_rivlin", "von_mises"), "c01 = 5e4",
                                   "yield_stress = 5e4\nhardening_modulus = 1e5");
  for (const std::string& text : {elastic, plastic, bonded})
    CHECK(resolved_case_text(live_case(text)) == resolved_case_text(parse_case(text, "case.toml")));
}

TEST_CASE("the live page names the line of what it cannot read") {
  CHECK_THROWS_WITH_AS(live_case(with(elastic, "friction", "fiction")),
                       "line 14: the page knows no key 'contact.fiction'", UsageError);
  CHECK_THROWS_AS(live_case(with(elastic, "0.41", "much")), UsageError);
  CHECK_THROWS_AS(live_case(with(elastic, "\"mpm\"", "\"dem\"")), UsageError);
  CHECK_THROWS_AS(live_case("friction"), UsageError);
}

TEST_CASE("a top wall that a hand drives down all the way gives the bits of the loading of the case") {
  for (const std::string& text : {elastic, bonded}) {
    const auto simulation = create_simulation(parse_case(text, "case.toml"));
    LiveSimulation live(live_case(text));
    live.drive_to(0);
    for (int k = 0; k < 30; ++k) {
      simulation->step();
      live.step();
    }
    const LivePicture& picture = live.picture();
    for (const Quantity& quantity : row_of(simulation->observe()))
      for (const char* name : {"strain", "wall_height", "phi", "z", "kinetic_energy", "stress_top"})
        if (quantity.name == name) CHECK(number(picture, name) == quantity.value);
  }
}

TEST_CASE("the top wall of a live simulation stops where the hand is, and goes back") {
  LiveSimulation live(live_case(elastic));
  const double height = live.start_height(), way = 3.2 * 15e-6;
  const auto go = [&](double to) {
    live.drive_to(to);
    for (int k = 0; k < 5; ++k) live.step();
    return number(live.picture(), "wall_height");
  };
  CHECK(go(height - 2.5 * way) == doctest::Approx(height - 2.5 * way).epsilon(1e-14));
  CHECK(go(0) == doctest::Approx(height - 7.5 * way).epsilon(1e-14));
  CHECK(go(height) == doctest::Approx(height - 2.5 * way).epsilon(1e-14));
}

// sum_g A_g p_g = 1/2 sum_c f_c . l_c: what the grains bear is the trace of the stress of Love and Weber
TEST_CASE("the pressures that the live page colours grains by add up to the stress of the packing") {
  for (const std::string& text : {elastic, bonded}) {
    LiveSimulation live(live_case(text));
    const auto simulation = create_simulation(live_case(text));
    live.drive_to(0);
    const int steps = text == bonded ? 300 : 30;
    for (int k = 0; k < steps; ++k) {
      live.step();
      simulation->step();
    }
    const LivePicture& picture = live.picture();
    const Outlines outlines = simulation->model().outlines();
    double sum = 0;
    for (std::size_t g = 0; g + 1 < outlines.begin.size(); ++g) {
      const std::vector<Vec<2>> own(outlines.vertex.begin() + outlines.begin[g],
                                    outlines.vertex.begin() + outlines.begin[g + 1]);
      sum += picture.pressure[g] * total_area(own, std::array{0, static_cast<int>(own.size())});
    }
    const Mat<2> stress = contact_stress(simulation->model().contacts(), simulation->model().centres(),
                                         simulation->box().volume());
    const double expected = (stress(0, 0) + stress(1, 1)) / 2 * simulation->box().volume();
    CHECK(std::abs(expected) > 0);
    CHECK(sum == doctest::Approx(expected).epsilon(1e-4));
  }
}
