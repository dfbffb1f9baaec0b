#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

/// Two disks of different size that fly at each other, with friction: contact within a few steps.
SoftGrains colliding_pair() {
  return {{test::placed(test::disk(3), 1e-3, {0, 0}, {3, 1}),
           test::placed(test::disk(4), 1.4e-3, {2.42e-3, 0}, {-2, 0.5})},
          make_law(MaterialLaw::neo_hookean, 1e7, 0.3),
          1000};
}

/// Angular momentum about the origin.
double angular_momentum(const SoftGrains& grains) {
  double sum = 0;
  for (const GrainBatch& batch : grains.batches)
    for (std::size_t i = 0; i < batch.position.size(); ++i) {
      const Wide moment =
          batch.position[i][0] * batch.velocity[i][1] - batch.position[i][1] * batch.velocity[i][0];
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
        sum += (grains.node_mass(batch, static_cast<int>(i)) * moment)[lane];
    }
  return sum;
}

template <class Dynamics>
void check_collision(Dynamics dynamics, double dt, int steps, double momentum_error) {
  const Vec<2> start = dynamics.grains.momentum();
  const double spin = angular_momentum(dynamics.grains), energy = dynamics.grains.kinetic_energy();
  int most_contacts = 0;
  for (int k = 0; k < steps; ++k) most_contacts = std::max(most_contacts, dynamics.step(dt).contacts);
  CHECK(most_contacts >= 1);
  CHECK(dynamics.grains.kinetic_energy() < 0.95 * energy);
  CHECK(norm(dynamics.grains.momentum() - start) < momentum_error * norm(start));
  // positions move after forces have acted: angular momentum drifts with dt only
  CHECK(std::abs(angular_momentum(dynamics.grains) - spin) < 0.02 * std::abs(spin));
}

}  // namespace

TEST_CASE("grains that collide keep their momentum to round-off, implicitly") {
  check_collision(ImplicitDynamics(colliding_pair(), {}, {.friction = 0.3}), 1e-6, 40, 1e-13);
}

TEST_CASE("grains that collide keep their momentum to round-off, explicitly") {
  SoftGrains grains = colliding_pair();
  const double dt = stable_time_step(grains);
  check_collision(ExplicitDynamics(std::move(grains), {}, {.friction = 0.3}), dt, static_cast<int>(4e-5 / dt),
                  1e-13);
}

TEST_CASE("one, two and three threads give the same bits") {
  std::vector<GrainPlacement> placed;  // three batches: two rows that fall on each other and on a floor
  for (int g = 0; g < 18; ++g)
    placed.push_back(test::placed(test::disk(g % 3 == 0 ? 3 : 4), 1e-3,
                                  {2.05e-3 * (g % 9), 1.02e-3 + 2.05e-3 * (g / 9)},
                                  {0.1 * g, -1 - 2.0 * (g / 9)}));
  const SoftGrains grains(placed, make_law(MaterialLaw::neo_hookean, 1e6, 0.3), 1000);
  const double dt = stable_time_step(grains);
  const auto outline_after = [](auto dynamics, double step, int steps, int thread_count) {
    set_threads(thread_count);
    int most = 0;
    for (int k = 0; k < steps; ++k) most = std::max(most, dynamics.step(step).contacts);
    CHECK(most > 10);
    std::vector<Vec<2>> x;
    dynamics.grains.gather_outline(x);
    return x;
  };
  const int before = threads();
  const ImplicitDynamics implicit(grains, {test::floor_at(0)}, {.friction = 0.3});
  const ExplicitDynamics explicit_(grains, {test::floor_at(0)}, {.friction = 0.3});
  const auto x = outline_after(implicit, 5e-6, 15, 1), y = outline_after(explicit_, dt, 60, 1);
  for (const int count : {2, 3}) {
    CHECK(outline_after(implicit, 5e-6, 15, count) == x);
    CHECK(outline_after(explicit_, dt, 60, count) == y);
  }
  set_threads(before);
}

TEST_CASE("a free grain falls: backward Euler and symplectic Euler give v = g t") {
  const SoftGrains grains({test::placed(test::disk(2), 1e-3, {0, 0})},
                          make_law(MaterialLaw::hencky, 1e6, 0.3), 1000);
  ImplicitDynamics implicit(grains, {}, {.gravity = {1, -9.81}});
  ExplicitDynamics explicit_(grains, {}, {.gravity = {1, -9.81}});
  for (int k = 0; k < 10; ++k) implicit.step(1e-3);
  const double dt = stable_time_step(grains);
  for (int k = 0; k < 10; ++k) explicit_.step(dt);
  const double mass = grains.mass(0);
  CHECK(implicit.grains.momentum()[0] == doctest::Approx(mass * 1e-2));
  CHECK(implicit.grains.momentum()[1] == doctest::Approx(-mass * 9.81e-2));
  CHECK(explicit_.grains.momentum()[1] == doctest::Approx(-mass * 9.81 * 10 * dt));
}

TEST_CASE("the walls take the momentum that a grain loses") {
  const auto check = [](auto dynamics, double dt, int steps) {
    Vec<2> taken;
    const Vec<2> start = dynamics.grains.momentum();
    for (int k = 0; k < steps; ++k) {
      dynamics.step(dt);
      taken += dynamics.wall_impulse(0);
    }
    CHECK(-taken[1] > 0.5 * norm(start));
    CHECK(std::abs(taken[0]) > 0.05 * norm(start));  // friction
    CHECK(norm(start - dynamics.grains.momentum() - taken) < 1e-11 * norm(start));
  };
  const SoftGrains grains({test::placed(test::disk(4), 1e-3, {0, 1.003e-3}, {1, -2})},
                          make_law(MaterialLaw::neo_hookean, 1e7, 0.3), 1000);
  const double dt = stable_time_step(grains);
  check(ImplicitDynamics(grains, {test::floor_at(0)}, {.wall_friction = 0.3}), 1e-6, 60);
  check(ExplicitDynamics(grains, {test::floor_at(0)}, {.wall_friction = 0.3}), dt,
        static_cast<int>(6e-5 / dt));
}

TEST_CASE(
    "work closes: what walls and gravity give is kinetic, internal, taken by contacts, or by the step") {
  const auto check = [](auto dynamics, double dt, int steps, double tolerance) {
    const double start = dynamics.grains.kinetic_energy();
    for (int k = 0; k < steps; ++k) dynamics.step(dt);
    const WorkBudget& w = dynamics.work;
    const double given = w.walls + w.gravity;
    CHECK(w.walls > 0.2 * given);
    CHECK(std::abs(w.gravity) > 0.01 * given);
    CHECK(w.contacts > 0.01 * given);
    const double taken = dynamics.grains.kinetic_energy() - start + w.internal + w.contacts + w.inertia;
    CHECK(std::abs(given - taken) < tolerance * given);
    // and the internal work is the elastic energy, but for what integration takes of it
    const double elastic = elastic_energy(dynamics.grains, dynamics.grains.batches[0])[0];
    CHECK(elastic == doctest::Approx(w.internal).epsilon(0.1));
  };
  const SoftGrains grains({test::placed(test::disk(4), 1e-3, {0, 1.014e-3}, {0.5, 0})},
                          make_law(MaterialLaw::neo_hookean, 1e6, 0.3), 1000);
  const std::vector<Wall<2>> walls{test::floor_at(0),
                                   {.point = {0, 2.028e-3}, .normal = {0, -1}, .velocity = {0, -1}}};
  const double dt = stable_time_step(grains);
  const Vec<2> gravity{0, -3000};
  check(ImplicitDynamics(grains, walls, {.tolerance = 1e-7, .wall_friction = 0.3, .gravity = gravity}), 2e-6,
        100, 1e-4);
  check(ExplicitDynamics(grains, walls, {.wall_friction = 0.3, .gravity = gravity}), dt,
        static_cast<int>(2e-4 / dt), 1e-11);
}

TEST_CASE("a step that is too long for Newton's method is halved, and the walls end where it should") {
  const SoftGrains grains({test::placed(test::disk(4), 1e-3, {0, 1.02e-3})},
                          make_law(MaterialLaw::neo_hookean, 1e7, 0.3), 1000);
  ImplicitDynamics dynamics(
      grains, {test::floor_at(0), {.point = {0, 2.04e-3}, .normal = {0, -1}, .velocity = {0, -1}}}, {});
  const SoftStepReport report = dynamics.step(1.2e-3);
  CHECK(report.rejected > 0);
  CHECK(report.converged);
  CHECK(dynamics.box.walls[1].point[1] == doctest::Approx(0.84e-3));
  CHECK(report.overlap_max < 1e-3);
}

TEST_CASE("factors in single precision cost no iterations and no accuracy up to their longest step") {
  const SoftGrains grains({test::placed(test::disk(6), 1e-3, {0, 1e-3})},
                          make_law(MaterialLaw::neo_hookean, 1e7, 0.45), 1000);
  ImplicitOptions options{.tolerance = 1e-5};
  const double dt = 0.99 * options.single_precision_steps * stable_time_step(grains, 1);
  const std::vector<Wall<2>> walls{test::floor_at(0),
                                   {.point = {0, 2e-3}, .normal = {0, -1}, .velocity = {0, -0.02e-3 / dt}}};
  ImplicitDynamics single(grains, walls, options);
  options.single_precision_steps = 0;
  ImplicitDynamics full(grains, walls, options);
  for (int step = 0; step < 20; ++step) {
    const SoftStepReport a = single.step(dt), b = full.step(dt);
    CHECK(a.converged);
    CHECK(a.rejected == b.rejected);
    CHECK(a.iterations <= b.iterations + 2);
    // both to 1e-5 of the radius, where the walls have moved by 0.01 to 0.2 of it
    CHECK(single.wall_impulse(1)[1] == doctest::Approx(full.wall_impulse(1)[1]).epsilon(1e-3));
  }
  CHECK(single.wall_impulse(1)[1] != full.wall_impulse(1)[1]);
}

TEST_CASE("a step that no halving saves ends with a NumericalError that names the grain") {
  const SoftGrains grains({test::placed(test::disk(2), 1e-3, {0, 0})},
                          make_law(MaterialLaw::neo_hookean, 1e6, 0.3), 1000);
  std::vector<Wall<2>> walls{test::floor_at(-0.5e-3),
                             {.point = {0, -0.6e-3}, .normal = {0, -1}, .velocity = {}}};
  ImplicitDynamics dynamics(grains, walls, {});
  CHECK_THROWS_AS(dynamics.step(1e-6), NumericalError);
}

TEST_CASE("dynamics without grains or with negative friction is refused") {
  const SoftGrains none({}, make_law(MaterialLaw::hencky, 1, 0.3), 1);
  CHECK_THROWS_AS(ImplicitDynamics(none, {}, {}), UsageError);
  CHECK_THROWS_AS(ExplicitDynamics(none, {}, {}), UsageError);
  CHECK_THROWS_AS(ImplicitDynamics(colliding_pair(), {}, {.friction = -0.1}), UsageError);
  CHECK_THROWS_AS(ExplicitDynamics(colliding_pair(), {}, {.wall_friction = -0.1}), UsageError);
}

TEST_CASE(
    "a grain that walls press hard needs three iterations a step, the term on its outline notwithstanding") {
  const SoftGrains grains({test::placed(test::disk(6), 1e-3, {0, 1e-3})},
                          make_law(MaterialLaw::neo_hookean, 1e7, 0.3), 1000);
  const double dt = 40 * stable_time_step(grains, 1);
  ImplicitDynamics dynamics(
      grains, {test::floor_at(0), {.point = {0, 2e-3}, .normal = {0, -1}, .velocity = {0, -0.02e-3 / dt}}},
      {.tolerance = 1e-5});
  int iterations = 0;
  for (int step = 0; step < 20; ++step) {
    const SoftStepReport report = dynamics.step(dt);
    CHECK(report.rejected == 0);
    iterations += report.iterations;
  }
  CHECK(iterations < 80);  // without the secant 125
}
