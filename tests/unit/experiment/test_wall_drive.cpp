#include "softgrain/experiment/wall_drive.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/isotropic_path.hpp"

using namespace softgrain;

namespace {

constexpr double side = 20e-3, v = 2, dt = 0.1e-6, target = 1e6;
const std::vector<Wall<2>> box{
    {{0, 0}, {0, 1}, {}}, {{0, side}, {0, -1}, {}}, {{0, 0}, {1, 0}, {}}, {{side, 0}, {-1, 0}, {}}};

WallDrive drive_of(const Case::Loading& loading, LoadingPath path = LoadingPath::compaction) {
  Case c;
  c.experiment.loading = path;
  c.loading = loading;
  c.sample.packing_fraction = 0.6;
  return {loading, box_path(c, side, dt), dt};
}

/// A spring between bottom and lid that loses `loss` [Pa] when the lid leaves its path.
struct Spring {
  double stiffness, loss = 0;
  double height = side, stress = 0;
  std::int64_t step = 0;
  void advance(WallDrive& drive) {
    const double speed = drive.approach_speed(step, side - height);
    height += dt * (drive.velocity(box[1], 1, speed)[1] - drive.velocity(box[0], 0, speed)[1]);
    ++step;
    stress = stiffness * std::log(side / height) - (drive.state.hold_start >= 0 ? loss : 0);
    drive.watch(stress, height, step);
  }
};

}  // namespace

TEST_CASE("all four walls come in at half the speed, and the lid alone at the whole") {
  const Case::Loading loading{.wall_velocity = v, .max_strain = 0.2, .unload_at = {}};
  const WallDrive isotropic = drive_of(loading, LoadingPath::isotropic), compaction = drive_of(loading);
  CHECK(compaction.approach_speed(0, 0) == v);
  const Vec<2> half[] = {{0, v / 2}, {0, -v / 2}, {v / 2, 0}, {-v / 2, 0}}, lid[] = {{}, {0, -v}, {}, {}};
  for (int w = 0; w < 4; ++w) {
    for (int k = 0; k < 2; ++k) {
      CHECK(isotropic.velocity(box[w], w, v)[k] == half[w][k]);
      CHECK(compaction.velocity(box[w], w, v)[k] == lid[w][k]);
    }
  }
}

TEST_CASE(
    "an isotropic path ends where undeformed grains fill the box as asked, and leaves out later "
    "turns") {
  Case::Loading loading{.wall_velocity = v, .max_strain = 0.4, .unload_at = {0.1, 0.3}};
  loading.max_packing_fraction = 0.9;
  const IsotropicPath path(loading, side, dt, 0.6);
  double h = side;
  for (std::int64_t step = 0; step < path.steps(); ++step) h += dt * path.plate_velocity(step, side - h);
  CHECK(0.6 * side * side / (h * h) == doctest::Approx(0.9).epsilon(1e-9));
  CHECK(path.strain(side, h) == doctest::Approx(std::log(1.5) / 2).epsilon(1e-9));
  CHECK(path.leg(path.steps() - 1) == 2);
  loading.max_packing_fraction = 2;  // later than max_strain
  CHECK(IsotropicPath(loading, side, dt, 0.6).leg(1 << 30) == 4);
}

TEST_CASE("a lid that keeps a stress brings back what is lost of it, as its damper and the spring say") {
  const Case::Loading loading{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 12e-3, .hold_stress = target};
  WallDrive drive = drive_of(loading);
  drive.plates = {
      .mass = 2, .damper = 4e5, .patience = 1};  // of seconds: it lends nothing, waits for nothing
  Spring spring{.stiffness = 10 * target, .loss = 0.3 * target};
  double progress = 0;
  const auto advance = [&] {
    spring.advance(drive);
    CHECK(drive.progress(spring.step) >= progress);
    progress = drive.progress(spring.step);
  };
  while (drive.state.hold_start < 0) advance();
  CHECK(spring.stress == doctest::Approx(target).epsilon(2e-3));  // its mean over 0.1 % of strain lags by 1 %
  CHECK(drive.at_turning_point(spring.step));
  CHECK(drive.leg(spring.step - 1) == 0);
  CHECK(drive.leg(spring.step) == 1);
  CHECK(drive.early_end(spring.step).empty());
  for (int step = 0; step < 0.1e-3 / dt; ++step) advance();  // 20 times m/Z
  const double lack = target - spring.stress;
  const double height = spring.height;
  const std::int64_t start = spring.step;
  CHECK(lack > 0.2 * target);
  while (target - spring.stress > lack / 4) advance();
  // d(stress)/dt = K v/h, v = (target - stress)/Z
  const double rate = spring.stiffness / ((height + spring.height) / 2 * drive.plates.damper);
  CHECK(rate * dt * static_cast<double>(spring.step - start) == doctest::Approx(std::log(4)).epsilon(0.01));
  while (!drive.finished(spring.step)) advance();
  CHECK(spring.step - drive.state.hold_start == std::llround(loading.hold / dt));
  CHECK(progress == 1);
  CHECK(drive.early_end(spring.step).starts_with("loading.hold_stress was kept for loading.hold"));
  CHECK(drive.outcome(spring.step).completed);
  CHECK(drive.outcome(spring.step).shortfall.empty());
}

TEST_CASE("a lid that keeps a stress moves at the speed of loading at most, both ways") {
  const Case::Loading loading{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 3e-3, .hold_stress = target};
  for (const bool lost : {true, false}) {
    WallDrive drive = drive_of(loading);
    drive.plates = {.mass = 10, .damper = 1e5, .patience = 1};
    Spring spring{.stiffness = 10 * target, .loss = (lost ? 5 : -5) * target};
    while (drive.state.hold_start < 0) spring.advance(drive);
    for (int step = 0; step < 1000; ++step) spring.advance(drive);
    CHECK(drive.approach_speed(spring.step, side - spring.height) == doctest::Approx(lost ? v : -v));
  }
}

TEST_CASE("a stress that is not kept is told with its figures, and the path is not complete") {
  const Case::Loading loading{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 0.2e-3, .hold_stress = target};
  WallDrive drive = drive_of(loading);
  std::int64_t step = 0;
  while (drive.state.hold_start < 0) drive.watch(target, side, ++step);
  while (!drive.finished(step)) {
    drive.watch(step / 500 % 2 == 0 ? 3 * target : 0, side, step + 1);
    ++step;
  }
  CHECK_FALSE(drive.outcome(step).completed);
  CHECK(drive.early_end(step).find("not kept") != std::string::npos);
  // 500 steps of 3, 500 of 0
  CHECK(drive.state.held.mean() == doctest::Approx(1.5).epsilon(0.1));
  CHECK(drive.state.held.deviation() == doctest::Approx(1.5).epsilon(0.01));
  CHECK(drive.state.held.largest == doctest::Approx(3));
}

TEST_CASE("a stress that rises evenly ends the run where it is reached, not where its mean gets there") {
  const Case::Loading loading{.wall_velocity = v, .max_strain = 0.3, .max_stress = target, .unload_at = {}};
  WallDrive drive = drive_of(loading);
  Spring spring{.stiffness = 100 * target};
  while (!drive.finished(spring.step)) spring.advance(drive);
  CHECK(spring.stress == doctest::Approx(target).epsilon(5e-3));  // 1.1 by the mean over 0.1 % of strain
  CHECK(drive.early_end(spring.step) == "loading.max_stress is reached");
  CHECK(drive.outcome(spring.step).completed);
}

TEST_CASE("stresses that a path does not reach are named, with the largest that it met") {
  for (const bool hold : {true, false}) {
    Case::Loading loading{.wall_velocity = v, .max_strain = 0.01, .unload_at = {}};
    (hold ? loading.hold_stress : loading.max_stress) = target;
    if (hold) loading.hold = 0.1e-3;
    WallDrive drive = drive_of(loading);
    Spring spring{.stiffness = 10 * target};
    CHECK(drive.outcome(0).shortfall.empty());
    while (!drive.finished(spring.step)) spring.advance(drive);
    const PathOutcome outcome = drive.outcome(spring.step);
    CHECK(outcome.completed == !hold);  // the last strain is an end that the case names; a hold is left out
    CHECK(outcome.shortfall.starts_with(hold ? "loading.hold_stress of 1e+06 Pa was not reached"
                                             : "loading.max_stress of 1e+06 Pa was not reached"));
    CHECK(drive.state.largest == doctest::Approx(1e5).epsilon(0.02));
  }
}

TEST_CASE("a stress that is met while the lid goes back is not held") {
  Case::Loading loading{.wall_velocity = v, .max_strain = 0.3, .unload_at = {0.1}, .unload_by = 0.05};
  loading.hold = 0.1e-3;
  loading.hold_stress = target;
  WallDrive drive = drive_of(loading);
  for (std::int64_t step = 0; step < drive.steps_planned(); ++step) {
    const bool goes_back = drive.leg(step) == 2;
    drive.watch(goes_back ? 2 * target : 0, side, step + 1);
  }
  CHECK(drive.state.hold_start < 0);
}

TEST_CASE("a stress that is held for no time is refused") {
  CHECK_THROWS_AS(drive_of({.wall_velocity = v, .max_strain = 0.2, .unload_at = {}, .hold_stress = 1e5}),
                  UsageError);
}
