#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_refusal.hpp"
#include "support/simulations.hpp"

using namespace softgrain;
using test::mentions;
using test::refusal;

namespace {

const std::string all_models = R"(
[experiment]
loading = "compaction"
[mpm]
integrator = "explicit"
cells = 4
[bpm]
primaries = 20
library = 1
[contact]
friction = 0.2
[sample]
packing_fraction = 0.5
[[kind]]
name = "dough"
model = "bpm"
number = 3
density = "900 kg/m^3"
diameter = "1.6 mm"
law.cohesive_pressure = "0.3 MPa"
[[kind]]
name = "rubber"
model = "mpm"
number = 2
density = "1000 kg/m^3"
diameter = "2 mm"
[[kind]]
name = "stone"
model = "rigid"
number = 2
density = "2500 kg/m^3"
diameter = "1 mm"
[[pair]]
between = ["dough", "rubber"]
friction = 0.5
)";

}  // namespace

TEST_CASE("grains of all three models are in one sample, in the order of their kinds") {
  const Case c = parse_case(all_models, "case.toml");
  CHECK(is_mixed(c));
  CHECK(is_elastic(c));
  CHECK(resolved_case_text(parse_case(resolved_case_text(c), "case.toml")) == resolved_case_text(c));
  CHECK(case_of_kind(c, 0).bpm.cohesive_pressure == 0.3e6);
  CHECK(case_of_kind(c, 0).bpm.primaries == 20);

  Simulation simulation = test::simulation_of(c);
  const Model& model = simulation.model();
  const std::vector<double> radii = model.radii();
  REQUIRE(radii.size() == 7);
  const double expected[] = {0.8e-3, 0.8e-3, 0.8e-3, 1e-3, 1e-3, 0.5e-3, 0.5e-3};
  const double density[] = {900, 900, 900, 1000, 1000, 2500, 2500};
  std::vector<double> mass(7, 0);
  const Bodies bodies = model.bodies();
  for (std::size_t i = 0; i < bodies.mass.size(); ++i) mass[bodies.grain[i]] += bodies.mass[i];
  for (std::size_t g = 0; g < 7; ++g) {
    CHECK(std::abs(radii[g] / expected[g] - 1) < 1e-12);
    CHECK(std::abs(mass[g] / (density[g] * std::numbers::pi * radii[g] * radii[g]) - 1) < 1e-9);
  }
  const Scene scene = simulation.scene();
  const auto integers = [&](const char* name) {
    return std::get<std::vector<std::int64_t>>(scene.particles.at(name).values);
  };
  const auto grain = integers("grain"), kind = integers("kind"), primary = integers("primary");
  for (std::size_t i = 0; i < grain.size(); ++i) {
    CHECK(kind[i] == (grain[i] < 3 ? 0 : grain[i] < 5 ? 1 : 2));
    CHECK(primary[i] == (kind[i] == 1 ? 0 : 1));
  }
  CHECK(estimate(c).particles == 2 * points_of_grain(case_of_kind(c, 1)) + 3 * 20 + 2);
}

TEST_CASE("what bonded grains among elastic ones cannot do yet is refused with what they can") {
  const auto refused = [](const std::vector<std::string>& sets, const std::string& message) {
    CAPTURE(message);
    CHECK(mentions(refusal(all_models, sets), "not yet: bonded grains among elastic ones " + message));
  };
  refused({"mpm.integrator=implicit"}, "with implicit steps");
  refused({"experiment.dimension=3"}, "in space");
  refused({"contact.surface_energy=0.1"}, "that adhere");
  refused({"contact.activation=closed_at_mid_step"}, "that rebound");
}
