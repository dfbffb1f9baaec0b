
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "support/simulations.hpp"

using namespace softgrain;
using test::advance;
using test::value_of;

namespace {

Case small_packing(Integrator integrator) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.grain.density = 990;
  c.mpm.cells = 3;
  c.mpm.integrator = integrator;
  c.contact.friction = 0.3;
  c.sample.grains = 5;
  c.sample.packing_fraction = 0.6;
  c.loading = {.wall_velocity = 5, .max_strain = 0.35, .unload_at = {}};
  return c;
}

Case one_grain() {
  Case c;
  c.experiment = {.loading = LoadingPath::diametral, .model = GrainModel::mpm};
  c.mpm.cells = 4;
  c.loading = {.wall_velocity = 0.2, .max_strain = 0.1, .unload_at = {0.05}, .unload_by = 0.01};
  return c;
}

}  // namespace

TEST_CASE("a packing that goes on from a checkpoint has the bits of one that never stopped") {
  for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler}) {
    CAPTURE(integrator);
    const Case c = small_packing(integrator);
    const auto whole = create_simulation(c);
    advance(*whole, 2 * whole->steps_planned() / 3);  // well in contact
    CHECK(value_of(test::next_row(*whole), "contacts") > 4);
    advance(*whole, 4);
    const Checkpoint half = whole->checkpoint();
    advance(*whole, 4);
    const auto resumed = create_simulation(c);
    resumed->restore(half);
    CHECK(resumed->steps_done() == half.step);
    advance(*resumed, 4);
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

TEST_CASE(
    "no grain is loaded by its own placement: energy 0 at the start, for every law, loading and integrator") {
  for (const LawChoice& law : law_choices())
    for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler})
      for (const LoadingPath loading :
           {LoadingPath::diametral, LoadingPath::compaction, LoadingPath::isotropic}) {
        CAPTURE(law.name);
        CAPTURE(integrator);
        CAPTURE(loading);
        Case c = small_packing(integrator);
        c.experiment.loading = loading;
        c.mpm.law = law.law;
        c.mpm.material.yield_stress = c.mpm.material.creep_stress = 1e5;  // of what flows
        c.mpm.material.creep_rate = c.mpm.material.relaxation_time_1 = 1;
        c.mpm.material.relaxation_share_1 = 0.4;
        const auto row = row_of(create_simulation(c)->observe());
        const double unit = c.mpm.material.young_modulus * c.grain.radius * c.grain.radius;
        CHECK(std::abs(value_of(row, "elastic_energy")) < 1e-12 * unit);
        CHECK(value_of(row, "least_J") == doctest::Approx(1).epsilon(1e-12));
      }
}

TEST_CASE("a packing keeps its grains' mass, and its top wall ends at the strain asked for") {
  const auto simulation = create_simulation(small_packing(Integrator::backward_euler));
  const auto start = test::next_row(*simulation);
  CHECK(value_of(start, "phi_0") == doctest::Approx(0.6));
  CHECK(value_of(start, "phi") == doctest::Approx(0.6));
  CHECK(value_of(start, "area_ratio") == doctest::Approx(1));
  CHECK(value_of(start, "least_J") == doctest::Approx(1));
  CHECK(value_of(start, "z") == 0);
  advance(*simulation, 1000000);
  const auto end = test::next_row(*simulation);
  CHECK(value_of(end, "strain") == doctest::Approx(0.35).epsilon(0.02));
  CHECK(value_of(end, "phi_0") == doctest::Approx(0.6 * std::exp(value_of(end, "strain"))));
  CHECK(value_of(end, "phi") == doctest::Approx(value_of(end, "phi_0") * value_of(end, "area_ratio")));
  CHECK(value_of(end, "area_ratio") < 1);
  CHECK(simulation->progress() == 1);
  // what the top wall's work does not find in motion and strain has been dissipated: by friction, by damping
  CHECK(value_of(end, "dissipation") > 0);
  CHECK(value_of(end, "dissipation") < value_of(end, "wall_work"));
}

TEST_CASE("the coordination number of a packing is that of the pairs that carry impulse") {
  const auto simulation = create_simulation(small_packing(Integrator::backward_euler));
  advance(*simulation, 1000000);
  const Checkpoint state = simulation->checkpoint();
  const auto& bodies = std::get<std::vector<std::int64_t>>(state.arrays.at("contact_bodies").values);
  const auto& impulse = std::get<std::vector<double>>(state.arrays.at("contact_impulse").values);
  bool touch[5][5] = {};
  for (std::size_t c = 0; c < bodies.size() / 6; ++c)
    if (bodies[6 * c + 1] < 0 && impulse[2 * c] > 0)  // 12 outline vertices a grain
      touch[bodies[6 * c] / 12][bodies[6 * c + 2] / 12] = touch[bodies[6 * c + 2] / 12][bodies[6 * c] / 12] =
          true;
  int sides = 0;
  for (const auto& row : touch)
    for (const bool t : row) sides += t;
  CHECK(sides > 0);
  CHECK(value_of(test::next_row(*simulation), "z") == doctest::Approx(sides / 5.0));
}

TEST_CASE("the mean overlap of elastic contacts is measured, and never above the worst") {
  for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler}) {
    CAPTURE(integrator);
    Case c = small_packing(integrator);
    c.mpm.tolerance = 1e-3;  // deep enough to be seen
    const auto simulation = create_simulation(c);
    double mean = 0, worst = 0;
    while (!simulation->finished()) {
      const StepReport report = simulation->step();
      CHECK(report.overlap_mean <= report.overlap_max);
      mean = std::max(mean, report.overlap_mean);
      worst = std::max(worst, report.overlap_max);
    }
    CHECK(mean > 1e-3 * worst);
    CHECK(worst > 0);
  }
}

TEST_CASE("one grain between walls starts at rest between them, and turns back where asked") {
  const auto simulation = create_simulation(one_grain());
  const auto start = test::next_row(*simulation);
  CHECK(value_of(start, "wall_height") == doctest::Approx(2 * 5e-3));
  CHECK(value_of(start, "force_top") == 0);
  int turns = 0;
  while (!simulation->finished()) {
    simulation->step();
    turns += simulation->at_turning_point();
  }
  CHECK(turns == 2);
  const auto end = test::next_row(*simulation);
  CHECK(value_of(end, "force_top") > 0);
}

TEST_CASE("a scene has a disk of its area for every material point, and a closed outline for every grain") {
  const auto simulation = create_simulation(one_grain());
  advance(*simulation, 20);
  const Scene scene = simulation->scene();
  const auto& radius = std::get<std::vector<double>>(scene.particles.at("radius").values);
  CHECK(radius.size() == 4 * (4 * 4 + 3 * 16));  // a square of 4 x 4 cells and three rings of 16
  double area = 0;
  for (const double r : radius) area += std::numbers::pi * r * r;
  const double grain = std::numbers::pi * 25e-6;
  CHECK(area == doctest::Approx(grain * value_of(test::next_row(*simulation), "area_ratio")).epsilon(1e-3));
  CHECK(std::get<std::vector<double>>(scene.outlines.at("position").values).size() == 2 * 16);
}

TEST_CASE("a checkpoint of an earlier version is refused with the remedy") {
  const auto simulation = create_simulation(one_grain());
  Checkpoint old = simulation->checkpoint();
  CHECK_NOTHROW(simulation->restore(old));
  old.arrays.erase("impulse_time");
  CHECK_THROWS_WITH_AS(simulation->restore(old), doctest::Contains("anew with --force"), IoError);
}

TEST_CASE("a checkpoint of another case is refused") {
  const auto simulation = create_simulation(one_grain());
  const Checkpoint other = create_simulation(small_packing(Integrator::backward_euler))->checkpoint();
  CHECK_THROWS_AS(simulation->restore(other), IoError);
}

TEST_CASE("a checkpoint with a NaN, or with a contact of a vertex or wall that does not exist, is refused") {
  const auto simulation = create_simulation(small_packing(Integrator::backward_euler));
  const Checkpoint intact = simulation->checkpoint();
  Checkpoint changed = intact;
  std::get<std::vector<double>>(changed.arrays["velocity"].values)[3] = std::nan("");
  CHECK_THROWS_AS(simulation->restore(changed), IoError);
  for (const std::int64_t body : {-2ll, 1'000'000'000ll, 1ll << 40})
    for (std::size_t column = 0; column < 6; ++column) {
      changed = intact;
      std::vector<std::int64_t> bodies(6, 0);
      bodies[column] = body;
      changed.arrays["contact_bodies"] = {6, bodies};
      changed.arrays["contact_places"] = {5, std::vector<double>(5, 0.0)};
      changed.arrays["contact_impulse"] = {2, std::vector<double>(2, 0.0)};
      CHECK_THROWS_AS(simulation->restore(changed), IoError);
    }
  CHECK_NOTHROW(simulation->restore(intact));
}
