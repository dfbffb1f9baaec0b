#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "support/simulations.hpp"

using namespace softgrain;

namespace {

/// Six grains that are pressed without friction, with `later` from half way on, and with neither in the end.
Case pressed(GrainModel model, const Settings& later, const Settings& last = {}) {
  const bool bonded = model == GrainModel::bpm;
  Case c;
  c.experiment = {.loading = LoadingPath::stages, .model = model};
  c.bpm.primaries = 30;
  c.bpm.library = 2;
  c.mpm.cells = 3;
  c.sample.grains = 6;
  c.sample.packing_fraction = 0.6;
  c.loading.wall_velocity = bonded ? 10 : 2;
  c.time.step = bonded ? 0.4e-6 : 10e-6;
  const Drive closes{.part = Part::yy, .control = Control::velocity, .value = c.loading.wall_velocity};
  const auto stage = [&](double strain, const Settings& set) {
    Stage made{.drives = {closes}, .set = set};
    made.until.strain[0] = strain;
    return made;
  };
  c.stages = {stage(0.2, {}), stage(0.3, later), stage(0.34, last)};
  return c;
}

void to_next_stage(Simulation& simulation) {
  do simulation.step();
  while (!simulation.at_turning_point() && !simulation.finished());
}

void check_same(const Simulation& a, const Simulation& b) {
  const Checkpoint first = a.checkpoint(), second = b.checkpoint();
  CHECK(first.step == second.step);
  for (const auto& [name, array] : first.arrays) {
    CAPTURE(name);
    CHECK((array.values == second.arrays.at(name).values));
  }
}

/// What a case with these settings from its start on has.
Case with(Case c, const Settings& settings) {
  c.contact.friction = settings.friction.value_or(c.contact.friction);
  c.contact.wall_friction = settings.wall_friction.value_or(c.contact.wall_friction);
  c.solver.tolerance = settings.solver_tolerance.value_or(c.solver.tolerance);
  c.mpm.tolerance = settings.newton_tolerance.value_or(c.mpm.tolerance);
  c.mpm.damping = settings.damping.value_or(c.mpm.damping);
  return c;
}

const Settings everything{.friction = 0.4,
                          .wall_friction = 0.2,
                          .solver_tolerance = 1e-4,
                          .newton_tolerance = 1e-6,
                          .damping = 3000};

}  // namespace

TEST_CASE("what a stage sets acts from its begin on as if the case said so, bit for bit") {
  for (const GrainModel model : {GrainModel::bpm, GrainModel::mpm})
    for (const Settings& settings :
         {everything, Settings{.friction = 0.4}, Settings{.wall_friction = 0.3},
          Settings{.solver_tolerance = 1e-3}, Settings{.newton_tolerance = 1e-7}, Settings{.damping = 1e4}}) {
      CAPTURE(model);
      Simulation sets = test::simulation_of(pressed(model, settings));
      to_next_stage(sets);
      Simulation says = test::simulation_of(with(pressed(model, {}), settings));
      says.restore(sets.checkpoint());
      Simulation without = test::simulation_of(pressed(model, {}));
      without.restore(sets.checkpoint());
      while (!sets.finished()) sets.step(), says.step(), without.step();
      check_same(sets, says);
      const bool of_mpm = settings.newton_tolerance || settings.damping;
      const bool of_bpm = settings.solver_tolerance.has_value();
      const bool acts = settings == everything || !(model == GrainModel::bpm ? of_mpm : of_bpm);
      const double stress = test::value_of(test::next_row(sets), "stress_top");
      CHECK(acts == (stress != test::value_of(test::next_row(without), "stress_top")));
    }
}

TEST_CASE("an explicit step follows what a stage sets too") {
  Case c = pressed(GrainModel::mpm, {.friction = 0.4, .wall_friction = 0.2, .damping = 3000});
  c.mpm.integrator = Integrator::symplectic_euler;
  c.loading.wall_velocity = 20;
  for (Stage& stage : c.stages) stage.drives.front().value = 20;
  c.time.step = 0;
  Simulation sets = test::simulation_of(c);
  to_next_stage(sets);
  Case plain = c;
  for (Stage& stage : plain.stages) stage.set = {};
  Simulation says = test::simulation_of(with(plain, c.stages[1].set));
  says.restore(sets.checkpoint());
  while (!sets.finished()) sets.step(), says.step();
  check_same(sets, says);
}

TEST_CASE("grains slide at the cost of energy only in the stage that has friction") {
  for (const GrainModel model : {GrainModel::bpm, GrainModel::mpm}) {
    CAPTURE(model);
    Simulation simulation = test::simulation_of(
        pressed(model, {.friction = 0.4, .wall_friction = 0.4}, {.friction = 0, .wall_friction = 0}));
    const auto dissipated = [&] { return simulation.energies().friction; };
    to_next_stage(simulation);
    CHECK(dissipated() == 0);
    to_next_stage(simulation);
    const double rough = dissipated();
    CHECK(rough > 0);
    to_next_stage(simulation);
    CHECK(simulation.finished());
    CHECK(dissipated() == rough);
  }
}

TEST_CASE("a state of any stage goes on with the settings of that stage, whatever went before") {
  for (const GrainModel model : {GrainModel::bpm, GrainModel::mpm}) {
    CAPTURE(model);
    const Case c = pressed(model, everything, {.friction = 0, .damping = 0});
    Simulation whole = test::simulation_of(c);
    std::vector<Checkpoint> states{whole.checkpoint()};
    while (!whole.finished()) {
      test::advance(whole, model == GrainModel::bpm ? 70 : 20);
      states.push_back(whole.checkpoint());
    }
    REQUIRE(states.size() > 4);
    Simulation again = test::simulation_of(c);  // and back, stage by stage
    for (std::size_t k = states.size() - 1; k-- > 0;) {
      again.restore(states[k]);
      test::advance(again, states.back().step - states[k].step);
      check_same(again, whole);
    }
  }
}

TEST_CASE("a run that begins from another has the settings of its own case and first stage") {
  for (const GrainModel model : {GrainModel::bpm, GrainModel::mpm}) {
    CAPTURE(model);
    Simulation first = test::simulation_of(pressed(model, everything));
    to_next_stage(first);
    test::advance(first, 20);
    Case c = with(pressed(model, {}), {.wall_friction = 0.1});
    for (Stage& stage : c.stages) stage.until.strain[0] = *stage.until.strain[0] + 0.05;
    c.stages[0].set.friction = 0.2;
    Simulation second = test::simulation_of(c);
    second.begin_from(first.checkpoint());
    CHECK(second.model().settings().friction == 0.2);
    CHECK(second.model().settings().wall_friction == 0.1);
    test::advance(second, 30);
    Simulation third = test::simulation_of(c);
    third.restore(second.checkpoint());
    while (!second.finished()) second.step(), third.step();
    check_same(second, third);
  }
}

TEST_CASE("what stages set adds up, also where stages are repeated") {
  Case c = pressed(GrainModel::mpm, {.friction = 0.4}, {.damping = 7});
  c.stages[0].name = "first";
  for (Stage& stage : c.stages) stage.until = {.time = 20e-6};
  c.stages[2].repeat = 2;
  c.stages[2].repeat_from = "first";
  Simulation simulation = test::simulation_of(c);
  const double tolerance = c.mpm.tolerance;
  const auto check = [&](double friction, double damping) {
    const Settings now = simulation.model().settings();
    CHECK(now.friction == friction);
    CHECK(now.wall_friction == 0);
    CHECK(now.newton_tolerance == tolerance);
    CHECK(now.damping == damping);
    to_next_stage(simulation);
  };
  check(0, 0);
  check(0.4, 0);
  for (int k = 0; k < 4; ++k) check(0.4, 7);
  CHECK(simulation.finished());
}
