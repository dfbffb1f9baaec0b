
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/sample.hpp"
#include "support/simulations.hpp"

using namespace softgrain;
using test::advance;
using test::value_of;

namespace {

Case one_grain() {
  Case c;
  c.experiment = {.loading = LoadingPath::diametral, .model = GrainModel::mpm};
  c.mpm.cells = 4;
  c.mpm.formulation = Formulation::updated_lagrangian;
  c.contact.wall_friction = 0.2;
  c.loading.wall_velocity = 2;
  c.loading.max_strain = 0.1;
  c.loading.unload_at = {0.05};
  c.loading.unload_by = 0.01;
  return c;
}

Case box_of_grains() {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.sample.grains = 4;
  c.sample.packing_fraction = 0.6;
  c.mpm.cells = 3;
  c.mpm.formulation = Formulation::updated_lagrangian;
  c.contact.friction = 0.3;
  c.loading.wall_velocity = 20;
  c.loading.max_strain = 0.3;
  return c;
}

/// A grain above another, that far apart [m]; the lower one stands on the bottom, the top wall is as far from
/// the upper one as the grains are, the side walls touch none.
Case two_grains(double gap) {
  Case c = box_of_grains();
  c.box.width = 3e-3;
  c.box.height = 4e-3 + 2 * gap;
  c.sample.placed = {{.centre = {1.5e-3, 1e-3}, .radius = 1e-3},
                     {.centre = {1.5e-3, 3e-3 + gap}, .radius = 1e-3}};
  c.mpm.cells = 4;
  c.mpm.shape_functions = ShapeFunction::bilinear;
  c.loading.wall_velocity = 2;
  c.loading.max_strain = 0.05;
  return complete_sample(c);
}

}  // namespace

TEST_CASE("an updated-Lagrangian run that goes on from a checkpoint has the bits of one that never stopped") {
  using enum Integrator;
  for (const auto& [given, contact_on, integrator] :
       {std::tuple{one_grain(), ContactOn::outline, symplectic_euler},
        {one_grain(), ContactOn::grid_nodes, symplectic_euler},
        {box_of_grains(), ContactOn::outline, symplectic_euler},
        {box_of_grains(), ContactOn::grid_nodes, symplectic_euler},
        {one_grain(), ContactOn::outline, backward_euler},
        {box_of_grains(), ContactOn::grid_nodes, backward_euler}}) {
    CAPTURE(contact_on);
    CAPTURE(integrator);
    Case c = given;
    c.mpm.contact_on = contact_on;
    c.mpm.lattice_integrator = integrator;
    const auto whole = create_simulation(c);
    advance(*whole, whole->steps_planned() / 2);
    CHECK(value_of(test::next_row(*whole), "contacts") > 2);
    advance(*whole, 4);
    const Checkpoint half = whole->checkpoint();
    advance(*whole, 20);
    const auto resumed = create_simulation(c);
    resumed->restore(half);
    CHECK(resumed->steps_done() == half.step);
    advance(*resumed, 20);
    const Checkpoint a = whole->checkpoint(), b = resumed->checkpoint();
    CHECK(a.step == b.step);
    REQUIRE(a.arrays.size() == b.arrays.size());
    for (const auto& [name, array] : a.arrays) {
      CAPTURE(name);
      CHECK((array.values == b.arrays.at(name).values));
    }
    const auto row = test::next_row(*whole), resumed_row = test::next_row(*resumed);
    for (std::size_t k = 0; k < row.size(); ++k) CHECK(row[k].value == resumed_row[k].value);
  }
}

TEST_CASE("an updated-Lagrangian grain starts unstressed between the walls and gives back its work") {
  const auto simulation = create_simulation(one_grain());
  const auto start = test::next_row(*simulation);
  CHECK(value_of(start, "wall_height") == doctest::Approx(2 * 5e-3).epsilon(0.01));
  CHECK(value_of(start, "area_ratio") == doctest::Approx(1));
  CHECK(value_of(start, "elastic_energy") == doctest::Approx(0));
  int turns = 0;
  while (!simulation->finished()) {
    simulation->step();
    turns += simulation->at_turning_point() && !simulation->finished();
  }
  CHECK(turns == 2);
  CHECK(simulation->progress() == 1);
  const auto end = test::next_row(*simulation);
  CHECK(value_of(end, "strain") == doctest::Approx(0.1).epsilon(0.01));
  CHECK(value_of(end, "force_top") > 0);
  CHECK(value_of(end, "area_ratio") < 1);
  const double stored = value_of(end, "elastic_energy") + value_of(end, "kinetic_energy");
  CHECK(stored == doctest::Approx(value_of(end, "wall_work")).epsilon(0.2));
}

TEST_CASE("a lattice grain at rest between walls gains no energy, and its budget is accounted for") {
  for (const ShapeFunction shape : {ShapeFunction::bilinear, ShapeFunction::gimp, ShapeFunction::bspline})
    for (const ContactOn contact_on : {ContactOn::outline, ContactOn::grid_nodes}) {
      CAPTURE(shape);
      CAPTURE(contact_on);
      Case c = one_grain();
      c.mpm.shape_functions = shape;
      c.mpm.contact_on = contact_on;
      c.contact.wall_friction = 0;
      c.loading.unload_at = {};
      c.loading.hold = 1e-3;
      const auto simulation = create_simulation(c);
      double least = 1e300;
      while (!simulation->finished()) {
        advance(*simulation, 10);
        const auto row = test::next_row(*simulation);
        const auto value = [&](std::string_view name) { return value_of(row, name); };
        CHECK(std::abs(value("energy_error")) < 1e-9 * value("wall_work"));
        CHECK(value("dissipation") ==
              doctest::Approx(value("dissipation_contact") + value("dissipation_integration")).epsilon(1e-6));
        if (value("leg") != 1) continue;
        const double energy = value("kinetic_energy") + value("elastic_energy");
        CHECK(energy < 1.01 * least);
        least = std::min(least, energy);
      }
      CHECK(least > 1);
      // what contact took is no sum of a back and forth at rest
      const auto end = test::next_row(*simulation);
      CHECK(std::abs(value_of(end, "dissipation_contact")) < 0.1 * value_of(end, "wall_work"));
    }
}

TEST_CASE(
    "the updated-Lagrangian picture shows every point and the outline, under a pressure of both walls") {
  const auto simulation = create_simulation(one_grain());
  advance(*simulation, simulation->steps_planned() / 2);
  const Scene scene = simulation->scene();
  const auto& pressure = std::get<std::vector<double>>(scene.particles.at("pressure").values);
  const auto& J = std::get<std::vector<double>>(scene.particles.at("J").values);
  CHECK(pressure.size() > 150);
  CHECK(J.size() == pressure.size());
  double mean = 0;
  for (const double p : pressure) mean += p / static_cast<double>(pressure.size());
  CHECK(mean > 0);
  CHECK(std::get<std::vector<double>>(scene.outlines.at("position").values).size() == 2 * 8 * 4);
  CHECK(scene.wall_segments.size() == 8);
  // the top half is pushed down, the bottom half up
  const auto& x = std::get<std::vector<double>>(scene.outlines.at("position").values);
  const auto& force = std::get<std::vector<double>>(scene.outlines.at("force").values);
  double top = 0, bottom = 0;
  for (std::size_t k = 1; k < x.size(); k += 2) (x[k] > 0 ? top : bottom) += force[k];
  CHECK(top < 0);
  CHECK(bottom > 0);
}

TEST_CASE("two grains on a lattice bear the same force as the walls that press them, at every contact") {
  for (const ContactOn contact_on : {ContactOn::outline, ContactOn::grid_nodes}) {
    CAPTURE(contact_on);
    Case c = two_grains(0);
    c.mpm.contact_on = contact_on;
    c.loading.hold = 1e-3;
    c.mpm.damping = 5e3;
    const auto simulation = create_simulation(c);
    while (!simulation->finished()) simulation->step();
    double between = 0, below = 0;
    for (const ContactPoint& point : simulation->model().contacts()) {
      if (point.b >= 0) between += std::abs(point.force[1]);
      if (point.b == wall_index(0)) below += std::abs(point.force[1]);
      CHECK(point.position[1] < simulation->box().height() * 1.2);
    }
    const double pressed = value_of(test::next_row(*simulation), "stress_bottom") * 3e-3;
    CHECK(between > 0);
    CHECK(between == doctest::Approx(below).epsilon(0.05));
    CHECK(below == doctest::Approx(pressed).epsilon(0.05));
    CHECK(value_of(test::next_row(*simulation), "z") == 1);
  }
}

TEST_CASE("grains that meet on nodes push on each other before their outlines meet, others do not") {
  for (const ContactOn contact_on : {ContactOn::outline, ContactOn::grid_nodes}) {
    CAPTURE(contact_on);
    Case c = two_grains(1e-4);  // half a cell
    c.mpm.contact_on = contact_on;
    c.loading.max_strain = 0.02;
    const auto simulation = create_simulation(c);
    bool met = false;
    while (!simulation->finished()) {
      simulation->step();
      for (const ContactPoint& point : simulation->model().contacts()) met |= point.b >= 0;
    }
    CHECK(met == (contact_on == ContactOn::grid_nodes));
  }
}

TEST_CASE("an implicit lattice packing accounts for its energy, and gives it back but for what is lost") {
  Case c = box_of_grains();
  c.mpm.contact_on = ContactOn::grid_nodes;
  c.mpm.lattice_integrator = Integrator::backward_euler;
  c.loading.wall_velocity = 5;
  const auto simulation = create_simulation(c);
  while (!simulation->finished()) simulation->step();
  const auto row = test::next_row(*simulation);
  const auto value = [&](std::string_view name) { return value_of(row, name); };
  CHECK(value("strain") == doctest::Approx(0.3).epsilon(0.01));
  CHECK(value("wall_work") > 0);
  CHECK(std::abs(value("energy_error")) < 2e-3 * value("wall_work"));
  CHECK(value("dissipation_friction") >= 0);
  CHECK(value("iterations") >= 2);
  CHECK(value("z_with_walls") > 2);
}

TEST_CASE("four walls press grains on a lattice, and stages of one's own move them") {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::backward_euler}) {
    CAPTURE(integrator);
    Case c = box_of_grains();
    c.mpm.contact_on = ContactOn::grid_nodes;
    c.mpm.lattice_integrator = integrator;
    c.experiment.loading = LoadingPath::isotropic;
    c.loading.max_strain = 0.25;
    const auto simulation = create_simulation(c);
    while (!simulation->finished()) simulation->step();
    const auto row = test::next_row(*simulation);
    CHECK(value_of(row, "stress_bottom") > 0);
    CHECK(value_of(row, "stress_side") > 0);
    CHECK(value_of(row, "z_with_walls") > 2);
  }
}

TEST_CASE("the updated Lagrangian takes no cell that repeats, and no wall that keeps a stress") {
  Case c = box_of_grains();
  c.box.x = c.box.y = BoxEnd::periodic;
  CHECK_THROWS_AS(create_simulation(c), UsageError);
  c = box_of_grains();
  c.experiment.loading = LoadingPath::biaxial;
  c.loading.confining_stress = 1e5;
  c.loading.max_strain = 0.1;
  CHECK_THROWS_AS(create_simulation(c), UsageError);
}
