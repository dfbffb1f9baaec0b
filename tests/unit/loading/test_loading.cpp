#include "softgrain/loading/loading.hpp"

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
  CHECK_FALSE(run.loading.outcome().completed);
  CHECK(run.loading.outcome().shortfall.starts_with(
      "stage 1 ended as it began: its walls move away from strain 0.05, which was past already"));
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
    double progress = 0;
    while (!run.loading.at_turning_point()) {
      run.step();
      CHECK(run.loading.progress(run.time(), dt) >= progress);
      progress = run.loading.progress(run.time(), dt);
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
    CHECK(run.loading.progress(run.time(), dt) == 1);
  }
}
