#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "softgrain/experiment/sample.hpp"
#include "support/solid_simulations.hpp"

using namespace softgrain;

namespace {

constexpr double rate = 300;  // of the strain [1/s]

/// 24 spheres in a cell that repeats along all axes, in their places as a sample's file would give them.
Case periodic_spheres() {
  Case c = test::case_in_space(LoadingPath::stages);
  c.box = {.x = BoxEnd::periodic, .y = BoxEnd::periodic, .z = BoxEnd::periodic};
  c.contact.friction = 0.2;
  c.sample.grains = 24;
  c.sample.packing_fraction = 0.5;
  c.sample.smallest_diameter = 1.8e-3;
  c.sample.largest_diameter = 2.2e-3;
  const BoxSampleOf<3> sample = sample_solid_box(c);
  c.box.width = c.box.depth = sample.width;
  c.box.height = sample.height;
  for (const auto& grain : sample.grains) {
    c.sample.placed.push_back(
        {.centre = {grain.centre[0], grain.centre[1]}, .radius = grain.radius, .angle = 0});
    c.sample.placed_z.push_back(grain.centre[2]);
  }
  return complete_sample(c);
}

/// At the same rate along the axes of these parts, to a strain of zz.
Case compressed(Case c, const std::vector<Part>& parts, double strain) {
  Stage stage;
  for (const Part part : parts)
    stage.drives.push_back({.part = part, .control = Control::rate, .value = rate});
  stage.until.strain[0] = strain;
  c.stages = {stage};
  return c;
}

const std::vector<Part> all_axes{Part::yy, Part::xx, Part::xy};

/// All spheres moved by a vector, and back into the cell where they leave it.
Case translated(Case c, const Vec<3>& by) {
  const Vec<3> size{c.box.width, c.box.depth, c.box.height};
  for (std::size_t i = 0; i < c.sample.placed.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      double& place = k == 2 ? c.sample.placed_z[i] : c.sample.placed[i].centre[k];
      place += by[k];
      place -= size[k] * std::floor(place / size[k]);
    }
  return c;
}

/// sum m (v - L x_c), over sum m |L x_c|.
double peculiar_momentum(const SimulationOf<3>& simulation) {
  const BodiesOf<3> bodies = simulation.model().bodies();
  const std::vector<Vec<3>> centre = simulation.model().centres();
  const Mat<3> L = simulation.box().cell.gradient();
  Vec<3> sum;
  double scale = 0;
  for (std::size_t i = 0; i < bodies.mass.size(); ++i) {
    const Vec<3> carried = L * centre[static_cast<std::size_t>(bodies.grain[i])];
    sum += bodies.mass[i] * (bodies.velocity[i] - carried);
    scale += bodies.mass[i] * norm(carried);
  }
  return norm(sum) / scale;
}

Mat<3> stress_of(const SimulationOf<3>& simulation) { return simulation.observe().packing->stress; }

}  // namespace

TEST_CASE("spheres in a cell that is pressed along all axes keep their momentum, wherever the cell begins") {
  const Case c = compressed(periodic_spheres(), all_axes, 0.08);
  SimulationOf<3> simulation = test::solid_simulation_of(c);
  double momentum = 0;
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.steps_done() % 20 == 0) momentum = std::max(momentum, peculiar_momentum(simulation));
  }
  CHECK(simulation.box().length(0) == doctest::Approx(c.box.width * std::exp(-0.08)).epsilon(1e-9));
  CHECK(momentum < 1e-11);
  const Mat<3> stress = stress_of(simulation);
  CHECK(trace(stress) > 3e4);  // they touch
  SimulationOf<3> other = test::solid_simulation_of(translated(c, {1.1e-3, 2.3e-3, -0.7e-3}));
  while (!other.finished()) other.step();
  const Mat<3> apart = stress_of(other) - stress;
  CHECK(std::sqrt(contract(apart, apart)) < 1e-7 * trace(stress));
}

TEST_CASE("a cell pressed along z takes the work of its stress, and its other lengths stay") {
  const Case c = compressed(periodic_spheres(), {Part::yy}, 0.25);
  SimulationOf<3> simulation = test::solid_simulation_of(c);
  double work = 0;  // -sum of sigma : L V dt, with the stress of the motion
  while (!simulation.finished()) {
    simulation.step();
    const Box<3>& box = simulation.box();
    work -= contract(stress_of(simulation), box.cell.gradient()) * box.volume() * simulation.time_step();
  }
  const Observation end = simulation.observe();
  CHECK(end.height == doctest::Approx(c.box.height * std::exp(-0.25)).epsilon(1e-9));
  CHECK(simulation.box().length(0) == c.box.width);
  CHECK(end.energies.stored > 0);
  CHECK(std::abs(end.energies.error) < 1e-9 * work);
  CHECK(end.energies.wall_work == doctest::Approx(work).epsilon(0.02));
  const Mat<3> stress = end.packing->stress;
  CHECK(stress(2, 2) > 1.05 * stress(0, 0));
  CHECK(stress(2, 2) > 1.05 * stress(1, 1));
}

TEST_CASE("a cell in space keeps three different stresses, and the contacts inside bear them") {
  Case c = periodic_spheres();
  c.loading.wall_velocity = 1;
  c.mpm.damping = 5e3;
  const Vec<3> target{1e5, 1.5e5, 2e5};
  Stage press;
  for (const auto& [part, axis] : {std::pair(Part::yy, 2), std::pair(Part::xx, 1), std::pair(Part::xy, 0)})
    press.drives.push_back({.part = part, .control = Control::stress, .value = target[axis]});
  press.until.time = 4e-3;
  c.stages = {press};
  SimulationOf<3> simulation = test::solid_simulation_of(c);
  Vec<3> stress;
  int looks = 0;
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.time() < 2e-3 || simulation.steps_done() % 10 != 0) continue;
    ++looks;
    for (int axis = 0; axis < 3; ++axis) stress[axis] += stress_of(simulation)(axis, axis);
  }
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(std::abs(stress[axis] / looks / target[axis] - 1) < 0.02);
  }
  CHECK(simulation.box().length(2) / simulation.box().length(0) < 0.99 * c.box.height / c.box.width);
  CAPTURE(simulation.outcome().shortfall);
  CHECK(simulation.outcome().shortfall.empty());
  const Energies energies = simulation.energies();
  CHECK(std::abs(energies.error) < 1e-9 * energies.wall_work);
}
