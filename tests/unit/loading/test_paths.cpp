#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/state/archive.hpp"
#include "support/spring_box.hpp"

using namespace softgrain;
using namespace softgrain::test;

TEST_CASE("a biaxial path confines, and compresses while the sides keep their stress") {
  SpringRun run = run_of(
      {.wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 5e-3, .confining_stress = target},
      LoadingPath::biaxial);
  run.finish_stage();
  CHECK(run.stress(1) == doctest::Approx(target).epsilon(0.01));
  run.finish_stage();
  CHECK(run.stress(0) == doctest::Approx(target).epsilon(0.01));
  run.finish();
  CHECK(run.loading.number() == 2);
  CHECK(run.loading.strain(run.box) == doctest::Approx(0.3).epsilon(1e-9));
  CHECK(run.stress(0) == doctest::Approx(target).epsilon(0.01));
  CHECK(run.stress(1) == doctest::Approx(3 * target).epsilon(0.01));
  CHECK(run.loading.outcome().shortfall.empty());
}

TEST_CASE(
    "sides that keep their stress beside a wall that moves have a fiftieth of the time of a press alone") {
  const auto sides = [](double speed, double step) {
    SpringRun run =
        run_of({{.drives = {moves(Part::yy, speed), keeps(Part::xx, target)}, .until = {.time = 1}}}, 0);
    run.loading.drive(run.box, run.model, 0, step);
    REQUIRE(run.box.presses.size() == 1);
    return run.box.presses[0];
  };
  const Press alone = sides(0, dt), beside = sides(v, dt);
  CHECK(std::abs(beside.time() / alone.time() - 0.02) < 1e-12);
  CHECK(std::abs(beside.mass / alone.mass - 0.02 * 0.02) < 1e-12);  // the same m/tau^2: critically damped
  const Press in_long_steps = sides(v, 6 * alone.time());           // a thirtieth of a step
  CHECK(std::abs(in_long_steps.time() / alone.time() - 0.2) < 1e-12);
}

TEST_CASE("sides beside a wall that moves are limited in their speed until they have met the grains") {
  for (const double given : {0.0, 3.0}) {
    Drive sides = keeps(Part::xx, target);
    sides.speed = given;
    SpringRun run = run_of({{.drives = {moves(Part::yy, v), sides}, .until = {.time = 1}}}, 0);
    for (const double share : {0.0, 0.4, 0.6}) {
      run.loading.drive(run.box, run.model, run.time(), dt);
      Press& press = run.box.presses[0];
      press.mean_force = share * press.force;
      run.loading.after_step(run.box, run.time() + dt, dt, {});
      run.loading.drive(run.box, run.model, run.time() + dt, dt);
      const double free = share > 0.5 ? std::numeric_limits<double>::infinity() : 50 * v;
      CHECK(run.box.presses[0].most == (given > 0 ? given : free));
    }
  }
}

TEST_CASE("a die presses with its top wall to a stress, keeps it, and lets go") {
  SpringRun run =
      run_of({.wall_velocity = v, .max_strain = 0.3, .max_stress = target, .unload_at = {}, .hold = 5e-3},
             LoadingPath::die);
  run.finish_stage();
  CHECK(run.stress(1) == doctest::Approx(target).epsilon(0.01));
  run.finish_stage();
  CHECK(run.stress(1) == doctest::Approx(target).epsilon(0.01));
  run.finish_stage();
  CHECK(run.loading.finished());
  CHECK(std::abs(run.stress(1)) < 0.01 * target);
  CHECK(run.box.walls[bottom_wall].point == Vec<2>{0, 0});
  CHECK(run.loading.outcome().shortfall.empty());
  SpringRun weak =
      run_of({.wall_velocity = v, .max_strain = 0.05, .max_stress = target, .unload_at = {}, .hold = 5e-3},
             LoadingPath::die);
  weak.finish();
  CHECK_FALSE(weak.loading.outcome().completed);
  CHECK(weak.loading.outcome().shortfall.find("was not reached by strain 0.05") != std::string::npos);
}

TEST_CASE("a die ejects: after unloading the sides go apart until they bear nothing, and all walls rest") {
  const auto ejecting = [](double hold) {
    SpringRun run = run_of({.wall_velocity = v,
                            .max_strain = 0.3,
                            .max_stress = target,
                            .unload_at = {},
                            .hold = hold,
                            .eject = true},
                           LoadingPath::die);
    run.model.loss = {-0.1 * target, 0.2 * target};  // the sides bear this, and the top less
    return run;
  };
  SpringRun run = ejecting(5e-3);
  for (int stage = 0; stage < 3; ++stage) run.finish_stage();
  const double height = run.box.height();
  CHECK(run.box.width() == 20e-3);
  CHECK(20e-3 / height == doctest::Approx(std::exp(0.02)).epsilon(1e-4));
  CHECK(run.stress(0) == doctest::Approx(0.1 * target));
  run.finish_stage();
  CHECK(run.box.width() / 20e-3 == doctest::Approx(std::exp(0.01)).epsilon(1e-4));
  CHECK(run.box.walls[left_wall].point[0] == doctest::Approx(-(run.box.width() - 20e-3) / 2));
  CHECK(run.box.height() == height);
  CHECK(std::abs(run.stress(0)) < 1e-3 * target);
  run.model.loss[1] = 0.1 * target;  // the compact grows when the sides let go
  run.finish_stage();
  CHECK(20e-3 / run.box.height() == doctest::Approx(std::exp(0.01)).epsilon(1e-4));
  CHECK(std::abs(run.stress(1)) < 2e-3 * target);
  CHECK_FALSE(run.loading.finished());
  const double start = run.time(), width = run.box.width();
  run.finish();
  CHECK(run.time() - start == doctest::Approx(5e-3));
  CHECK(run.box.width() == width);
  CHECK(run.box.walls[bottom_wall].point == Vec<2>{0, 0});
  CHECK(run.loading.outcome().completed);
  CHECK(run.loading.outcome().shortfall.empty());
  SpringRun swollen = ejecting(0);
  swollen.model.loss[0] = -1.5 * target;
  swollen.finish();
  CHECK(swollen.loading.outcome().shortfall.starts_with(
      "stage 'eject': stress_xx of 0 Pa was not reached by strain -0.1"));
  SpringRun without_rest = ejecting(0);
  without_rest.finish();
  CHECK(without_rest.loading.number() == 3);
  CHECK(without_rest.box.width() / 20e-3 == doctest::Approx(std::exp(0.01)).epsilon(1e-4));
}

TEST_CASE("a relaxation compacts, and rests until its time is over or the grains are at rest") {
  for (const bool at_rest : {false, true}) {
    SpringRun run =
        run_of({.wall_velocity = v, .max_strain = 0.1, .unload_at = {}, .hold = 2e-3, .rest = 1e-4},
               LoadingPath::relaxation);
    run.felt.unrest = at_rest ? 1e-5 : 1e-3;
    run.finish_stage();
    CHECK(run.loading.strain(run.box) == doctest::Approx(0.1).epsilon(1e-9));
    const std::int64_t start = run.steps;
    run.finish();
    CHECK(run.steps - start == (at_rest ? 1 : 2000));
    CHECK(run.loading.strain(run.box) == doctest::Approx(0.1).epsilon(1e-9));
  }
}

TEST_CASE("a stress that is held for no time is refused") {
  CHECK_THROWS_AS(run_of({.wall_velocity = v, .max_strain = 0.2, .unload_at = {}, .hold_stress = 1e5}),
                  UsageError);
}

TEST_CASE("a given motion takes the place of the stages, with the part that the first of them moves") {
  SpringRun run = run_of(Case::Loading{}, LoadingPath::isotropic, 0);
  run.dt = 0.25;
  int asked = 0;
  run.loading.follow({.duration = 1, .velocity = [&](double time) {
                        ++asked;
                        return -1e-3 * time;
                      }});
  CHECK(run.loading.steps_planned(run.dt) == 4);
  while (!run.loading.finished()) {
    const double speed = 1e-3 * run.time();
    run.step();
    for (const Wall<2>& wall : run.box.walls) CHECK(wall.velocity == Vec<2>{} + speed / 2 * wall.normal);
  }
  CHECK(run.steps == 4);
  CHECK(asked == 4);
}

TEST_CASE("a given motion without an end or without a speed is refused") {
  SpringRun run = run_of(Case::Loading{});
  for (const double duration : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    CHECK_THROWS_AS(run.loading.follow({.duration = duration, .velocity = [](double) { return -1; }}),
                    UsageError);
  run.loading.follow({.duration = 1, .velocity = [](double) { return std::nan(""); }});
  CHECK_THROWS_AS(run.step(), UsageError);
}

TEST_CASE(
    "a loading goes on from a copy of its state in every kind of stage, and one of another case is refused") {
  Drive swings{.part = Part::xx, .control = Control::strain, .amplitude = 0.01, .period = 1e-3};
  Drive pulses = keeps(Part::yy, target);
  pulses.amplitude = 0.1 * target;
  pulses.period = 0.7e-3;
  const Drive rate{.part = Part::yy, .control = Control::rate, .value = 50};
  const std::vector<Stage> stages{
      {.name = "a", .drives = {moves(Part::top, 1)}, .until = until_stress(Part::yy, 0.5 * target)},
      {.drives = {keeps(Part::yy, target), keeps(Part::xx, target)}, .until = {.time = 1e-3}},
      {.drives = {pulses, swings}, .until = {.time = 1e-3}},
      {.drives = {rate, keeps(Part::xx, target)}, .until = until_strain(0.2)},
      {.drives = {moves(Part::top, -1)},
       .until = until_stress(Part::top, 0.1 * target),
       .repeat = 2,
       .repeat_from = "a"},
      {.until = {.time = 0.5e-3}}};
  SpringRun run = run_of(stages);
  int checked = 0;
  while (!run.loading.finished()) {
    for (int step = 0; step < 100 && !run.loading.finished(); ++step) run.step();
    if (run.loading.finished() || run.steps % 700 != 0) continue;
    StateWriter writer;
    run.loading.visit(writer);
    SpringRun other = run_of(stages), twin = run;
    StateReader reader(writer.arrays);
    other.loading.visit(reader);
    twin.loading = other.loading;
    SpringRun whole = run;
    for (int step = 0; step < 1500 && !whole.loading.finished(); ++step) {
      whole.step();
      twin.step();
      REQUIRE(twin.box.height() == whole.box.height());
      REQUIRE(twin.box.width() == whole.box.width());
      REQUIRE(twin.loading.number() == whole.loading.number());
    }
    CHECK(twin.loading.outcome().shortfall == whole.loading.outcome().shortfall);
    ++checked;
  }
  CHECK(checked > 10);
  CHECK(run.loading.number() == 10);
  StateWriter writer;
  run.loading.visit(writer);
  writer.arrays["stage"] = {1, std::vector<std::int64_t>{1000}};
  StateReader reader(writer.arrays);
  CHECK_THROWS_AS(run.loading.visit(reader), IoError);
}

TEST_CASE("a loading that begins where another ended counts its strains from where that one began") {
  SpringRun first =
      run_of({{.drives = {moves(Part::yy, 1), moves(Part::xx, 0.5)}, .until = until_strain(0.1)}}, 0);
  first.finish();
  StateWriter writer;
  first.loading.visit(writer);
  SpringRun second = run_of({{.drives = {moves(Part::yy, -1)}, .until = until_strain(0.07)}}, 0);
  second.box = first.box;
  StateReader reader(writer.arrays);
  second.loading.begin_at(reader, second.box);
  CHECK(second.loading.strain(second.box) == doctest::Approx(0.1).epsilon(1e-9));
  second.finish();
  CHECK(second.steps == second.loading.steps_planned(dt));
  CHECK(std::log(20e-3 / second.box.height()) == doctest::Approx(0.07).epsilon(1e-9));
}

TEST_CASE("stresses that a loading does not reach are named, with the largest that it met") {
  for (const bool hold : {true, false}) {
    Case::Loading keys{.wall_velocity = v, .max_strain = 0.01, .unload_at = {}};
    (hold ? keys.hold_stress : keys.max_stress) = target;
    if (hold) keys.hold = 0.1e-3;
    SpringRun run = run_of(keys);
    CHECK(run.loading.outcome().shortfall.empty());
    run.finish();
    const LoadingOutcome outcome = run.loading.outcome();
    CHECK(outcome.completed == !hold);  // the last strain is an end that the case names; a hold is left out
    CHECK(outcome.shortfall.starts_with(hold ? "loading.hold_stress of 1e+06 Pa was not reached"
                                             : "loading.max_stress of 1e+06 Pa was not reached"));
    const double largest = std::stod(outcome.shortfall.substr(outcome.shortfall.find("stress was") + 10));
    CHECK(largest == doctest::Approx(1e5).epsilon(0.02));
  }
  Until either = until_stress(Part::yy, target);
  either.strain[0] = 0.01;
  SpringRun run = run_of({{.name = "press", .drives = {moves(Part::yy, 1)}, .until = either}});
  run.finish();
  CHECK(run.loading.outcome().completed);
  CHECK(run.loading.outcome().shortfall.starts_with("stage 'press': stress_yy of 1e+06 Pa was not reached"));
}

TEST_CASE("a stress that is met while the walls go back is not held") {
  Case::Loading keys{.wall_velocity = v, .max_strain = 0.3, .unload_at = {0.1}, .unload_by = 0.05};
  keys.hold = 0.1e-3;
  keys.hold_stress = target;
  SpringRun run = run_of(keys, LoadingPath::compaction, 0);
  while (!run.loading.finished()) {
    const double height = run.box.height();
    run.model.loss[1] = 0;
    run.loading.drive(run.box, run.model, run.time(), dt);
    if (run.box.walls[top_wall].velocity[1] > 0) run.model.loss[1] = -2 * target;
    run.model.step(run.box, dt);
    ++run.steps;
    run.loading.after_step(run.box, run.time(), dt, {});
    CHECK(std::abs(run.box.height() - height) <= v * dt * 1.001);
  }
  CHECK(run.loading.outcome().shortfall.find("so nothing was held") != std::string::npos);
}

TEST_CASE("walls that go apart end at a packing fraction from above, and none is past unseen") {
  const auto at_fraction = [](double velocity, double fraction) -> Stage {
    return {.drives = {moves(Part::yy, velocity)}, .until = {.packing_fraction = fraction}};
  };
  SpringRun apart = run_of({at_fraction(1, 0.9), at_fraction(-1, 0.8)}, 0);
  apart.finish_stage();
  const double dense = apart.box.height();
  apart.finish();
  CHECK(apart.box.height() / dense == doctest::Approx(0.9 / 0.8).epsilon(0.01));
  CHECK(apart.loading.outcome().shortfall.empty());
  for (const auto& [velocity, fraction] : {std::pair{1.0, 0.1}, {-1.0, 0.95}}) {
    SpringRun past = run_of({at_fraction(velocity, fraction)}, 0);
    past.finish();
    CHECK_FALSE(past.loading.outcome().completed);
    CHECK(past.loading.outcome().shortfall.find("packing_fraction") != std::string::npos);
  }
}
