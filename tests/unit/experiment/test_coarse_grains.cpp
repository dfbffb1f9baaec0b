#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

Case packing(int cells, Integrator integrator, int grains = 100) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.mpm.cells = cells;
  c.mpm.integrator = integrator;
  c.sample.grains = grains;
  c.sample.packing_fraction = 0.7;
  c.loading = {.wall_velocity = 1e-3, .max_strain = 0.01, .unload_at = {}};
  return c;
}

/// No contact carries and no energy is there, over E R^2; areas are those of the case.
void check_at_rest(const Case& c, Simulation& simulation) {
  const auto row = test::next_row(simulation);
  const double R = c.sample.largest_diameter / 2, unit = c.mpm.material.young_modulus * R * R;
  CHECK(test::value_of(row, "contacts") == 0);
  CHECK(std::abs(test::value_of(row, "elastic_energy")) < 1e-12 * unit);
  CHECK(std::abs(test::value_of(row, "dissipation_contact")) < 1e-12 * unit);
  CHECK(test::value_of(row, "kinetic_energy") < 1e-12 * unit);
  CHECK(test::value_of(row, "phi") == doctest::Approx(c.sample.packing_fraction).epsilon(1e-5));
  CHECK(test::value_of(row, "area_ratio") == doctest::Approx(1).epsilon(1e-9));
}

}  // namespace

TEST_CASE("grains of few cells start without overlap and store nothing at once") {
  for (const int cells : {2, 3, 4, 5, 6})
    for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler}) {
      CAPTURE(cells);
      CAPTURE(integrator);
      Case c = packing(cells, integrator);
      c.time.step = 4e-8;  // the top wall moves by nothing
      const auto simulation = create_simulation(c);
      check_at_rest(c, *simulation);
      simulation->step();
      check_at_rest(c, *simulation);
    }
}

TEST_CASE("an explicit start of grains of two cells does not depend on the step") {
  for (const double step : {9e-8, 4e-8, 1e-8}) {
    CAPTURE(step);
    Case c = packing(2, Integrator::symplectic_euler, 300);
    c.time.step = step;
    const auto simulation = create_simulation(c);
    for (int k = 0; k < 20; ++k) simulation->step();
    check_at_rest(c, *simulation);
  }
}

TEST_CASE("grains of two cells take no more Newton iterations at the start than grains of three") {
  const auto iterations = [](int cells) {
    Case c = packing(cells, Integrator::backward_euler, 300);
    c.loading.wall_velocity = 5;
    const auto simulation = create_simulation(c);
    int sum = 0;
    for (int k = 0; k < 5; ++k) {
      simulation->step();
      sum += static_cast<int>(test::value_of(test::next_row(*simulation), "iterations"));
    }
    return sum;
  };
  CHECK(iterations(2) <= iterations(3));
}

TEST_CASE("a grain of any number of cells starts between walls that only touch it") {
  for (const int cells : {2, 3, 4, 5, 8})
    for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler}) {
      CAPTURE(cells);
      CAPTURE(integrator);
      Case c;
      c.experiment = {.loading = LoadingPath::diametral, .model = GrainModel::mpm};
      c.mpm.cells = cells;
      c.mpm.integrator = integrator;
      c.time.step = 1e-7;
      c.loading = {.wall_velocity = 2e-5, .max_strain = 1e-3, .unload_at = {}};
      const auto simulation = create_simulation(c);
      CHECK(test::value_of(test::next_row(*simulation), "wall_height") ==
            doctest::Approx(2 * c.grain.radius));
      CHECK(test::value_of(test::next_row(*simulation), "area_ratio") == doctest::Approx(1));
      simulation->step();
      const auto row = test::next_row(*simulation);
      const double unit = c.mpm.material.young_modulus * c.grain.radius * c.grain.radius;
      CHECK(std::abs(test::value_of(row, "elastic_energy")) < 1e-12 * unit);
      CHECK(test::value_of(row, "kinetic_energy") < 1e-12 * unit);
    }
}
