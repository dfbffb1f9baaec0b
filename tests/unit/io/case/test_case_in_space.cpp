#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/stages_of_case.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_refusal.hpp"

using namespace softgrain;
using test::mentions;
using test::refusal;

namespace {

const std::string spheres =
    "[experiment]\nloading = 'isotropic'\nmodel = 'mpm'\ndimension = 3\n[sample]\npacking_fraction = 0.5\n";

}  // namespace

TEST_CASE("in space a case has explicit steps, six cells and no page where it leaves them out") {
  const Case c = parse_case(spheres, "case.toml");
  CHECK(is_in_space(c));
  CHECK(c.mpm.integrator == Integrator::symplectic_euler);
  CHECK(c.mpm.cells == 6);
  CHECK(!c.output.report);
  CHECK(resolved_case_text(parse_case(resolved_case_text(c), "resolved")) == resolved_case_text(c));
  CHECK(parse_case(spheres, "case.toml", {"mpm.cells=8"}).mpm.cells == 8);
  CHECK(!is_in_space(parse_case("", "case.toml")));
}

TEST_CASE("what is not there yet in space is refused, with the line and a remedy") {
  const std::vector<std::pair<std::string, std::string>> later{
      {"experiment.model=bpm", "write experiment.model = \"mpm\""},
      {"mpm.integrator=implicit", "ten times"},
      {"experiment.loading=biaxial", "\"diametral\", \"compaction\", \"isotropic\" and \"relaxation\""},
      {"box.x=periodic", "a periodic box"},
      {"box.gravity_y=-9.81", "gravity"},
      {"output.report=true", "the page of a run"},
      {"contact.wall_surface_energy=0.1", "adhesion"},
      {"mpm.law=norton", "flows, creeps or relaxes"},
      {"mpm.cells=30", "more than 24 mpm.cells"}};
  for (const auto& [set, words] : later) {
    std::vector<std::string> sets{set};
    if (set == "experiment.loading=biaxial")
      sets = {"experiment.loading=biaxial", "loading.confining_stress=1e5"};
    if (set == "mpm.law=norton") sets = {"mpm.law=norton", "mpm.creep_rate=1", "mpm.creep_stress=1e5"};
    const std::string message = refusal(spheres, sets);
    CAPTURE(set);
    CAPTURE(message);
    CHECK(mentions(message, "not yet with experiment.dimension = 3: "));
    CHECK(mentions(message, words));
  }
  CHECK(mentions(
      refusal(spheres + "[[stage]]\nname = 'a'\nyy = { velocity = '1 m/s' }\nuntil = { strain = 0.1 }\n"),
      "not yet"));
  CHECK(mentions(refusal("[experiment]\ndimension = 4\n"), "dimension"));
}

TEST_CASE("a box of spheres is as high as its volume says, and its path ends where they fill the fraction") {
  Case c = parse_case(spheres, "case.toml",
                      {"sample.grains=10", "sample.smallest_diameter=2 mm", "sample.largest_diameter=2 mm",
                       "loading.max_packing_fraction=0.9", "loading.max_strain=2"});
  const double volume = 10 * 3.14159265358979 / 6 * 8e-9 / 0.5;
  CHECK(box_height(c) * box_height(c) * box_height(c) == doctest::Approx(volume));
  CHECK(last_strain(c) == doctest::Approx(std::log(0.9 / 0.5) / 3));
}
