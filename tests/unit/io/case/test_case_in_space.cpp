#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/kinds.hpp"
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

TEST_CASE("in space a case has explicit steps and six cells where it leaves them out") {
  const Case c = parse_case(spheres, "case.toml");
  CHECK(is_in_space(c));
  CHECK(c.mpm.integrator == Integrator::symplectic_euler);
  CHECK(c.mpm.cells == 6);
  CHECK(resolved_case_text(parse_case(resolved_case_text(c), "resolved")) == resolved_case_text(c));
  CHECK(parse_case(spheres, "case.toml", {"mpm.cells=8"}).mpm.cells == 8);
  CHECK(!is_in_space(parse_case("", "case.toml")));
}

TEST_CASE("what is not there yet in space is refused, with the line and a remedy") {
  const std::vector<std::pair<std::string, std::string>> later{
      {"mpm.integrator=implicit", "ten times"},
      {"experiment.loading=biaxial", "write \"triaxial\""},
      {"contact.wall_surface_energy=0.1", "adhesion"},
      {"mpm.kinematic_modulus=1e5", "harden alone"},
      {"mpm.cells=30", "more than 24 mpm.cells"}};
  for (const auto& [set, words] : later) {
    std::vector<std::string> sets{set};
    if (set == "experiment.loading=biaxial")
      sets = {"experiment.loading=biaxial", "loading.confining_stress=1e5"};
    if (set == "mpm.kinematic_modulus=1e5")
      sets.insert(sets.end(), {"mpm.law=von_mises", "mpm.yield_stress=1e5"});
    const std::string message = refusal(spheres, sets);
    CAPTURE(set);
    CAPTURE(message);
    CHECK(mentions(message, "not yet with experiment.dimension = 3: "));
    CHECK(mentions(message, words));
  }
  CHECK(mentions(refusal(spheres, {"experiment.model=rigid", "grain.shape=polygon"}),
                 "not yet with experiment.dimension = 3: grains other than spheres"));
  CHECK(mentions(refusal("[experiment]\ndimension = 4\n"), "dimension"));
}

TEST_CASE(
    "bonded spheres attract each other with a force in newtons, and take no word of elastic ones amiss") {
  const std::vector<std::string> diametral{"experiment.model=bpm", "experiment.loading=diametral",
                                           "bpm.force=0.3 N", "mpm.integrator=implicit", "mpm.cells=40"};
  const Case c = parse_case("[experiment]\ndimension = 3\n", "case.toml", diametral);
  CHECK(is_bonded(c));
  CHECK(c.bpm.force == 0.3);
  CHECK(mentions(refusal("[experiment]\ndimension = 3\n", {"bpm.force=3 N/m"}), "force"));
  CHECK(mentions(refusal(spheres, {"experiment.model=bpm", "experiment.loading=biaxial",
                                   "loading.confining_stress=1e5"}),
                 "write \"triaxial\""));
}

TEST_CASE("spheres in space may be rigid, all of them or a kind") {
  CHECK(is_rigid(parse_case(spheres, "case.toml", {"experiment.model=rigid"})));
  const Case mixed = parse_case(
      spheres + "[[kind]]\nname = 'soft'\nshare = 1\n[[kind]]\nname = 'hard'\nmodel = 'rigid'\nshare = 1\n",
      "case.toml");
  CHECK(is_rigid(case_of_kind(mixed, 1)));
  CHECK(first_time_step(mixed) == first_time_step(case_of_kind(mixed, 0)));
}

TEST_CASE("a box of spheres is as high as its volume says, and its path ends where they fill the fraction") {
  Case c = parse_case(spheres, "case.toml",
                      {"sample.grains=10", "sample.smallest_diameter=2 mm", "sample.largest_diameter=2 mm",
                       "loading.max_packing_fraction=0.9", "loading.max_strain=2"});
  const double volume = 10 * 3.14159265358979 / 6 * 8e-9 / 0.5;
  CHECK(box_height(c) * box_height(c) * box_height(c) == doctest::Approx(volume));
  CHECK(last_strain(c) == doctest::Approx(std::log(0.9 / 0.5) / 3));
}

TEST_CASE("stages of a case in space speak of zz, yy and xx, and are written as they are read") {
  const std::string tables =
      "[experiment]\nmodel = 'mpm'\ndimension = 3\n[sample]\npacking_fraction = 0.5\n"
      "[[stage]]\nname = 'press'\nzz = { velocity = '1 m/s' }\nyy = { rate = '5 1/s' }\n"
      "until = { strain = 0.1, strain_yy = 0.2, stress_xx = '1 MPa', stress_top = '2 MPa' }\n"
      "[[stage]]\nxx = { stress = '1 MPa' }\ntop = { velocity = '-1 m/s' }\nuntil = { time = '1 ms' }\n";
  const Case c = parse_case(tables, "case.toml");
  REQUIRE(c.stages.size() == 2);
  const auto& [press, keep] = std::pair(c.stages[0], c.stages[1]);
  REQUIRE(press.drives.size() == 2);
  CHECK(axis_in<3>(press.drives[0].part) == 2);  // zz
  CHECK(press.drives[0].control == Control::velocity);
  CHECK(axis_in<3>(press.drives[1].part) == 1);  // yy
  CHECK(press.drives[1].control == Control::rate);
  CHECK(press.until.strain[0] == 0.1);
  CHECK(press.until.strain[1] == 0.2);
  CHECK(press.until.stress[number_of(Part::xy)] == 1e6);  // along x
  CHECK(press.until.stress[number_of(Part::top)] == 2e6);
  REQUIRE(keep.drives.size() == 2);
  CHECK(axis_in<3>(keep.drives[1].part) == 0);
  CHECK(keep.drives[1].control == Control::stress);
  CHECK(resolved_case_text(parse_case(resolved_case_text(c), "resolved")) == resolved_case_text(c));
}

TEST_CASE("what a box in space has not, and what a box in the plane has not, stages do not speak of") {
  const auto stage = [](const std::string& head, const std::string& what) {
    return head + "[[stage]]\n" + what + "\nuntil = { time = '1 ms' }\n";
  };
  const std::string solid = "[experiment]\nmodel = 'mpm'\ndimension = 3\n",
                    plane = "[experiment]\nmodel = 'mpm'\n";
  CHECK(mentions(refusal(stage(solid, "left = { velocity = '1 m/s' }")), "side walls move in pairs"));
  CHECK(mentions(refusal(stage(solid, "xy = { rate = '1 1/s' }")), "no cell shears yet"));
  CHECK(mentions(refusal(solid + "[[stage]]\nzz = { velocity = '1 m/s' }\nuntil = { strain_xy = 0.1 }\n"),
                 "no cell shears yet"));
  CHECK(mentions(refusal(stage(plane, "zz = { velocity = '1 m/s' }")), "in the plane yy is the vertical"));
  CHECK(mentions(refusal(stage(solid, "zz = { velocity = '1 m/s' }\ntop = { velocity = '1 m/s' }")),
                 "zz and top both move one wall"));
  CHECK(mentions(
      refusal(stage(solid, "xx = { stress = '1 MPa', stress_amplitude = '2 MPa', period = '1 ms' }")),
      "xx would pull the grains"));
  CHECK(
      mentions(refusal(plane + "loading = 'triaxial'\n[loading]\nconfining_stress = 1e5\n"), "\"biaxial\""));
  CHECK(mentions(refusal(plane + "loading = 'compaction'\n[box]\ngravity_z = -9.81\n"),
                 "box.gravity_y pulls down"));
}

TEST_CASE("several kinds of spheres fill a box by their volumes") {
  const std::string kinds =
      spheres +
      "grains = 30\n[[kind]]\nname = 'soft'\nshare = 1\ndiameter = '1 mm'\n[kind.law]\n"
      "young_modulus = '1 MPa'\n[[kind]]\nname = 'hard'\nshare = 1\ndiameter = '2 mm'\n";
  const Case c = parse_case(kinds, "case.toml");
  REQUIRE(c.kinds.size() == 2);
  CHECK(c.kinds[0].grains + c.kinds[1].grains == 30);
  CHECK(c.kinds[0].grains == 27);  // 8 to 1
}
