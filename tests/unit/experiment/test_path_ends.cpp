#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

/// Few legs, most of them shorter than a step, so that a rounding to whole steps would be seen at once.
Case case_of(LoadingPath loading, GrainModel model) {
  Case c;
  c.experiment = {.loading = loading, .model = model};
  c.bpm.primaries = 30;
  c.bpm.library = 1;
  c.mpm.cells = 4;
  c.sample.grains = 2;
  c.sample.packing_fraction = 0.3;
  c.loading = {.wall_velocity = 1, .max_strain = 0.011, .unload_at = {0.003, 0.006, 0.01}, .unload_by = 2e-4};
  if (c.experiment.model == GrainModel::bpm) c.loading.wall_velocity = 2.5;  // as far in a step
  c.time.step = model == GrainModel::bpm ? 2e-6 : 40e-6;
  return c;
}

/// Strain after each leg, by the walls' distance alone.
void check_ends(const Case& c) {
  CAPTURE(c.experiment.loading);
  CAPTURE(c.experiment.model);
  CAPTURE(c.mpm.integrator);
  const auto simulation = create_simulation(c);
  const double start = test::value_of(test::next_row(*simulation), "wall_height");
  const bool box = c.experiment.loading != LoadingPath::diametral;
  const auto strain = [&] {
    const double h = test::value_of(test::next_row(*simulation), "wall_height");
    return box ? std::log(start / h) : -std::log(1 - (start - h) / (2 * c.grain.radius));
  };
  std::vector<double> ends;
  while (!simulation->finished()) {
    simulation->step();
    if (simulation->at_turning_point() || simulation->finished()) ends.push_back(strain());
  }
  std::vector<double> asked;
  for (const double turn : c.loading.unload_at) asked.insert(asked.end(), {turn, turn - c.loading.unload_by});
  asked.push_back(c.loading.max_strain);
  REQUIRE(ends.size() == asked.size());
  for (std::size_t leg = 0; leg < ends.size(); ++leg)
    CHECK(ends[leg] == doctest::Approx(asked[leg]).epsilon(1e-9));
}

}  // namespace

TEST_CASE("every leg of every model ends at its strain, be it shorter than a step") {
  for (const LoadingPath loading :
       {LoadingPath::diametral, LoadingPath::compaction, LoadingPath::isotropic}) {
    check_ends(case_of(loading, GrainModel::bpm));
    Case c = case_of(loading, GrainModel::mpm);
    check_ends(c);
    c.mpm.integrator = Integrator::symplectic_euler;
    c.time.step = 0;
    c.loading.wall_velocity = 40;  // as far in a step
    check_ends(c);
    if (c.experiment.loading != LoadingPath::diametral) continue;
    c.mpm.formulation = Formulation::updated_lagrangian;
    check_ends(c);
  }
}

TEST_CASE("a packing fraction that is asked for at the end is met") {
  Case c = case_of(LoadingPath::isotropic, GrainModel::mpm);
  c.loading.unload_at = {};
  c.loading.max_strain = 1;
  c.loading.max_packing_fraction = 0.313;
  for (const LoadingPath loading : {LoadingPath::compaction, LoadingPath::isotropic}) {
    c.experiment.loading = loading;
    const auto simulation = create_simulation(c);
    while (!simulation->finished()) simulation->step();
    CHECK(test::value_of(test::next_row(*simulation), "phi_0") == doctest::Approx(0.313).epsilon(1e-9));
  }
}

TEST_CASE("walls that move against one that gives way stop short of their strain, and say so") {
  Case c = case_of(LoadingPath::stages, GrainModel::mpm);
  c.loading = {.wall_velocity = 1, .unload_at = {}};
  c.contact.wall_friction = 0.3;
  const Drive comes{Part::top, Control::velocity, 1}, gives_way{Part::bottom, Control::stress, 1e3};
  c.stages = {{.name = "press", .drives = {comes, gives_way}, .until = {.strain = {2.0}}}};
  Simulation simulation = test::simulation_of(c);
  const double height = simulation.box().height();
  const auto steps = static_cast<std::int64_t>(height / (1 * c.time.step)) + 1;
  test::advance(simulation, steps);
  CHECK(simulation.finished());
  const LoadingOutcome outcome = simulation.outcome();
  CHECK_FALSE(outcome.completed);
  CHECK(outcome.shortfall.starts_with("stage 'press': strain 2 was not reached while walls moved as far as"));
}
