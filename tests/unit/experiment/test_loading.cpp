#include "softgrain/experiment/loading.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/state/archive.hpp"

using namespace softgrain;

namespace {

constexpr double side = 20e-3, v = 2, dt = 0.1e-6, target = 1e6;

Box<2> square() {
  return Box<2>(
      {{{0, 0}, {0, 1}, {}}, {{0, side}, {0, -1}, {}}, {{0, 0}, {1, 0}, {}}, {{side, 0}, {-1, 0}, {}}});
}

Loading loading_of(const Case::Loading& keys, LoadingPath path = LoadingPath::compaction) {
  Case c;
  c.experiment.loading = path;
  c.loading = keys;
  c.sample.packing_fraction = 0.6;
  check_loading(c);
  return {stages_of(c), strain_measure(c, side), ends_of(c), side};
}

/// A spring between bottom and top wall that loses `loss` [Pa] when the walls keep a stress.
struct Spring {
  double stiffness, loss = 0;
  double stress = 0;
  std::int64_t step = 0;
  Box<2> box = square();

  double time() const { return static_cast<double>(step) * dt; }
  double height() const { return box.height(); }
  void advance(Loading& loading) {
    loading.drive(box, loading.approach_speed(box, time(), dt));
    for (Wall<2>& wall : box.walls) wall.point += dt * wall.velocity;
    ++step;
    stress = stiffness * std::log(side / height()) - (loading.holds() ? loss : 0);
    loading.after_step(box, time(), dt, stress, 0);
  }
  void feel(Loading& loading, double given) {  // walls that follow, whatever the stress
    loading.approach_speed(box, time(), dt);
    ++step;
    loading.after_step(box, time(), dt, given, 0);
  }
};

}  // namespace

TEST_CASE("all four walls come in at half the speed, and the top wall alone at the whole") {
  const Case::Loading keys{.wall_velocity = v, .max_strain = 0.2, .unload_at = {}};
  Loading isotropic = loading_of(keys, LoadingPath::isotropic), compaction = loading_of(keys);
  Box<2> all = square(), one = square();
  CHECK(compaction.approach_speed(one, 0, dt) == v);
  isotropic.drive(all, v);
  compaction.drive(one, v);
  const Vec<2> half[] = {{0, v / 2}, {0, -v / 2}, {v / 2, 0}, {-v / 2, 0}}, top[] = {{}, {0, -v}, {}, {}};
  for (int w = 0; w < 4; ++w) {
    CHECK(all.walls[w].velocity == half[w]);
    CHECK(one.walls[w].velocity == top[w]);
  }
}

TEST_CASE("walls that keep a stress bring back what is lost of it, as their damper and the spring say") {
  const Case::Loading keys{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 12e-3, .hold_stress = target};
  Loading loading = loading_of(keys);
  loading.body = {
      .mass = 2, .damper = 4e5, .patience = 1};  // of seconds: it lends nothing, waits for nothing
  Spring spring{.stiffness = 10 * target, .loss = 0.3 * target};
  const std::int64_t planned = loading.steps_planned(dt);
  double progress = 0;
  const auto advance = [&] {
    spring.advance(loading);
    CHECK(loading.progress(spring.time(), dt, planned) >= progress);
    progress = loading.progress(spring.time(), dt, planned);
  };
  while (!loading.holds()) advance();
  const std::int64_t hold_start = spring.step;
  CHECK(spring.stress == doctest::Approx(target).epsilon(2e-3));  // its mean over 0.1 % of strain lags by 1 %
  CHECK(loading.at_turning_point());
  CHECK(loading.number() == 0);
  CHECK(loading.early_end().empty());
  for (int step = 0; step < 0.1e-3 / dt; ++step) advance();  // 20 times m/Z
  CHECK(loading.number() == 1);
  const double lack = target - spring.stress;
  const double height = spring.height();
  const std::int64_t start = spring.step;
  CHECK(lack > 0.2 * target);
  while (target - spring.stress > lack / 4) advance();
  // d(stress)/dt = K v/h, v = (target - stress)/Z
  const double rate = spring.stiffness / ((height + spring.height()) / 2 * loading.body.damper);
  CHECK(rate * dt * static_cast<double>(spring.step - start) == doctest::Approx(std::log(4)).epsilon(0.01));
  while (!loading.finished()) advance();
  CHECK(spring.step - hold_start == std::llround(keys.hold / dt));
  CHECK(progress == 1);
  CHECK(loading.early_end().starts_with("loading.hold_stress was kept for loading.hold"));
  CHECK(loading.outcome().completed);
  CHECK(loading.outcome().shortfall.empty());
}

TEST_CASE("walls that keep a stress move at the speed of loading at most, both ways") {
  const Case::Loading keys{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 3e-3, .hold_stress = target};
  for (const bool lost : {true, false}) {
    Loading loading = loading_of(keys);
    loading.body = {.mass = 10, .damper = 1e5, .patience = 1};
    Spring spring{.stiffness = 10 * target, .loss = (lost ? 5 : -5) * target};
    while (!loading.holds()) spring.advance(loading);
    for (int step = 0; step < 1000; ++step) spring.advance(loading);
    CHECK(loading.approach_speed(spring.box, spring.time(), dt) == doctest::Approx(lost ? v : -v));
  }
}

TEST_CASE("a stress that is not kept is told with its figures, and the loading is not complete") {
  const Case::Loading keys{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 0.2e-3, .hold_stress = target};
  Loading loading = loading_of(keys);
  Spring spring{.stiffness = 0};
  while (!loading.holds()) spring.feel(loading, target);
  for (std::int64_t step = 0; !loading.finished(); ++step)
    spring.feel(loading, step / 500 % 2 == 0 ? 3 * target : 0);
  CHECK_FALSE(loading.outcome().completed);
  // 500 steps of 3, 500 of 0
  CHECK(loading.early_end().find("not kept") != std::string::npos);
  CHECK(loading.early_end().find("1.5 of standard deviation, 3 at most") != std::string::npos);
}

TEST_CASE("a stress that rises evenly ends the run where it is reached, not where its mean gets there") {
  Loading loading =
      loading_of({.wall_velocity = v, .max_strain = 0.3, .max_stress = target, .unload_at = {}});
  Spring spring{.stiffness = 100 * target};
  while (!loading.finished()) spring.advance(loading);
  CHECK(spring.stress == doctest::Approx(target).epsilon(5e-3));  // 1.1 by the mean over 0.1 % of strain
  CHECK(loading.early_end() == "loading.max_stress is reached");
  CHECK(loading.outcome().completed);
}

TEST_CASE("stresses that a loading does not reach are named, with the largest that it met") {
  for (const bool hold : {true, false}) {
    Case::Loading keys{.wall_velocity = v, .max_strain = 0.01, .unload_at = {}};
    (hold ? keys.hold_stress : keys.max_stress) = target;
    if (hold) keys.hold = 0.1e-3;
    Loading loading = loading_of(keys);
    Spring spring{.stiffness = 10 * target};
    CHECK(loading.outcome().shortfall.empty());
    while (!loading.finished()) spring.advance(loading);
    const LoadingOutcome outcome = loading.outcome();
    CHECK(outcome.completed == !hold);  // the last strain is an end that the case names; a hold is left out
    CHECK(outcome.shortfall.starts_with(hold ? "loading.hold_stress of 1e+06 Pa was not reached"
                                             : "loading.max_stress of 1e+06 Pa was not reached"));
    const double largest = std::stod(outcome.shortfall.substr(outcome.shortfall.find("stress was") + 10));
    CHECK(largest == doctest::Approx(1e5).epsilon(0.02));
  }
}

TEST_CASE("a stress that is met while the walls go back is not held") {
  Case::Loading keys{.wall_velocity = v, .max_strain = 0.3, .unload_at = {0.1}, .unload_by = 0.05};
  keys.hold = 0.1e-3;
  keys.hold_stress = target;
  Loading loading = loading_of(keys);
  Spring spring{.stiffness = 0};
  while (!loading.finished()) {
    const double speed = loading.approach_speed(spring.box, spring.time(), dt);
    loading.drive(spring.box, speed);
    for (Wall<2>& wall : spring.box.walls) wall.point += dt * wall.velocity;
    ++spring.step;
    loading.after_step(spring.box, spring.time(), dt, speed < 0 ? 2 * target : 0, 0);
  }
  CHECK_FALSE(loading.holds());
}

TEST_CASE("a stress that is held for no time is refused") {
  CHECK_THROWS_AS(loading_of({.wall_velocity = v, .max_strain = 0.2, .unload_at = {}, .hold_stress = 1e5}),
                  UsageError);
}

TEST_CASE("a given motion is asked once a step, at its beginning, and keeps the shares of the walls") {
  Loading loading = loading_of({}, LoadingPath::isotropic);
  int asked = 0;
  loading.follow({.duration = 1, .velocity = [&](double time) { return ++asked, -2 * time; }});
  CHECK(loading.steps_planned(0.25) == 4);
  Box<2> box = square();
  int steps = 0;
  for (double time = 0; !loading.finished(); time += 0.25, ++steps) {
    const double speed = loading.approach_speed(box, time, 0.25);
    CHECK(speed == 2 * time);
    loading.drive(box, speed);
    for (const Wall<2>& wall : box.walls) CHECK(wall.velocity == Vec<2>{} + speed / 2 * wall.normal);
    loading.after_step(box, time + 0.25, 0.25, 0, 0);
  }
  CHECK(steps == 4);
  CHECK(asked == 4);
}

TEST_CASE("a given motion without an end or without a speed is refused") {
  Loading loading = loading_of({});
  for (const double duration : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    CHECK_THROWS_AS(loading.follow({.duration = duration, .velocity = [](double) { return -1; }}),
                    UsageError);
  loading.follow({.duration = 1, .velocity = [](double) { return std::nan(""); }});
  CHECK_THROWS_AS(loading.approach_speed(square(), 0, 0.5), UsageError);
}

TEST_CASE("a loading goes on from a copy of its state, and one of another case is refused") {
  const Case::Loading keys{.wall_velocity = v,
                           .max_strain = 0.3,
                           .unload_at = {0.01},
                           .unload_by = 0.005,
                           .hold = 1e-3,
                           .hold_stress = target};
  Loading loading = loading_of(keys), other = loading_of(keys);
  loading.body = other.body = {.mass = 2, .damper = 4e5, .patience = 1};
  Spring spring{.stiffness = 10 * target};
  while (!loading.holds()) spring.advance(loading);
  for (int step = 0; step < 100; ++step) spring.advance(loading);
  StateWriter writer;
  loading.visit(writer);
  StateReader reader(writer.arrays);
  other.visit(reader);
  Spring twin = spring;
  while (!loading.finished()) {
    spring.advance(loading);
    twin.advance(other);
  }
  CHECK(other.finished());
  CHECK(twin.height() == spring.height());
  CHECK(other.early_end() == loading.early_end());
  writer.arrays["stage"] = {1, std::vector<std::int64_t>{1000}};
  CHECK_THROWS_AS(other.visit(reader), IoError);
}
