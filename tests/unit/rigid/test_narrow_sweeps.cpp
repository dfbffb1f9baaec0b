#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/rigid/narrow_sweeps.hpp"
#include "softgrain/rigid/step.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;

namespace {

constexpr double rounding = 3e-6;  // of some sweeps over numbers of about 1 in single precision

double frictionless(int, int) { return 0; }

template <int Dim>
NarrowSweepsOf<Dim> started(const test::ContactScene<Dim>& scene, double relaxation) {
  NarrowSweepsOf<Dim> narrow;
  narrow.start(
      scene.bodies, scene.contacts, [](int, int) {}, scene.offset, relaxation);
  return narrow;
}

template <int Dim>
double largest_difference(const NarrowSweepsOf<Dim>& narrow, const test::ContactScene<Dim>& scene) {
  std::vector<Vec<Dim>> impulse(scene.contacts.size());
  for (const ContactBlock& block : scene.contacts.blocks) narrow.read_impulses(block, impulse);
  double largest = 0;
  for (int c = 0; c < scene.contacts.size(); ++c)
    largest = std::max(largest, norm(impulse[c] - scene.contacts.impulse[c]));
  return largest;
}

/// Bodies along a side of a scene.
template <int Dim>
constexpr int side = Dim == 2 ? 9 : 5;

}  // namespace

TEST_CASE_TEMPLATE("sweeps in single precision find the impulses and violations of the plain sweep",
                   Dimension, test::Plane, test::Space) {
  constexpr int Dim = Dimension::value;
  for (const FrictionRule& friction : {FrictionRule(frictionless), FrictionRule(test::mixed_friction)}) {
    for (const double relaxation : {1.0, 1.3}) {
      test::ContactScene<Dim> plain(side<Dim>, friction);
      NarrowSweepsOf<Dim> narrow = started(plain, relaxation);
      auto system = plain.system();
      for (int sweep = 0; sweep < 5; ++sweep) {
        const Violation by_narrow = narrow.sweep(true);
        const Violation by_plain =
            system.sweep(plain.contacts.impulse, plain.contacts.friction, {.relaxation = relaxation});
        CHECK(by_narrow.sum_of_squares == doctest::Approx(by_plain.sum_of_squares).epsilon(1e-5));
        CHECK(by_narrow.max_square == doctest::Approx(by_plain.max_square).epsilon(1e-5));
        CHECK(by_narrow.contacts == by_plain.contacts);
        CHECK(largest_difference(narrow, plain) < rounding);
      }
    }
  }
}

TEST_CASE_TEMPLATE("sweeps in single precision go on from the impulses of the step before", Dimension,
                   test::Plane, test::Space) {
  constexpr int Dim = Dimension::value;
  test::ContactScene<Dim> plain(side<Dim>);
  auto system = plain.system();
  test::RandomNumbers random(3);
  for (Vec<Dim>& p : plain.contacts.impulse) {
    p[0] = random.uniform(0, 0.1);
    for (int k = 1; k < Dim; ++k) p[k] = 0.2 * p[0];
  }
  for (const ContactBlock& block : plain.contacts.blocks)
    for (int c = block.frictionless.begin; c < block.frictionless.end; ++c)
      plain.contacts.impulse[c] = Vec<Dim>{plain.contacts.impulse[c][0]};
  NarrowSweepsOf<Dim> narrow = started(plain, 1);
  system.apply_impulses(plain.contacts.impulse);
  const Violation violation = narrow.sweep(true);
  CHECK(violation.contacts == system.sweep(plain.contacts.impulse, plain.contacts.friction, {}).contacts);
  CHECK(largest_difference(narrow, plain) < rounding);
}

TEST_CASE_TEMPLATE("sweeps in single precision follow lists that were made again, and another relaxation",
                   Dimension, test::Plane, test::Space) {
  constexpr int Dim = Dimension::value;
  test::ContactScene<Dim> first(side<Dim>), second(side<Dim>, frictionless);
  for (ContactBlock& block : second.contacts.blocks) block.made = 7;
  NarrowSweepsOf<Dim> narrow = started(first, 1);
  const auto run = [&](test::ContactScene<Dim>& scene, double relaxation) {
    narrow.start(
        scene.bodies, scene.contacts, [](int, int) {}, scene.offset, relaxation);
    auto system = scene.system();
    system.apply_impulses(scene.contacts.impulse);
    for (int sweep = 0; sweep < 3; ++sweep) {
      narrow.sweep(false);
      system.sweep(scene.contacts.impulse, scene.contacts.friction, {.relaxation = relaxation});
    }
    CHECK(largest_difference(narrow, scene) < rounding);
  };
  run(second, 1);
  run(second, 1.5);
}

TEST_CASE(
    "a step in single precision leaves the velocities that its impulses give, and prepares each contact") {
  const Wall<2> floor{.point = {0, 0}, .normal = {0, 1}, .velocity = {}};
  const auto drop = [&](Precision precision) {
    auto disk = rigid_particles<2>({{0, 1.02}}, {1}, {2}, {floor});
    disk.velocity[0] = {0.5, -1};
    RigidDynamics<2> dynamics(
        disk, [](int, int) { return 0.3; },
        {.solver = {.tolerance = 1e-7}, .law = {}, .precision = precision}, 0.5);
    dynamics.step([](const RigidParticles<2>&, std::span<Vec<2>>) {}, 0.1);
    return dynamics;
  };
  const auto single = drop(Precision::single), full = drop(Precision::full);
  // the gap of 0.02 - 0.05 at mid-step is an overlap of 0.03, of which a tenth goes: v = 0.003 / 0.1
  CHECK(single.particles.velocity[0][1] == doctest::Approx(0.03).epsilon(1e-6));
  CHECK(single.contacts.gap[0] == doctest::Approx(-0.03).epsilon(1e-12));
  CHECK(norm(single.particles.velocity[0] - full.particles.velocity[0]) < 1e-6);
  CHECK(std::abs(single.particles.spin[0][0] - full.particles.spin[0][0]) < 1e-6);
  const Vec<2> p = single.contacts.impulse[0];
  CHECK(single.particles.velocity[0][1] == doctest::Approx(-1 + p[0] / 2).epsilon(1e-15));
}
