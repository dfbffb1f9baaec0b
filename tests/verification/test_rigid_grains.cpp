#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "softgrain/soft/rigid_motion.hpp"
#include "softgrain/soft/rigid_outline.hpp"
#include "support/simulations.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, rho = 2000, g = 9.81;

std::shared_ptr<const Topology> rigid_shape(int vertices = 32) {
  return std::make_shared<const Topology>(rigid_disk(vertices));
}

SoftGrains rigid_grains(std::vector<GrainPlacement> placed) {
  return {std::move(placed), {GrainMaterial{.law = {}, .density = rho, .rigid = true}}};
}

template <class Dynamics>
struct Options;
template <>
struct Options<ImplicitDynamics> {
  using type = ImplicitOptions;
};
template <>
struct Options<ExplicitDynamics> {
  using type = ExplicitOptions;
};
template <class Dynamics>
using OptionsOf = typename Options<Dynamics>::type;

/// Position, velocity and spin of a rigid grain.
struct Motion {
  Vec<2> x, v;
  double spin;
};
Motion motion_of(const SoftGrains& grains, int grain) {
  const auto [batch, lane] = grains.batch_of(grain);
  const RigidTwist twist = rigid_twist(grains, *batch, batch->position, batch->velocity);
  return {test::lane_of(batch->position[0], lane), test::lane_of(twist.velocity, lane), twist.spin[lane]};
}

double mass() { return rho * std::numbers::pi * R * R; }
double inertia() { return mass() * R * R / 2; }
double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

}  // namespace

TEST_CASE("the nodes of a rigid disk weigh rho pi R^2 and turn as a full disk does") {
  const SoftGrains grains = rigid_grains({test::placed(rigid_shape(), R, {3 * R, R})});
  CHECK(grains.mass(0) == doctest::Approx(mass()).epsilon(1e-12));
  const RigidMass all = rigid_mass(grains, grains.batches[0]);
  CHECK(all.mass[0] == doctest::Approx(mass()).epsilon(1e-12));
  CHECK(all.inertia[0] == doctest::Approx(inertia()).epsilon(1e-12));
}

TEST_CASE_TEMPLATE("a free rigid grain keeps its velocity, spin and shape", Dynamics, ImplicitDynamics,
                   ExplicitDynamics) {
  SoftGrains grains = rigid_grains({test::placed(rigid_shape(), R, {0, 0})});
  const RigidTwist start{{0.3, -0.1}, 200.0};
  set_rigid_twist(start, grains.batches[0].position, grains.batches[0].velocity);
  const WideVectors before = grains.batches[0].position;
  Dynamics dynamics(std::move(grains), std::vector<Wall<2>>{}, {});
  for (int k = 0; k < 100; ++k) dynamics.step(1e-4);
  const Motion end = motion_of(dynamics.grains, 0);
  CHECK(norm(end.x - Vec<2>{0.003, -0.001}) < 1e-12 * R);
  CHECK(end.spin == doctest::Approx(200).epsilon(1e-10));
  const double angle = 200 * 0.01;  // two rad
  const Vec<2> first = dynamics.grains.node_position(0, 1) - end.x;
  CHECK(norm(first - R * Vec<2>{std::cos(angle), std::sin(angle)}) < 1e-7 * R);
  CHECK(std::abs(dynamics.work.inertia) + std::abs(dynamics.work.contacts) < 1e-6 * mass() * 0.05);
}

TEST_CASE_TEMPLATE("a rigid disk that slides on a floor ends rolling with two thirds of its speed", Dynamics,
                   ImplicitDynamics, ExplicitDynamics) {
  const double v_0 = 0.3, mu = 0.3, sliding = v_0 / (3 * mu * g), dt = 1e-4;
  OptionsOf<Dynamics> options;
  options.wall_friction = mu;
  options.gravity = {0, -g};
  options.solver.tolerance = 1e-9;
  Dynamics dynamics(rigid_grains({test::placed(rigid_shape(), R, {0, R}, {v_0, 0})}),
                    std::vector<Wall<2>>{test::floor_at(0)}, options);
  for (int k = 0; k < std::lround(0.5 * sliding / dt); ++k) dynamics.step(dt);
  const double t = std::lround(0.5 * sliding / dt) * dt;
  const Motion middle = motion_of(dynamics.grains, 0);
  CHECK(std::abs(middle.v[0] / (v_0 - mu * g * t) - 1) < 2e-3);
  CHECK(std::abs(middle.spin * R / (-2 * mu * g * t) - 1) < 2e-3);
  for (int k = 0; k < std::lround(sliding / dt); ++k) dynamics.step(dt);
  const Motion end = motion_of(dynamics.grains, 0);
  CHECK(std::abs(end.v[0] / (2.0 / 3 * v_0) - 1) < 2e-3);
  CHECK(std::abs(end.spin * R / (-2.0 / 3 * v_0) - 1) < 2e-3);
  CHECK(std::abs(end.x[1] - R) < 2e-4 * R);
  // energy: what is lost is what friction took, 1/6 m v_0^2
  CHECK(std::abs(dynamics.work.friction / (mass() * v_0 * v_0 / 6) - 1) < 5e-3);
}

TEST_CASE_TEMPLATE("two rigid disks that strike each other with friction keep momentum and angular momentum",
                   Dynamics, ImplicitDynamics, ExplicitDynamics) {
  OptionsOf<Dynamics> options;
  options.friction = 0.4;
  options.solver.tolerance = 1e-9;
  const double gap = 1e-3 * R;
  const Vec<2> n{std::cos(0.3), std::sin(0.3)};  // along the line of the centres
  SoftGrains grains = rigid_grains({test::placed(rigid_shape(), R, {0, 0}, {0.5, 0}, 0.1),
                                    test::placed(rigid_shape(), R, (2 * R + gap) * n, {-0.1, 0.2}, 0.6)});
  Dynamics dynamics(std::move(grains), std::vector<Wall<2>>{}, options);
  const auto sums = [&] {
    std::array<double, 3> of{};  // momentum, and angular momentum about the origin
    for (int k = 0; k < 2; ++k) {
      const Motion m = motion_of(dynamics.grains, k);
      for (int d = 0; d < 2; ++d) of[d] += mass() * m.v[d];
      of[2] += mass() * cross(m.x, m.v) + inertia() * m.spin;
    }
    return of;
  };
  const auto before = sums();
  for (int k = 0; k < 20; ++k) dynamics.step(1e-6);
  const auto after = sums();
  const Motion a = motion_of(dynamics.grains, 0), b = motion_of(dynamics.grains, 1);
  for (int d = 0; d < 2; ++d) CHECK(std::abs(after[d] - before[d]) < 1e-9 * mass() * 0.5);
  CHECK(std::abs(after[2] - before[2]) < 2e-4 * mass() * 0.5 * R);
  // plastic along the normal; they turn, and the same way, as friction turns both
  CHECK(std::abs(dot(b.v - a.v, n)) < 0.01);
  CHECK(a.spin == doctest::Approx(b.spin).epsilon(1e-3));
  CHECK(std::abs(a.spin) * R > 0.05);
}

TEST_CASE_TEMPLATE("a rigid disk in the notch of two others presses floor and sides as statics has it",
                   Dynamics, ImplicitDynamics, ExplicitDynamics) {
  // centres 2.4 R apart and 1.6 R higher: the contacts lie at (0.6, 0.8) of the centre
  const double side = 4.4 * R, dt = 1e-4;
  OptionsOf<Dynamics> options;
  options.gravity = {0, -g};
  options.solver.tolerance = 1e-9;
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>) options.tolerance = 1e-8;  // a fall of 1e-4 R
  SoftGrains grains = rigid_grains({test::placed(rigid_shape(), R, {R, R}, {}, 0.05),
                                    test::placed(rigid_shape(48), R, {3.4 * R, R}),
                                    test::placed(rigid_shape(40), R, {2.2 * R, 2.6 * R}, {}, 0.3)});
  Dynamics dynamics(std::move(grains), test::box_walls(side, 0), options);
  for (int k = 0; k < 20; ++k) dynamics.step(dt);
  const double weight = mass() * g;
  CHECK(-dynamics.wall_impulse(0)[1] / dt / weight == doctest::Approx(3).epsilon(1e-4));
  for (const int wall : {2, 3})
    CHECK(std::abs(dynamics.wall_impulse(wall)[0]) / dt / weight == doctest::Approx(0.375).epsilon(1e-3));
  CHECK(norm(motion_of(dynamics.grains, 2).v) < 1e-3 * g * dt);
}

namespace {

constexpr double E = 1e7, nu = 0.3;

/// How much nearer the centre of an elastic disk comes to a rigid one (Johnson, Contact Mechanics, 5.56),
/// from the half-width a^2 = 4 F R*/(pi E*), R* = R/2 and E* = E/(1 - nu^2).
double approach_of_rigid(double F) {
  const double modulus = E / (1 - nu * nu), a = std::sqrt(2 * F * R / (std::numbers::pi * modulus));
  return F / (std::numbers::pi * modulus) * (2 * std::log(4 * R / a) - 1);
}

struct Pressed {
  double top, bottom, approach;
};

/// An elastic disk between two rigid ones, pressed by the top wall: the force on the walls, and half of how
/// much nearer the rigid ones came. angle: of the rigid ones, in segments of their outlines.
template <class Dynamics>
Pressed press_between_rigid(double way, double angle, double speed, double dt, int cells,
                            OptionsOf<Dynamics> options) {
  const double turn = angle * 2 * std::numbers::pi / (4 * cells);
  std::vector<GrainPlacement> placed{test::placed(rigid_shape(4 * cells), R, {0, R}, {}, turn),
                                     test::placed(test::disk(cells), R, {0, 3 * R}),
                                     test::placed(rigid_shape(4 * cells), R, {0, 5 * R}, {}, turn)};
  placed[1].kind = 1;
  Dynamics dynamics(
      SoftGrains(std::move(placed), {GrainMaterial{.law = {}, .density = 1000, .rigid = true},
                                     GrainMaterial{make_law(MaterialLaw::hencky, E, nu), 1000}}),
      {test::floor_at(0), {.point = {0, 6 * R}, .normal = {0, -1}, .velocity = {0, -speed}}}, options);
  for (int k = 0; k < std::lround(way / speed / dt); ++k) dynamics.step(dt);
  return {dynamics.wall_impulse(1)[1] / dt, -dynamics.wall_impulse(0)[1] / dt,
          (4 * R - (motion_of(dynamics.grains, 2).x[1] - motion_of(dynamics.grains, 0).x[1])) / 2};
}

}  // namespace

TEST_CASE("an elastic disk between rigid ones gives way as Johnson says, and the rigid ones not at all") {
  // half a segment and a whole one wide
  for (const auto& [way, angle] : {std::pair(0.03, 0.5), std::pair(0.06, 0.0)}) {
    const Pressed pile =
        press_between_rigid<ImplicitDynamics>(way * R, angle, 0.02, 5e-5, 16, {.tolerance = 1e-7});
    CHECK(pile.bottom == doctest::Approx(pile.top).epsilon(5e-3));
    CHECK(pile.approach / (way / 2 * R) == doctest::Approx(1).epsilon(1e-6));
    CHECK(pile.approach / approach_of_rigid(pile.top) == doctest::Approx(1).epsilon(5e-3));
  }
}

TEST_CASE("rigid grains that fill their box end a run of walls that go on, and say why") {
  for (const Integrator integrator : {Integrator::backward_euler, Integrator::symplectic_euler}) {
    Case c;
    c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::rigid};
    c.mpm.integrator = integrator;
    c.mpm.cells = 4;
    c.loading.wall_velocity = 0.5;
    c.box.width = c.box.height = 4.02e-3;
    for (const double x : {1.005e-3, 3.015e-3})
      for (const double y : {1.005e-3, 3.015e-3})
        c.sample.placed.push_back({.centre = {x, y}, .radius = 1e-3, .angle = 0});
    Simulation simulation = test::simulation_of(complete_sample(c));
    std::string why;
    try {
      while (!simulation.finished()) simulation.step();
    } catch (const NumericalError& error) {
      why = error.what();
    }
    CHECK(why.find("the rigid grains are jammed") == 0);
    CHECK(simulation.box().height() == doctest::Approx(4e-3).epsilon(0.03));  // two diameters
  }
}

TEST_CASE("both integrators press an elastic disk between rigid ones with the same force") {
  const Pressed implicit =
      press_between_rigid<ImplicitDynamics>(0.06 * R, 0, 0.2, 2e-6, 6, {.tolerance = 1e-6, .damping = 2e4});
  const Pressed by_explicit =
      press_between_rigid<ExplicitDynamics>(0.06 * R, 0, 0.2, 2e-6, 6, {.damping = 2e4});
  CHECK(implicit.top > 100);
  CHECK(by_explicit.top / implicit.top == doctest::Approx(1).epsilon(0.01));
  CHECK(by_explicit.bottom / implicit.bottom == doctest::Approx(1).epsilon(0.01));
  CHECK(by_explicit.approach / implicit.approach == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("rigid grains alone that walls press in implicit steps balance their energy") {
  Case c;
  c.experiment = {.loading = LoadingPath::stages, .model = GrainModel::rigid};
  c.mpm.cells = 4;
  c.sample.grains = 8;
  c.contact.friction = 0.3;
  c.loading.wall_velocity = 0.2;
  c.stages = {{.drives = {{Part::yy, Control::stress, 1e5}, {Part::xx, Control::stress, 5e4}},
               .until = {.time = 4e-3}}};
  for (const double friction : {0.3, 0.0}) {
    c.contact.friction = friction;
    Simulation simulation = test::simulation_of(complete_sample(c));
    double error = 0;
    while (!simulation.finished()) {
      simulation.step();
      error = std::max(error, std::abs(test::value_of(row_of(simulation.observe()), "energy_error")));
    }
    const auto row = test::next_row(simulation);
    REQUIRE(test::value_of(row, "wall_work") > 0.01);
    CHECK(error < 0.01 * test::value_of(row, "wall_work"));
  }
}
