#include "softgrain/loading/loading.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/stages_of_case.hpp"
#include "softgrain/state/archive.hpp"
#include "support/spring_box.hpp"

using namespace softgrain;
using test::SpringModel;
using test::SpringRun;

namespace {

constexpr double v = 2, dt = 1e-6, target = 1e6;

SpringRun run_of(const std::vector<Stage>& stages, double stiffness = 10 * target) {
  const Box<2> box = test::square_box();
  const LoadingFrame frame{.measure = {}, .wall_velocity = v, .packing_fraction = 0.6};
  return {.loading = Loading(stages, frame, box), .model = SpringModel(stiffness), .dt = dt};
}

SpringRun run_of(const Case::Loading& keys, LoadingPath path = LoadingPath::compaction,
                 double stiffness = 10 * target) {
  Case c;
  c.experiment.loading = path;
  c.loading = keys;
  c.sample.packing_fraction = 0.6;
  check_loading(c);
  return {.loading = Loading(stages_of(c), frame_of(c), test::square_box()),
          .model = SpringModel(stiffness),
          .dt = dt};
}

Drive moves(Part part, double velocity) {
  return {.part = part, .control = Control::velocity, .value = velocity};
}
Drive keeps(Part part, double stress) { return {.part = part, .control = Control::stress, .value = stress}; }

Until until_strain(double strain) {
  Until until;
  until.strain[0] = strain;
  return until;
}
Until until_stress(Part part, double stress) {
  Until until;
  until.stress[static_cast<std::size_t>(part)] = stress;
  return until;
}

double strain_xx(const Box<2>& box) { return std::log(test::square_box().width() / box.width()); }

}  // namespace

TEST_CASE("all four walls come in at half the speed, and the top wall alone at the whole") {
  const Case::Loading keys{.wall_velocity = v, .max_strain = 0.2, .unload_at = {}};
  const auto velocities = [&](LoadingPath path) {
    SpringRun run = run_of(keys, path);
    run.step();
    std::vector<Vec<2>> all;
    for (const Wall<2>& wall : run.box.walls) all.push_back(wall.velocity);
    return all;
  };
  CHECK(velocities(LoadingPath::isotropic) ==
        std::vector<Vec<2>>{{0, v / 2}, {0, -v / 2}, {v / 2, 0}, {-v / 2, 0}});
  CHECK(velocities(LoadingPath::compaction) == std::vector<Vec<2>>{{}, {0, -v}, {}, {}});
}

TEST_CASE(
    "each part moves its walls: a component both and keeps the centre, a wall itself, a rate with the box") {
  SpringRun run = run_of(
      {{.drives = {moves(Part::xx, 1), moves(Part::bottom, 0.5)}, .until = until_strain(0.1)},
       {.drives = {{.part = Part::yy, .control = Control::rate, .value = 100}}, .until = until_strain(0.3)}},
      0);
  run.step();
  CHECK(run.box.walls[left_wall].velocity == Vec<2>{0.5, 0});
  CHECK(run.box.walls[right_wall].velocity == Vec<2>{-0.5, 0});
  CHECK(run.box.walls[bottom_wall].velocity == Vec<2>{0, 0.5});
  CHECK(run.box.walls[top_wall].velocity == Vec<2>{});
  run.finish_stage();
  CHECK(run.loading.strain(run.box) == doctest::Approx(0.1).epsilon(1e-9));
  CHECK(strain_xx(run.box) > 0.2);
  const std::int64_t start = run.steps;
  run.finish();
  CHECK(run.loading.strain(run.box) == doctest::Approx(0.3).epsilon(1e-9));
  CHECK(static_cast<double>(run.steps - start) * dt == doctest::Approx(0.2 / 100).epsilon(1e-3));
  CHECK(run.loading.outcome().shortfall.empty());
}

TEST_CASE("stages end at their strain within 1e-9, be they of yy or xx, together or apart") {
  Until sideways;
  sideways.strain[1] = -0.02;
  SpringRun run =
      run_of({{.drives = {moves(Part::yy, 1.7)}, .until = until_strain(0.11)},
              {.drives = {moves(Part::xx, -0.9)}, .until = sideways},
              {.drives = {moves(Part::top, -1.1), moves(Part::bottom, -0.3)}, .until = until_strain(0.04)}},
             0);
  run.finish_stage();
  CHECK(run.loading.strain(run.box) == doctest::Approx(0.11).epsilon(1e-9));
  run.finish_stage();
  CHECK(strain_xx(run.box) == doctest::Approx(-0.02).epsilon(1e-9));
  run.finish_stage();
  CHECK(run.loading.strain(run.box) == doctest::Approx(0.04).epsilon(1e-9));
  CHECK(run.loading.finished());
  CHECK(run.steps == run.loading.steps_planned(dt));
}

TEST_CASE("a stage whose strain is past already moves nothing, and the next one goes on") {
  SpringRun run = run_of({{.drives = {moves(Part::yy, 1)}, .until = until_strain(0.1)},
                          {.drives = {moves(Part::yy, 1)}, .until = until_strain(0.05)},
                          {.drives = {moves(Part::yy, 1)}, .until = until_strain(0.12)}},
                         0);
  run.finish_stage();
  const double height = run.box.height();
  run.finish_stage();
  CHECK(run.box.height() == height);
  run.finish();
  CHECK(run.loading.strain(run.box) == doctest::Approx(0.12).epsilon(1e-9));
}

TEST_CASE("a strain swings by its amplitude about where the stage began, and comes back") {
  for (const Wave wave : {Wave::sine, Wave::triangle}) {
    const Drive swings{
        .part = Part::yy, .control = Control::strain, .amplitude = 0.02, .period = 2e-3, .wave = wave};
    SpringRun run = run_of({{.drives = {moves(Part::yy, 1)}, .until = until_strain(0.1)},
                            {.drives = {swings}, .until = {.time = 4e-3}}},
                           0);
    run.finish_stage();
    double low = 1, high = 0;
    while (!run.loading.finished()) {
      run.step();
      low = std::min(low, run.loading.strain(run.box));
      high = std::max(high, run.loading.strain(run.box));
    }
    CHECK(low == doctest::Approx(0.08).epsilon(1e-6));
    CHECK(high == doctest::Approx(0.12).epsilon(1e-6));
    CHECK(run.loading.strain(run.box) == doctest::Approx(0.1).epsilon(1e-9));
  }
}

TEST_CASE("presses keep the stress of a spring on both axes, each its own, and never exceed it by a tenth") {
  SpringRun run =
      run_of({{.drives = {keeps(Part::yy, target), keeps(Part::xx, target / 2)}, .until = {.time = 6e-3}}});
  run.model.loss = {0.1 * target, 0};
  double highest = 0;
  while (!run.loading.finished()) {
    run.step();
    highest = std::max(highest, run.stress(1));
  }
  CHECK(run.stress(1) == doctest::Approx(target).epsilon(1e-3));
  CHECK(run.stress(0) == doctest::Approx(target / 2).epsilon(1e-3));
  CHECK(highest < 1.1 * target);  // walls that come in at their largest speed
  CHECK(run.loading.outcome().completed);
  CHECK(run.loading.outcome().shortfall.empty());
  CHECK(run.box.walls[bottom_wall].point[1] + run.box.walls[top_wall].point[1] ==
        doctest::Approx(20e-3).epsilon(1e-9));
}

TEST_CASE("a press has the force, mass and damper of its walls, and goes no faster than it may") {
  Drive top = keeps(Part::top, target);
  top.speed = 0.5;
  SpringRun run = run_of({{.drives = {top, keeps(Part::xx, target)}, .until = {.time = 1}}}, 0);
  Box<2> wide(
      {{{0, 0}, {0, 1}, {}}, {{0, 20e-3}, {0, -1}, {}}, {{0, 0}, {1, 0}, {}}, {{30e-3, 0}, {-1, 0}, {}}});
  run.loading.drive(wide, run.model, 0, dt);
  REQUIRE(wide.presses.size() == 2);
  CHECK(wide.presses[0].share == std::array<double, 6>{0, 1});
  CHECK(wide.presses[0].force == doctest::Approx(target * 30e-3));
  CHECK(wide.presses[0].mass == doctest::Approx(run.model.body.mass * 30e-3));
  CHECK(wide.presses[0].damper == doctest::Approx(run.model.body.damper * 30e-3));
  CHECK(wide.presses[0].most == 0.5);
  CHECK(wide.presses[1].share == std::array<double, 6>{0, 0, 0.5, 0.5});
  CHECK(wide.presses[1].force == doctest::Approx(target * 20e-3));
  CHECK(wide.presses[1].most == v);
}

TEST_CASE("a stress swings about the one that is kept") {
  Drive swings = keeps(Part::yy, target);
  swings.amplitude = 0.2 * target;
  swings.period = 10e-3;
  SpringRun run = run_of({{.drives = {keeps(Part::yy, target)}, .until = {.time = 10e-3}},
                          {.drives = {swings}, .until = {.time = 20e-3}}});
  run.finish_stage();
  double low = 2 * target, high = 0;
  while (!run.loading.finished()) {
    run.step();
    low = std::min(low, run.stress(1));
    high = std::max(high, run.stress(1));
  }
  CHECK(low == doctest::Approx(0.8 * target).epsilon(0.02));
  CHECK(high == doctest::Approx(1.2 * target).epsilon(0.02));
}

TEST_CASE("a hold begins where the stress is met, keeps it for its time, and says how well") {
  const Case::Loading keys{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 4e-3, .hold_stress = target};
  for (const LoadingPath path : {LoadingPath::compaction, LoadingPath::isotropic}) {
    SpringRun run = run_of(keys, path);
    run.model.loss = {0, 0};
    const std::int64_t planned = run.loading.steps_planned(dt);
    double progress = 0;
    while (!run.loading.at_turning_point()) {
      run.step();
      CHECK(run.loading.progress(run.time(), dt, planned) >= progress);
      progress = run.loading.progress(run.time(), dt, planned);
    }
    CHECK(run.stress(1) ==
          doctest::Approx(target).epsilon(5e-3));  // its mean over 0.1 % of strain lags by 1 %
    CHECK(run.loading.number() == 0);
    CHECK(run.loading.early_end().empty());
    const std::int64_t start = run.steps;
    run.finish();
    CHECK(run.loading.number() == 1);
    CHECK(run.steps - start == std::llround(keys.hold / dt));
    CHECK(run.stress(1) == doctest::Approx(target).epsilon(1e-3));
    if (path == LoadingPath::isotropic) CHECK(run.stress(0) == doctest::Approx(target).epsilon(1e-3));
    CHECK(run.loading.early_end().starts_with("loading.hold_stress was kept for loading.hold"));
    CHECK(run.loading.outcome().completed);
    CHECK(run.loading.outcome().shortfall.empty());
  }
}

TEST_CASE("a stress that is not kept is told with its figures, and the loading is not complete") {
  for (const bool of_the_user : {false, true}) {
    SpringRun run =
        of_the_user ? run_of({{.name = "hold", .drives = {keeps(Part::yy, target)}, .until = {.time = 2e-3}}})
                    : run_of({.wall_velocity = v,
                              .max_strain = 0.3,
                              .unload_at = {},
                              .hold = 2e-3,
                              .hold_stress = target});
    while (!of_the_user && !run.loading.at_turning_point()) run.step();
    run.model.body = {.mass = 1e9, .damper = 0};  // a wall that nothing moves
    for (std::int64_t step = 0; !run.loading.finished(); ++step) {
      run.model.loss[1] = step / 500 % 2 == 0 ? 0 : target;
      run.step();
    }
    const LoadingOutcome outcome = run.loading.outcome();
    CAPTURE(outcome.shortfall);
    CHECK_FALSE(outcome.completed);
    CHECK(outcome.shortfall.starts_with(of_the_user ? "stage 'hold': the stress of yy was not kept"
                                                    : "loading.hold_stress was not kept"));
    CHECK(outcome.shortfall.find("of standard deviation") != std::string::npos);
    if (!of_the_user) CHECK(run.loading.early_end().find("not kept") != std::string::npos);
  }
}

TEST_CASE("a stress that rises evenly ends the run where it is reached, not where its mean gets there") {
  SpringRun run = run_of({.wall_velocity = v, .max_strain = 0.3, .max_stress = target, .unload_at = {}},
                         LoadingPath::compaction, 100 * target);
  run.finish();
  CHECK(run.stress(1) == doctest::Approx(target).epsilon(0.02));  // 1.1 by the mean over 0.1 % of strain
  CHECK(run.loading.early_end() == "loading.max_stress is reached");
  CHECK(run.loading.outcome().completed);
}

TEST_CASE("a stage ends where its stress is reached, from below and from above, at 0 where nothing is left") {
  SpringRun run =
      run_of({{.drives = {moves(Part::top, 0.5)}, .until = until_stress(Part::yy, target)},
              {.drives = {moves(Part::top, -0.5)}, .until = until_stress(Part::top, 0.4 * target)},
              {.drives = {moves(Part::xx, 0.5)}, .until = until_stress(Part::xx, 0.3 * target)},
              {.drives = {moves(Part::top, -0.5)}, .until = until_stress(Part::top, 0)}});
  run.finish_stage();
  CHECK(run.stress(1) == doctest::Approx(target).epsilon(0.01));
  run.finish_stage();
  CHECK(run.stress(1) == doctest::Approx(0.4 * target).epsilon(0.02));
  run.finish_stage();
  CHECK(run.stress(0) == doctest::Approx(0.3 * target).epsilon(0.02));
  run.finish_stage();
  CHECK(std::abs(run.stress(1)) < 0.01 * target);
  CHECK(run.loading.finished());
  CHECK(run.loading.outcome().completed);
}

TEST_CASE("a packing fraction, an overlap and a state of rest end a stage") {
  Until dense, touching, still{.time = 1};
  dense.packing_fraction = 0.7;
  touching.overlap = 1e-3;
  still.rest = 1e-2;
  SpringRun run = run_of({{.drives = {moves(Part::yy, 1), moves(Part::xx, 1)}, .until = dense},
                          {.drives = {moves(Part::yy, 1)}, .until = touching},
                          {.until = still}},
                         0);
  run.finish_stage();
  CHECK(0.6 * 20e-3 * 20e-3 / run.box.volume() == doctest::Approx(0.7).epsilon(1e-3));
  run.felt.overlap_mean = 0.9e-3;
  for (int step = 0; step < 10; ++step) run.step();
  CHECK(run.loading.number() == 1);
  CHECK_FALSE(run.loading.asks_for_rest());
  run.felt.overlap_mean = 1.1e-3;
  run.step();
  CHECK(run.loading.at_turning_point());
  CHECK(run.loading.asks_for_rest());
  for (const double unrest : {1.0, std::numeric_limits<double>::infinity(), std::nan(""), 2e-2}) {
    run.felt.unrest = unrest;
    run.step();
    CHECK_FALSE(run.loading.finished());
  }
  run.felt.unrest = 0.9e-2;
  run.step();
  CHECK(run.loading.finished());
}

TEST_CASE(
    "a stress that is never reached ends at a strain of 3, and apart where the run began, and is told") {
  for (const bool together : {true, false}) {
    std::vector<Stage> stages{{.name = "press",
                               .drives = {moves(Part::yy, together ? 5 : -5)},
                               .until = until_stress(Part::yy, 5e6)},
                              {.until = {.time = 1}}};
    if (!together)
      stages.insert(stages.begin(), {.drives = {moves(Part::yy, 5)}, .until = until_strain(0.2)});
    SpringRun run = run_of(stages, 1e3);
    run.finish();
    CHECK(run.loading.strain(run.box) == doctest::Approx(together ? 3 : 0).epsilon(0.01));
    const LoadingOutcome outcome = run.loading.outcome();
    CHECK_FALSE(outcome.completed);
    CHECK(outcome.shortfall.starts_with(
        together ? "stage 'press': stress_yy of 5e+06 Pa was not reached by strain 3: the largest stress was"
                 : "stage 'press': stress_yy of 5e+06 Pa was not reached by strain 0"));
    CHECK(run.loading.early_end() == outcome.shortfall);
    CHECK(run.loading.progress(run.time(), dt, 1) == 1);
  }
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
