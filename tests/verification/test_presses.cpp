#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/geometry/box.hpp"
#include "softgrain/rigid/step.hpp"
#include "softgrain/soft/elastic_grains.hpp"
#include "softgrain/soft/stable_step.hpp"
#include "support/gravity.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, E = 1e7, density = 1000;

/// A grain of 8 cells between a floor and a press.
template <class Dynamics, class Options>
struct PressedGrain {
  ElasticGrains<Dynamics> model;
  Box<2> box;

  explicit PressedGrain(const Options& options) : model(Dynamics(grain(), walls(), options)), box(walls()) {
    box.presses = {{.share = {0, 1}, .most = 1}};
  }
  static SoftGrains grain() {
    return {{test::placed(test::disk(8), R, {0, R})}, make_law(MaterialLaw::neo_hookean, E, 0.3), density};
  }
  static Box<2> walls() {
    return {test::floor_at(0), {.point = {0, 2.001 * R}, .normal = {0, -1}, .velocity = {}}};
  }
  Press& press() { return box.presses[0]; }
  double height() const { return box.height(); }
  void run(double force, double time, double dt) {
    press().force = force;
    const PressBody body = critically_damped(density, std::sqrt(1.35 * E / density), 2 * R, dt);
    press().mass = body.mass * 2 * R;
    press().damper = body.damper * 2 * R;
    for (int k = 0; k < std::lround(time / dt); ++k) model.step(box, dt);
  }
};

/// What a wall that stops there bears.
double force_at(double height) {
  PressedGrain<ImplicitDynamics, ImplicitOptions> grain({.tolerance = 1e-7});
  grain.box.presses.clear();
  const double dt = 1e-5, time = 2e-3;
  grain.box.walls[1].velocity = {0, (height - grain.height()) / time};
  for (int k = 0; k < std::lround(time / dt); ++k) grain.model.step(grain.box, dt);
  grain.box.walls[1].velocity = {};
  for (int k = 0; k < 200; ++k) grain.model.step(grain.box, dt);
  return grain.box.outward_impulse(1) / dt;
}

template <class Dynamics, class Options>
void check_pressed_grain(const Options& options, double dt) {
  PressedGrain<Dynamics, Options> grain(options);
  const double F = 0.1 * E * R;
  grain.run(F, 3e-3, dt);
  CHECK(std::abs(grain.press().speed) < 1e-3);
  CHECK(grain.box.outward_impulse(1) / dt == doctest::Approx(F).epsilon(0.003));
  CHECK(grain.box.outward_impulse(0) / dt == doctest::Approx(F).epsilon(0.003));
  CHECK(force_at(grain.height()) == doctest::Approx(F).epsilon(0.003));
  // and again and again: no cycle gives energy
  const double work = grain.model.energies().wall_work;
  CHECK(work > 0);
  for (int cycle = 0; cycle < 3; ++cycle) {
    grain.run(0.2 * F, 4e-4, dt);
    const Energies low = grain.model.energies();
    grain.run(F, 4e-4, dt);
    const Energies high = grain.model.energies();
    CHECK(high.wall_work > low.wall_work);
    CHECK(high.wall_work > work * (1 - 0.003));
    CHECK(high.dissipation >= low.dissipation - 0.001 * work);
    CHECK(std::abs(high.error) < 0.002 * work);
  }
}

/// Disks on top of each other under a press, none of which has weight.
RigidDynamics<2> column_under(double F, Precision precision, ContactLaw law = {}) {
  std::vector<Vec<2>> position;
  for (int i = 0; i < 6; ++i) position.push_back({0, (2 * i + 1) * R});
  const std::vector<Wall<2>> walls{test::floor_at(0),
                                   {.point = {0, 12 * R}, .normal = {0, -1}, .velocity = {}}};
  RigidDynamics<2> dynamics(
      rigid_particles<2>(position, std::vector<double>(6, R), std::vector<double>(6, 2e-3), walls),
      test::friction(0.3),
      {.solver = {.max_sweeps = 200000, .tolerance = 1e-12, .velocity_scale = 1},
       .law = law,
       .precision = precision},
      0.1 * R);
  dynamics.particles.presses = {
      {.share = {0, 1}, .force = F, .mass = 1e-2, .damper = 20, .most = 1, .speed = 0.01}};
  return dynamics;
}

}  // namespace

TEST_CASE("a press that touches nothing moves as its mass, damper and force say") {
  Box<2> box = PressedGrain<ImplicitDynamics, ImplicitOptions>::walls();
  box.walls[1].point = {0, 10 * R};
  box.presses = {{.share = {0, 1}, .force = 3, .mass = 0.2, .damper = 5, .most = 0.05, .speed = -0.01}};
  ElasticGrains<ImplicitDynamics> model({PressedGrain<ImplicitDynamics, ImplicitOptions>::grain(), box, {}});
  double v = -0.01, mean = 0, height = box.height(), fade = 0;
  const double dt = 1e-4, tau = 2 * 0.2 / 5;
  for (int k = 0; k < 60; ++k) {
    const double damper = 5 / (1 + fade / tau);
    v = std::min(0.05, (0.2 * v + dt * (3 + damper * std::min(mean, 0.0))) / (0.2 + dt * damper));
    mean += dt / (dt + 10 * tau) * (v - mean);
    height -= dt * v;
    fade += dt;  // nothing bears the force
    model.step(box, dt);
    CHECK(box.presses[0].speed == doctest::Approx(v).epsilon(1e-12));
    CHECK(box.height() == doctest::Approx(height).epsilon(1e-12));
  }
  CHECK(v == 0.05);
}

TEST_CASE("a grain under a press comes to rest where a wall bears the same force, and gives no energy") {
  check_pressed_grain<ImplicitDynamics>(ImplicitOptions{.tolerance = 1e-6}, 2e-6);
  check_pressed_grain<ExplicitDynamics>(
      ExplicitOptions{.damping_share = 0.5},
      stable_time_step(PressedGrain<ExplicitDynamics, ExplicitOptions>::grain(), 0.5));
}

TEST_CASE("every contact of a column of disks bears the force of the press on top") {
  const double F = 7, dt = 1e-4;
  for (const Precision precision : {Precision::full, Precision::single}) {
    RigidDynamics<2> dynamics = column_under(F, precision);
    for (int k = 0; k < 400; ++k) dynamics.step(test::no_force<2>(), dt);
    const double accuracy = precision == Precision::full ? 1e-8 : 1e-4;
    for (int c = 0; c < dynamics.contacts.size(); ++c)
      CHECK(dynamics.contacts.impulse[c][0] / dt == doctest::Approx(F).epsilon(accuracy));
    CHECK(dynamics.contacts.size() == 7);
    CHECK(std::abs(dynamics.particles.presses[0].speed) < 1e-6);
  }
}

TEST_CASE("a press brakes a column as their masses say, and takes it along without making energy") {
  const double dt = 1e-5;
  RigidDynamics<2> dynamics = column_under(0, Precision::full, {.push_out = 0});
  dynamics.particles.walls[0].point = {0, -R};  // the column hangs in the air
  Press& press = dynamics.particles.presses[0];
  press.damper = 1e-9;
  press.speed = 0.5;
  dynamics.step(test::no_force<2>(), dt);
  const double m = 6 * 2e-3, M = press.mass;
  CHECK(press.speed == doctest::Approx(0.5 * M / (M + m)).epsilon(1e-8));
  CHECK(dynamics.wall_impulse(1)[1] == doctest::Approx(M * (0.5 - press.speed)).epsilon(1e-8));
  const double kinetic = kinetic_energy(dynamics.particles);
  CHECK(kinetic == doctest::Approx(0.5 * m * press.speed * press.speed).epsilon(1e-8));
  CHECK(dynamics.work.contact < 0);  // the shock
  CHECK(dynamics.work.wall + dynamics.work.contact == doctest::Approx(kinetic).epsilon(1e-8));
  CHECK(dynamics.work.wall == doctest::Approx(0.5 * M * (0.25 - press.speed * press.speed)).epsilon(1e-8));
}
