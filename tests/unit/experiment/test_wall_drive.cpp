#include "softgrain/experiment/wall_drive.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/isotropic_path.hpp"

using namespace softgrain;

namespace {

constexpr double side = 20e-3, v = 2, dt = 0.1e-6, target = 1e6;
const std::vector<Wall<2>> box{
    {{0, 0}, {0, 1}, {}}, {{0, side}, {0, -1}, {}}, {{0, 0}, {1, 0}, {}}, {{side, 0}, {-1, 0}, {}}};

WallDrive drive_of(const Case::Loading& loading, const char* path = "compaction") {
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
  const WallDrive isotropic = drive_of(loading, "isotropic"), compaction = drive_of(loading);
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

TEST_CASE("a lid that keeps a stress brings back what is lost of it, exponentially") {
  const Case::Loading loading{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 3e-3, .hold_stress = target};
  WallDrive drive = drive_of(loading);
  Spring spring{.stiffness = 10 * target, .loss = 0.5 * target};
  double progress = 0;
  const auto advance = [&] {
    spring.advance(drive);
    CHECK(drive.progress(spring.step) >= progress);
    progress = drive.progress(spring.step);
  };
  while (drive.state.hold_start < 0) advance();
  CHECK(spring.stress == doctest::Approx(target).epsilon(0.02));  // ahead of its mean over 0.1 % of strain
  CHECK(drive.at_turning_point(spring.step));
  CHECK(drive.leg(spring.step - 1) == 0);
  CHECK(drive.leg(spring.step) == 1);
  CHECK(drive.early_end(spring.step).empty());
  for (int step = 0; step < 0.2e-3 / dt; ++step) advance();
  const double lack = target - spring.stress;
  const double height = spring.height;
  const std::int64_t start = spring.step;
  CHECK(lack > 0.3 * target);
  while (target - spring.stress > lack / 4) advance();
  // d(stress)/dt = K v/h (1 - stress/target)
  const double rate = spring.stiffness * v / ((height + spring.height) / 2 * target);
  CHECK(rate * dt * static_cast<double>(spring.step - start) == doctest::Approx(std::log(4)).epsilon(0.01));
  while (!drive.finished(spring.step)) advance();
  CHECK(spring.step - drive.state.hold_start == std::llround(loading.hold / dt));
  CHECK(progress == 1);
  CHECK(spring.step < drive.steps_planned());
  CHECK(drive.early_end(spring.step) == "loading.hold_stress was kept for loading.hold");
}

TEST_CASE("a lid that keeps a stress moves at the speed of loading at most, both ways") {
  const Case::Loading loading{
      .wall_velocity = v, .max_strain = 0.3, .unload_at = {}, .hold = 3e-3, .hold_stress = target};
  for (const bool lost : {true, false}) {
    WallDrive drive = drive_of(loading);
    Spring spring{.stiffness = 10 * target, .loss = (lost ? 5 : -5) * target};
    while (drive.state.hold_start < 0) spring.advance(drive);
    for (int step = 0; step < 1000; ++step) spring.advance(drive);
    CHECK(-drive.approach_speed(spring.step, side - spring.height) == doctest::Approx(lost ? -v : v));
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
