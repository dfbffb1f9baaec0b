#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

const std::string bonded = R"(
[experiment]
loading = 'compaction'
model = 'bpm'
[bpm]
primaries = 20
library = 1
exponent = 6
[sample]
packing_fraction = 0.5
[contact]
friction = 0.1
[[kind]]
name = "soft"
number = 3
density = "1000 kg/m^3"
diameter = "2 mm"
law = { cohesive_pressure = "0.1 MPa", inner_friction = 0.2 }
[[kind]]
name = "hard"
number = 2
diameter = "1.5 mm"
primaries = 40
law = { cohesive_pressure = "0.4 MPa", exponent = 8 }
[[pair]]
between = ["soft", "hard"]
friction = 0.5
surface_energy = "2 J/m^2"
[[pair]]
between = ["hard", "wall"]
surface_energy = "3 J/m^2"
adhesion_range = "20 um"
)";

}  // namespace

TEST_CASE("bonded grains of several kinds have their bonds, densities and pairs") {
  const Case c = parse_case(bonded, "case.toml");
  REQUIRE(c.kinds.size() == 2);
  CHECK(case_of_kind(c, 0).bpm.primaries == 20);
  CHECK(case_of_kind(c, 0).bpm.exponent == 6);
  CHECK(case_of_kind(c, 0).bpm.inner_friction == 0.2);
  CHECK(case_of_kind(c, 1).bpm.primaries == 40);
  CHECK(case_of_kind(c, 1).bpm.exponent == 8);
  CHECK(case_of_kind(c, 1).bpm.cohesive_pressure == 4e5);
  CHECK(estimate(c).particles == 3 * 20 + 2 * 40);
  const std::string resolved = resolved_case_text(c);
  CHECK(resolved_case_text(parse_case(resolved, "case.toml")) == resolved);

  const Simulation simulation = test::simulation_of(c);
  const RigidDynamics<2>& dynamics = test::bonded(simulation);
  const RigidParticles<2>& p = dynamics.particles;
  REQUIRE(p.size() == 3 * 20 + 2 * 40);
  std::vector<int> count(5, 0);
  for (const int grain : p.grain) ++count[grain];
  CHECK(std::count(count.begin(), count.end(), 20) == 3);
  for (int c_pair = 0; c_pair < dynamics.contacts.size(); ++c_pair) {
    const int a = dynamics.contacts.body_a[c_pair], b = dynamics.contacts.body_b[c_pair];
    const bool soft_a = count[p.grain[a]] == 20;
    if (b >= p.size()) {
      CHECK(dynamics.contacts.friction[c_pair] == 0);
      continue;
    }
    const bool soft_b = count[p.grain[b]] == 20;
    CHECK(dynamics.contacts.friction[c_pair] == (p.grain[a] == p.grain[b] ? (soft_a ? 0.2 : 0)
                                                 : soft_a == soft_b       ? 0.1
                                                                          : 0.5));
  }
}
