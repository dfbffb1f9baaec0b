#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_refusal.hpp"

using namespace softgrain;
using test::mentions;
using test::refusal;

namespace {

/// Ten of 2 mm, of 1000 kg/m^3 and 1 MPa, in a box of 10 pi mm^2 / 0.5.
const std::string grains =
    "experiment.model = 'mpm'\ngrain.density = 1000\n"
    "mpm.young_modulus = 1e6\nsample = {grains = 10, packing_fraction = 0.5, smallest_diameter = '2 mm', "
    "largest_diameter = '2 mm'}\n";
const std::string elastic_box = "experiment.loading = 'compaction'\n" + grains;
const double height = std::sqrt(10 * 3.14159265358979 * 1e-6 / 0.5);

/// I/(d sqrt(rho/p)) [1/s]
double rate_at(double inertial_number, double pressure) {
  return inertial_number / (2e-3 * std::sqrt(1000 / pressure));
}

double velocity_in(const std::string& text) {
  return parse_case(elastic_box + text, "case.toml").loading.wall_velocity;
}

}  // namespace

TEST_CASE("a quasi-static speed has the inertial number of the case at the stress that it names") {
  const std::string slow = "loading.wall_velocity = 'quasi-static'\n";
  // without a stress a hundredth of Young's modulus
  CHECK(velocity_in(slow) == doctest::Approx(rate_at(1e-3, 1e4) * height));
  CHECK(velocity_in(slow + "loading.inertial_number = 1e-2\n") ==
        doctest::Approx(rate_at(1e-2, 1e4) * height));
  CHECK(velocity_in(slow + "loading.max_stress = '0.5 MPa'\n") ==
        doctest::Approx(rate_at(1e-3, 5e5) * height));
  CHECK(velocity_in("") == 0.2);

  // one grain of R = 5 mm between walls: v/(2 R) 2 R sqrt(rho/E)
  const Case grain = parse_case(
      "experiment.model = 'mpm'\ngrain.density = 1000\nmpm.young_modulus = 1e6\n" + slow, "case.toml");
  CHECK(grain.loading.wall_velocity == doctest::Approx(1e-3 * std::sqrt(1e6 / 1000)));
}

TEST_CASE("a quasi-static rate is that of a stage, or of a cell that shears, at the stress that is kept") {
  const Case stages = parse_case(grains + R"(
[[stage]]
yy = "quasi-static"
until = { stress_yy = "0.1 MPa" }
[[stage]]
yy = { stress = "0.2 MPa" }
until = { time = 1 }
)",
                                 "case.toml");
  CHECK(stages.stages[0].drives[0].control == Control::rate);
  CHECK(stages.stages[0].drives[0].value == doctest::Approx(rate_at(1e-3, 2e5)));
  CHECK(stages.loading.wall_velocity == doctest::Approx(rate_at(1e-3, 2e5) * height));

  const std::string sheared =
      "[experiment]\nmodel = 'mpm'\nloading = 'shear'\n[box]\nx = 'periodic'\n"
      "y = 'periodic'\n[grain]\ndensity = 1000\n[sample]\nsmallest_diameter = '2 mm'\n"
      "largest_diameter = '2 mm'\n[loading]\nconfining_stress = '0.1 MPa'\n";
  const double rate = rate_at(1e-3, 1e5);
  CHECK(parse_case(sheared, "case.toml").loading.shear_rate == doctest::Approx(rate));
  CHECK(parse_case(sheared + "shear_rate = 'quasi-static'\n", "case.toml").loading.shear_rate ==
        doctest::Approx(rate));
  CHECK(parse_case(sheared + "shear_rate = 3\n", "case.toml").loading.shear_rate == 3);
}

TEST_CASE("no speed is no quasi-static one, and a number that nothing is left to is told") {
  CHECK(mentions(refusal(elastic_box + "loading.wall_velocity = 0\n"),
                 "loading.wall_velocity = 0 is out of range: it must be > 0"));
  CHECK(mentions(refusal(grains + "[[stage]]\nyy = 'slow'\nuntil = { strain = 0.1 }\n"), "quasi-static"));
  const std::string rigid = refusal(
      "experiment.model = 'rigid'\nexperiment.loading = 'compaction'\n"
      "loading.wall_velocity = 'quasi-static'\n");
  CHECK(mentions(rigid, "3:9: error: \"quasi-static\" needs a stress"));
  CHECK(mentions(rigid, "1 error; nothing was run"));
  const CaseReading idle =
      parse_case_with_notes(elastic_box + "loading.inertial_number = 0.01\n", "case.toml");
  REQUIRE(idle.without_effect.size() == 1);
  CHECK(idle.without_effect[0] == "loading.inertial_number");
}
