#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/experiment/sample.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

constexpr double g = 9.81;

/// A box at rest under gravity.
Case box_at_rest(GrainModel model, Integrator integrator, double time) {
  Case c;
  c.experiment = {.loading = LoadingPath::stages, .model = model};
  c.box.gravity_y = -g;
  c.mpm.cells = 3;
  c.mpm.integrator = integrator;
  c.mpm.damping = 400;
  c.bpm.primaries = 20;
  c.bpm.library = 1;
  c.sample.grains = 6;
  c.sample.packing_fraction = 0.5;
  c.contact.friction = c.contact.wall_friction = 0.3;
  c.loading.wall_velocity = 0.5;
  c.stages = {{.name = "rest", .until = {.time = time}}};
  if (model == GrainModel::bpm) c.time.step = 1e-6;
  return c;
}

double weight(const Simulation& simulation) {
  double mass = 0;
  for (const double m : simulation.model().bodies().mass) mass += m;
  return mass * g;
}

}  // namespace

TEST_CASE("a grain that nothing holds falls by g t^2/2, and gravity's work is what its motion has") {
  for (const GrainModel model : {GrainModel::bpm, GrainModel::mpm})
    for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler}) {
      Case c = box_at_rest(model, integrator, 5e-3);
      c.mpm.damping = 0;
      c.box.width = c.box.height = 10e-3;
      c.sample.placed = {{.centre = {5e-3, 8e-3}, .radius = 1e-3, .angle = 0}};
      Simulation simulation = test::simulation_of(complete_sample(c));
      const double start = simulation.model().centres()[0][1];
      while (!simulation.finished()) simulation.step();
      const double t = simulation.time(), fallen = start - simulation.model().centres()[0][1];
      CHECK(fallen == doctest::Approx(g * t * t / 2).epsilon(0.01));  // steps of first order
      const Observation now = simulation.observe();
      CHECK(*now.number("gravity_work") == doctest::Approx(weight(simulation) * fallen).epsilon(1e-6));
      CHECK(now.energies.kinetic == doctest::Approx(weight(simulation) * fallen).epsilon(0.01));
    }
}

TEST_CASE(
    "grains that have settled press the bottom with their weight, and the energy of their fall is accounted "
    "for") {
  for (const GrainModel model : {GrainModel::bpm, GrainModel::mpm}) {
    const bool bonded = model == GrainModel::bpm;
    CAPTURE(bonded);
    Case c = box_at_rest(model, Integrator::backward_euler, bonded ? 0.08 : 0.15);
    c.box.open_top = bonded;
    Simulation simulation = test::simulation_of(c);
    double impulse = 0, time = 0;
    while (!simulation.finished()) {
      simulation.step();
      if (simulation.time() < (bonded ? 0.06 : 0.1)) continue;
      impulse += simulation.box().outward_impulse(bottom_wall);
      time += simulation.time_step();
    }
    CHECK(impulse / time == doctest::Approx(weight(simulation)).epsilon(0.02));
    const Energies end = simulation.energies();
    const double work = *simulation.observe().number("gravity_work");
    CHECK(work > 0);
    CHECK(std::abs(end.error) < 0.02 * work);
    CHECK(end.kinetic < 0.01 * work);
  }
}

TEST_CASE("without a top wall grains fly as if nothing were there, and the wall that comes presses them") {
  for (const GrainModel model : {GrainModel::bpm, GrainModel::mpm})
    for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler}) {
      CAPTURE(static_cast<int>(model));
      CAPTURE(static_cast<int>(integrator));
      if (model == GrainModel::bpm && integrator == Integrator::symplectic_euler) continue;
      Case c = box_at_rest(model, integrator, 5e-3);
      c.mpm.damping = 0;
      c.box.gravity_y = 1000;  // up
      c.box.open_top = true;
      c.box.width = c.box.height = 10e-3;
      c.sample.placed = {{.centre = {5e-3, 8e-3}, .radius = 1e-3, .angle = 0}};
      Stage press{.name = "press",
                  .drives = {{.part = Part::top, .control = Control::velocity, .value = 0.5}},
                  .until = {.time = 4e-3}};
      c.stages.push_back(press);
      Simulation simulation = test::simulation_of(complete_sample(c));
      const double start = simulation.model().centres()[0][1];
      Simulation resumed = test::simulation_of(complete_sample(c));
      double on_top = 0;
      while (!simulation.finished()) {
        const bool flies = !simulation.at_turning_point() && on_top == 0 && simulation.time() < 5e-3;
        if (simulation.at_turning_point()) resumed.restore(simulation.checkpoint());
        simulation.step();
        if (!flies) {
          on_top += simulation.box().outward_impulse(top_wall);
          resumed.step();
          continue;
        }
        CHECK(simulation.box().outward_impulse(top_wall) == 0);
        const double highest = simulation.model().extent(1).second;
        CHECK(simulation.box().high(1).point[1] == doctest::Approx(highest + 0.01e-3).epsilon(1e-9));
        const double t = simulation.time();
        if (t > 4.9e-3)  // through where a wall would stand
          CHECK(simulation.model().centres()[0][1] - start == doctest::Approx(500 * t * t).epsilon(0.03));
      }
      CHECK(on_top > 0);
      CHECK(resumed.finished());
      CHECK(resumed.model().extent(1) == simulation.model().extent(1));
      // the grain goes up at 5 m/s, the wall comes down at 0.5 m/s: it takes the grain with it
      CHECK(simulation.model().extent(1).second < simulation.box().high(1).point[1] + 0.02e-3);
      CHECK(std::abs(simulation.energies().error) <
            0.03 * std::abs(*simulation.observe().number("gravity_work")));
    }
}
