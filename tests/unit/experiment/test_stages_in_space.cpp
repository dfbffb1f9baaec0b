#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/loading/loading.hpp"
#include "support/solid_simulations.hpp"

using namespace softgrain;

namespace {

/// Eight spheres of R = 1 mm on a simple cubic lattice, which touch each other and the walls.
Case eight_spheres() {
  Case c = test::case_in_space(LoadingPath::stages);
  constexpr double R = 1e-3;
  for (int k = 0; k < 8; ++k) {
    c.sample.placed.push_back(
        {.centre = {(k % 2 == 0 ? 1 : 3) * R, (k / 2 % 2 == 0 ? 1 : 3) * R}, .radius = R, .angle = 0});
    c.sample.placed_z.push_back((k < 4 ? 1 : 3) * R);
  }
  return c;
}

Drive keeps(Part part, double stress) { return {.part = part, .control = Control::stress, .value = stress}; }

}  // namespace

TEST_CASE("placed spheres say how large their box is, how full, and which diameters they have") {
  Case c = eight_spheres();
  c.sample.placed.pop_back();
  c.sample.placed_z.pop_back();
  for (double& z : c.sample.placed_z) z += 5e-3;  // the box follows them
  c = complete_sample(c);
  CHECK(c.sample.grains == 7);
  CHECK(c.box.width == doctest::Approx(4e-3));
  CHECK(c.box.depth == doctest::Approx(4e-3));
  CHECK(c.box.height == doctest::Approx(4e-3));
  CHECK(c.sample.packing_fraction == doctest::Approx(7 * 4 * std::numbers::pi / 3 / 64));
  CHECK(c.sample.largest_diameter == doctest::Approx(2e-3));
  const BoxSampleOf<3> sample = sample_solid_box(c);
  CHECK(sample.grains[6].centre[2] == doctest::Approx(3e-3));
  CHECK(!(sample.grains[0].angle == sample.grains[1].angle));
  CHECK(misplaced_grains(sample).empty());
  c.sample.placed_z[0] += 0.1e-3;
  CHECK(misplaced_grains(sample_solid_box(c)).size() == 1);  // into the one above
}

TEST_CASE("each pair of walls in space goes by its own velocity or rate, until the strain of its component") {
  Case c = eight_spheres();
  c.box.width = 6e-3, c.box.depth = 7e-3, c.box.height = 8e-3;  // no walls touch
  Stage stage{.drives = {{.part = Part::yy, .control = Control::velocity, .value = 0.5},
                         {.part = Part::xx, .control = Control::rate, .value = 50},
                         {.part = Part::xy, .control = Control::velocity, .value = -0.25}}};
  stage.until.strain[1] = 0.02;
  c.stages = {stage};
  SimulationOf<3> simulation = test::solid_simulation_of(complete_sample(c));
  while (!simulation.finished()) simulation.step();
  const Box<3>& box = simulation.box();
  CHECK(box.length(1) == doctest::Approx(7e-3 * std::exp(-0.02)).epsilon(1e-12));
  const double time = simulation.time();
  CHECK(time == doctest::Approx(0.02 / 50).epsilon(0.01));
  CHECK(box.length(2) == doctest::Approx(8e-3 - 0.5 * time).epsilon(1e-3));
  CHECK(box.length(0) == doctest::Approx(6e-3 + 0.25 * time).epsilon(1e-3));
  CHECK(box.low(0).point[0] == doctest::Approx(-0.125 * time).epsilon(1e-3));  // half by each
}

TEST_CASE("walls in space keep three stresses, and the contacts inside bear the same") {
  Case c = eight_spheres();
  c.loading.wall_velocity = 1;
  c.mpm.damping = 5e3;
  const Vec<3> target{1e5, 1.5e5, 2e5};
  Stage press{.drives = {keeps(Part::yy, target[2]), keeps(Part::xx, target[1]), keeps(Part::xy, target[0])},
              .until = {.time = 4e-3}};
  c.stages = {press};
  SimulationOf<3> simulation = test::solid_simulation_of(complete_sample(c));
  Vec<3> stress;
  int steps = 0;
  SimulationOf<3> resumed = test::solid_simulation_of(complete_sample(c));
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.steps_done() == 1000) resumed.restore(simulation.checkpoint());
    if (simulation.time() < 3e-3) continue;
    ++steps;
    const Box<3>& box = simulation.box();
    for (int axis = 0; axis < 3; ++axis) {
      const auto face = 2 * static_cast<std::size_t>(2 - axis);
      stress[axis] += (box.outward_impulse(face) + box.outward_impulse(face + 1)) / 2 /
                      (simulation.time_step() * box.face(axis));
    }
  }
  const Observation end = simulation.observe();
  REQUIRE(end.packing.has_value());
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(stress[axis] / steps == doctest::Approx(target[axis]).epsilon(0.01));
    CHECK(end.packing->stress(axis, axis) == doctest::Approx(target[axis]).epsilon(0.02));
  }
  CHECK(simulation.outcome().completed);
  while (!resumed.finished()) resumed.step();
  const Arrays there = resumed.checkpoint().arrays, here = simulation.checkpoint().arrays;
  CHECK(std::equal(there.begin(), there.end(), here.begin(), here.end(), [](const auto& a, const auto& b) {
    return a.first == b.first && a.second.values == b.second.values;
  }));
  CHECK(std::abs(end.energies.error) < 1e-9 * end.energies.wall_work);
}

TEST_CASE("a sphere that nothing holds falls along z, and gravity's work is what its motion has") {
  constexpr double g = 9.81;
  Case c = test::case_in_space(LoadingPath::stages);
  c.sample.placed = {{.centre = {5e-3, 5e-3}, .radius = 1e-3, .angle = 0}};
  c.sample.placed_z = {8e-3};
  c.box.width = c.box.depth = c.box.height = 10e-3;
  c.box.gravity_z = -g;
  c.box.gravity_x = 0.5 * g;
  c.stages = {{.until = {.time = 5e-4}}};
  SimulationOf<3> simulation = test::solid_simulation_of(complete_sample(c));
  const Vec<3> start = simulation.model().centres()[0];
  while (!simulation.finished()) simulation.step();
  const double t = simulation.time();
  const Vec<3> way = simulation.model().centres()[0] - start;
  CHECK(way[2] == doctest::Approx(-g * t * t / 2).epsilon(0.01));
  CHECK(way[0] == doctest::Approx(g * t * t / 4).epsilon(0.01));
  CHECK(std::abs(way[1]) < 1e-3 * std::abs(way[2]));
  const Observation now = simulation.observe();
  CHECK(*now.number("gravity_work") == doctest::Approx(now.energies.kinetic).epsilon(1e-9));
}

TEST_CASE("a triaxial path in space keeps the stress of four side walls while the others come in") {
  Case c = test::case_in_space(LoadingPath::triaxial);
  c.sample.grains = 8;
  c.loading.confining_stress = 1e5;
  c.loading.max_strain = 0.3;
  const std::vector<Stage> stages = stages_of(c);
  REQUIRE(stages.size() == 2);
  CHECK(stages[0].drives ==
        std::vector<Drive>{{.part = Part::all, .control = Control::velocity, .value = 1}});
  REQUIRE(stages[1].drives.size() == 3);
  CHECK(stages[1].drives[0] == Drive{.part = Part::yy, .control = Control::velocity, .value = 1});
  for (const std::size_t side : {1U, 2U}) {
    CHECK(stages[1].drives[side].control == Control::stress);
    CHECK(stages[1].drives[side].value == 1e5);
  }
  CHECK(name_of(stages[1].drives[1].part, 3) == "yy");
  CHECK(name_of(stages[1].drives[2].part, 3) == "xx");
}
