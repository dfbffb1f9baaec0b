#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "softgrain/core/error.hpp"
#include "softgrain/rigid/step.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;
using test::Plane;
using test::Space;

namespace {

double frictionless(int, int) { return 0; }

template <int Dim>
void no_force(const RigidParticles<Dim>&, std::span<Vec<Dim>>) {}

/// Bodies that collide, without walls.
template <int Dim>
RigidDynamics<Dim> free_bodies(const RigidStepOptions& options) {
  const auto in_corner = test::random_bodies<Dim>(Dim == 2 ? 7 : 4, 31);
  auto bodies = rigid_particles<Dim>(in_corner.position, in_corner.radius, in_corner.mass, {});
  for (int i = 0; i < bodies.size(); ++i) {
    bodies.velocity[i] = in_corner.velocity[i];
    bodies.spin[i] = in_corner.spin[i];
  }
  return {bodies, test::mixed_friction, options, 0.2};
}

template <int Dim>
Vec<Dim> momentum(const RigidParticles<Dim>& bodies) {
  Vec<Dim> sum;
  for (int i = 0; i < bodies.size(); ++i) sum += bodies.mass[i] * bodies.velocity[i];
  return sum;
}

/// About the origin: sum x x m v + I omega, with I omega = m R s / kappa.
double angular_momentum(const RigidParticles<2>& bodies) {
  double sum = 0;
  for (int i = 0; i < bodies.size(); ++i)
    sum += bodies.mass[i] * (dot(perpendicular(bodies.position[i]), bodies.velocity[i]) +
                             bodies.radius[i] * bodies.spin[i][0] / bodies.inertia_ratio);
  return sum;
}

template <int Dim>
double kinetic_by_definition(const RigidParticles<Dim>& bodies) {
  const double share = Dim == 2 ? 0.5 : 0.4;  // I = share m R^2
  double sum = 0;
  for (int i = 0; i < bodies.size(); ++i)
    sum += 0.5 * bodies.mass[i] *
           (dot(bodies.velocity[i], bodies.velocity[i]) + share * dot(bodies.spin[i], bodies.spin[i]));
  return sum;
}

}  // namespace

TEST_CASE_TEMPLATE("collisions with friction keep the momentum", Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  for (const Precision precision : {Precision::full, Precision::single}) {
    auto dynamics = free_bodies<Dim>({.solver = {}, .law = {}, .precision = precision});
    const Vec<Dim> start = momentum(dynamics.particles);
    int contacts = 0;
    for (int step = 0; step < 100; ++step) contacts += dynamics.step(no_force<Dim>, 0.02).contacts;
    CHECK(contacts > 100);
    CHECK(norm(momentum(dynamics.particles) - start) < 1e-11);
  }
}

TEST_CASE(
    "collisions with friction change the angular momentum only by the torque of friction across the gap") {
  // the impulse acts at R_a n from a and at -R_b n from b, which are the gap apart: dL = gap p_t
  auto dynamics = free_bodies<2>({});
  double expected = angular_momentum(dynamics.particles), torque = 0;
  for (int step = 0; step < 100; ++step) {
    dynamics.step(no_force<2>, 0.02);
    for (int c = 0; c < dynamics.contacts.size(); ++c)
      torque += dynamics.contacts.gap[c] * dynamics.contacts.impulse[c][1];
  }
  CHECK(std::abs(torque) > 1e-3);  // there was something to see
  CHECK(angular_momentum(dynamics.particles) == doctest::Approx(expected + torque).epsilon(1e-12));
}

template <int Dim>
void check_work(Precision precision) {
  RigidDynamics<Dim> dynamics(test::random_bodies<Dim>(Dim == 2 ? 7 : 4, 31), test::mixed_friction,
                              {.solver = {}, .law = {}, .precision = precision}, 0.2);
  Vec<Dim> g;
  g[0] = -0.3, g[1] = -2;
  const auto gravity = [&](const RigidParticles<Dim>& bodies, std::span<Vec<Dim>> force) {
    for (int i = 0; i < bodies.size(); ++i) force[i] += bodies.mass[i] * g;
  };
  const auto fall = [&] {
    double sum = 0;
    for (int i = 0; i < dynamics.particles.size(); ++i)
      sum += dynamics.particles.mass[i] * dot(g, dynamics.particles.position[i]);
    return sum;
  };
  double wall_work = 0;
  for (int step = 0; step < 100; ++step) {
    const double kinetic = kinetic_by_definition(dynamics.particles), fallen = fall();
    const Vec<Dim> sum = momentum(dynamics.particles);
    dynamics.step(gravity, 0.02);
    const StepWork& work = dynamics.work;
    REQUIRE(work.force == doctest::Approx(fall() - fallen).epsilon(1e-11));
    REQUIRE(work.force + work.wall + work.contact ==
            doctest::Approx(kinetic_by_definition(dynamics.particles) - kinetic).epsilon(1e-10));
    // a wall pushes with minus what it receives, along its own way
    Vec<Dim> on_walls;
    double by_walls = 0;
    for (int w = 0; w < Dim; ++w) {
      on_walls += dynamics.wall_impulse(w);
      by_walls -= dot(dynamics.wall_impulse(w), dynamics.particles.walls[w].velocity);
    }
    Vec<Dim> weight;
    for (const double m : dynamics.particles.mass) weight += 0.02 * m * g;
    REQUIRE(norm(momentum(dynamics.particles) - sum - weight + on_walls) < 1e-10);
    REQUIRE(work.wall == doctest::Approx(by_walls).epsilon(1e-12));
    wall_work += work.wall;
  }
  CHECK(std::abs(wall_work) > 1);
}

TEST_CASE("force, walls and contacts do the work that changes the kinetic energy") {
  check_work<2>(Precision::full);
  check_work<2>(Precision::single);
  check_work<3>(Precision::full);
}

TEST_CASE("an anticipated contact lets a gap close within the step but not cross") {
  const Wall<2> floor{.point = {0, 0}, .normal = {0, 1}, .velocity = {}};
  for (const auto activation : {Activation::anticipated, Activation::closed_at_mid_step}) {
    auto disk = rigid_particles<2>({{0, 1.3}}, {1}, {1}, {floor});
    disk.velocity[0] = {0, -1};
    RigidDynamics<2> dynamics(disk, frictionless, {.solver = {}, .law = {.activation = activation}}, 0.5);
    const double dt = 0.4;  // at mid-step the gap is 0.1, after the next half step -0.1
    dynamics.step(no_force<2>, dt);
    const double gap = 0.3 - 1 * dt / 2, speed = activation == Activation::anticipated ? gap / dt : 1;
    CHECK(dynamics.particles.velocity[0][1] == doctest::Approx(-speed).epsilon(1e-14));
    CHECK(dynamics.particles.position[0][1] == doctest::Approx(1 + gap - speed * dt / 2).epsilon(1e-14));
  }
}

TEST_CASE("push-out removes its share of an overlap in a step") {
  auto disks = rigid_particles<2>({{0, 0}, {1.9, 0}}, {1, 1}, {1, 3}, {});
  RigidDynamics<2> dynamics(disks, frictionless, {.solver = {}, .law = {.push_out = 0.2}}, 0.5);
  dynamics.step(no_force<2>, 0.01);
  CHECK(dynamics.contacts.gap[0] == doctest::Approx(-0.1).epsilon(1e-14));
  dynamics.step(no_force<2>, 0.01);
  CHECK(dynamics.contacts.gap[0] == doctest::Approx(-0.08).epsilon(1e-12));
}

TEST_CASE("the report counts the contacts that push and measures their overlap by the mean radius") {
  // disks 0 and 1 overlap by 0.1 and 1 and 2 by 0.02; 3 meets 2 within the step; 4 overlaps 3 but flies away
  auto disks = rigid_particles<2>({{0, 0}, {1.9, 0}, {4.88, 0}, {8.9, 0}, {11.2, 0}}, {1, 1, 2, 2, 1.5},
                                  {1, 1, 1, 1, 1}, {});
  disks.velocity[3] = {-3, 0};
  disks.velocity[4] = {200, 0};
  RigidDynamics<2> dynamics(disks, frictionless, {}, 3);
  const StepReport report = dynamics.step(no_force<2>, 0.01);
  CHECK(report.contacts == 3);
  CHECK(report.overlap_max == doctest::Approx(0.1 / 1.5).epsilon(1e-12));
  CHECK(report.overlap_mean == doctest::Approx(0.12 / 3 / 1.5).epsilon(1e-12));
  CHECK(report.converged);
}

TEST_CASE("a residual is the overlap that a contact would gain in the step over the mean diameter") {
  const double dt = 0.01, closing = 0.7;
  auto disks = rigid_particles<2>({{0, 0}, {2.99, 0}}, {1, 2}, {1, 5}, {});
  disks.velocity[1] = {-closing, 0};
  RigidDynamics<2> dynamics(disks, frictionless, {.solver = {.max_sweeps = 1}, .law = {.push_out = 0}}, 0.5);
  const StepReport report = dynamics.step(no_force<2>, dt);
  CHECK(report.residual_max == doctest::Approx(closing * dt / 3).epsilon(1e-12));
  CHECK(report.residual_mean == doctest::Approx(closing * dt / 3).epsilon(1e-12));
  CHECK_FALSE(report.converged);
}

TEST_CASE("warm start solves a resting column in one sweep") {
  std::vector<Vec<2>> position;
  for (int i = 0; i < 10; ++i) position.push_back({0, 1.0 + 2 * i});
  const Wall<2> floor{.point = {0, 0}, .normal = {0, 1}, .velocity = {}};
  RigidDynamics<2> dynamics(
      rigid_particles<2>(position, std::vector<double>(10, 1), std::vector<double>(10, 1), {floor}),
      frictionless, {.solver = {.max_sweeps = 100000, .tolerance = 1e-10}, .law = {}}, 0.5);
  const auto gravity = [](const auto&, auto force) {
    for (Vec<2>& f : force) f[1] -= 9.81;
  };
  CHECK(dynamics.step(gravity, 1e-3).sweeps > 50);
  for (int step = 0; step < 20; ++step) dynamics.step(gravity, 1e-3);
  CHECK(dynamics.step(gravity, 1e-3).sweeps == 1);
}

TEST_CASE("a disk that slides until it rolls loses a third of its energy to friction, and none else") {
  // from v_0 to 2/3 v_0 with v = R omega: m v_0^2/2 - 3/4 m (2/3 v_0)^2 = m v_0^2/6
  constexpr double v_0 = 3, mass = 2;
  const Wall<2> floor{.point = {0, 0}, .normal = {0, 1}, .velocity = {}};
  RigidDynamics<2> dynamics(
      rigid_particles<2>({{0, 1}}, {1}, {mass}, {floor}), [](int, int) { return 0.3; },
      {.solver = {.max_sweeps = 100, .tolerance = 1e-12}, .law = {}}, 0.5);
  dynamics.particles.velocity[0] = {v_0, 0};
  const auto gravity = [](const auto&, auto force) { force[0][1] -= 9.81 * mass; };
  double friction = 0, between = 0, all = 0;
  for (int step = 0; step < 600; ++step) {
    dynamics.step(gravity, 1e-3);
    friction += dynamics.work.friction;
    between += dynamics.work.between;
    all += dynamics.work.contact;
  }
  CHECK(dynamics.particles.velocity[0][0] == doctest::Approx(2 * v_0 / 3));
  CHECK(friction == doctest::Approx(-mass * v_0 * v_0 / 6));
  CHECK(between == doctest::Approx(friction));
  CHECK(all == doctest::Approx(friction));
}

TEST_CASE("what contacts inside a grain take is not counted as between grains") {
  // two pairs of disks; one pair collides inside its grain, then the grains meet
  auto disks = rigid_particles<2>({{0, 0}, {2.01, 0}, {9, 0}, {11.02, 0}}, {1, 1, 1, 1}, {1, 1, 1, 1}, {});
  disks.grain = {0, 0, 1, 1};
  disks.velocity[0] = {1, 0};
  RigidDynamics<2> dynamics(std::move(disks), frictionless,
                            {.solver = {.max_sweeps = 1000, .tolerance = 1e-12}, .law = {}}, 0.5);
  const auto pass = [&](int steps) {
    double between = 0, all = 0;
    for (int step = 0; step < steps; ++step) {
      dynamics.step(no_force<2>, 0.01);
      between += dynamics.work.between, all += dynamics.work.contact;
    }
    return std::array<double, 2>{between, all};
  };
  const auto inside = pass(100);  // both go on with 1/2
  CHECK(inside[0] == 0);
  CHECK(inside[1] == doctest::Approx(-0.25));
  const auto outside = pass(1500);  // three with 1/3, then four with 1/4: from 1/4 to 1/8
  CHECK(outside[1] == doctest::Approx(-0.125));
  CHECK(outside[0] < -0.05);
  CHECK(outside[0] > outside[1]);
}

TEST_CASE("coincident centres and forces that are not finite end with a NumericalError") {
  auto twins = rigid_particles<2>({{0, 0}, {0, 0}}, {1, 1}, {1, 1}, {});
  for (const Precision precision : {Precision::full, Precision::single}) {
    RigidDynamics<2> coincident(twins, frictionless, {.solver = {}, .law = {}, .precision = precision}, 0.5);
    CHECK_THROWS_AS(coincident.step(no_force<2>, 0.01), NumericalError);
  }

  RigidDynamics<2> pulled(rigid_particles<2>({{0, 0}, {9, 0}}, {1, 1}, {1, 1}, {}), frictionless, {}, 0.5);
  const auto infinite = [](const auto&, auto force) {
    force[1][0] = std::numeric_limits<double>::infinity();
  };
  CHECK_THROWS_WITH_AS(pulled.step(infinite, 0.01),
                       "the velocity of particle 1 is not finite; use a smaller time step", NumericalError);
}

TEST_CASE("options out of range are refused with their name and value") {
  const auto make = [](const ContactLaw& law, double skin) {
    RigidDynamics<2>(rigid_particles<2>({{0, 0}}, {1}, {1}, {}), frictionless, {.solver = {}, .law = law},
                     skin);
  };
  CHECK_THROWS_WITH_AS(make({.restitution = 1.5}, 0.1), "restitution must be in [0, 1], got 1.5", UsageError);
  CHECK_THROWS_WITH_AS(make({.push_out = -1}, 0.1), "push-out must be in [0, 1], got -1", UsageError);
  CHECK_THROWS_WITH_AS(make({}, 0), "skin must be > 0, got 0 m", UsageError);
  CHECK_THROWS_AS(make({.restitution = 0.5}, 0.1), UsageError);  // anticipation stops before the touch
  CHECK_NOTHROW(make({.restitution = 0.5, .activation = Activation::closed_at_mid_step}, 0.1));
}
