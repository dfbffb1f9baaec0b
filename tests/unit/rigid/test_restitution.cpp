#include <doctest/doctest.h>

#include <utility>

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
double kinetic_by_definition(const RigidParticles<Dim>& bodies) {
  const double share = Dim == 2 ? 0.5 : 0.4;  // I = share m R^2
  double sum = 0;
  for (int i = 0; i < bodies.size(); ++i)
    sum += 0.5 * bodies.mass[i] *
           (dot(bodies.velocity[i], bodies.velocity[i]) + share * dot(bodies.spin[i], bodies.spin[i]));
  return sum;
}

template <int Dim>
void check_dissipation(const ContactLaw& law) {
  CAPTURE(law.restitution);
  auto dynamics = free_bodies<Dim>({.solver = {.max_sweeps = 5000, .tolerance = 1e-12}, .law = law});
  double dissipated = 0;
  for (int step = 0; step < 60; ++step) {
    dynamics.step(no_force<Dim>, 0.02);
    REQUIRE(dynamics.work.contact < 1e-9);
    REQUIRE(dynamics.work.push_out == 0);
    dissipated -= dynamics.work.contact;
  }
  CHECK(dissipated > (law.restitution < 1 ? 0.1 : -1e-9));
}

}  // namespace

TEST_CASE_TEMPLATE("contacts dissipate: without forces they never do work, unless anticipated ones push out",
                   Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  check_dissipation<Dim>({.push_out = 0});
  for (const auto rule : {Activation::closed_at_mid_step, Activation::closed_at_end_of_step})
    for (const double e : {0.0, 0.5, 0.95, 1.0})
      for (const double push_out : {0.0, 0.5})
        check_dissipation<Dim>({.restitution = e, .push_out = push_out, .activation = rule});
}

TEST_CASE(
    "contacts closed at the end of the step act where q + h v <= 0, those closed at mid-step where q + h v/2 "
    "<= 0") {
  // q = 0.3 and v = -1 at the start: closed at mid-step from h = 0.6 on, at the end from h = 0.3 on
  const Wall<2> floor{.point = {0, 0}, .normal = {0, 1}, .velocity = {}};
  const double q = 0.3, v = 1, e = 0.5;
  for (const auto& [rule, closes_at] : {std::pair(Activation::closed_at_end_of_step, q / v),
                                        std::pair(Activation::closed_at_mid_step, 2 * q / v)})
    for (const double h : {0.1, 0.29, 0.31, 0.59, 0.61}) {
      CAPTURE(h);
      auto disk = rigid_particles<2>({{0, 1 + q}}, {1}, {2}, {floor});
      disk.velocity[0] = {0, -v};
      RigidDynamics<2> dynamics(disk, frictionless,
                                {.solver = {}, .law = {.restitution = e, .push_out = 0, .activation = rule}},
                                2);
      dynamics.step(no_force<2>, h);
      const bool closed = h > closes_at;
      const double after = closed ? e * v : -v;
      CHECK(dynamics.particles.velocity[0][1] == after);
      CHECK(dynamics.particles.position[0][1] ==
            doctest::Approx(1 + q - v * h / 2 + after * h / 2).epsilon(1e-15));
      CHECK(-dynamics.wall_impulse(0)[1] == doctest::Approx(closed ? 2 * (1 + e) * v : 0).epsilon(1e-15));
    }
}

TEST_CASE("a contact that has opened at mid-step forgets its impulse, so that flight takes one sweep") {
  const Wall<2> floor{.point = {0, 0}, .normal = {0, 1}, .velocity = {}};
  auto disk = rigid_particles<2>({{0, 1.001}}, {1}, {1}, {floor});
  disk.velocity[0] = {0, -1};
  const ContactLaw elastic{.restitution = 1, .push_out = 0, .activation = Activation::closed_at_mid_step};
  RigidDynamics<2> dynamics(disk, frictionless, {.solver = {}, .law = elastic}, 0.5);
  CHECK(dynamics.step(no_force<2>, 0.004).contacts == 1);
  REQUIRE(dynamics.particles.velocity[0][1] == doctest::Approx(1).epsilon(1e-14));
  const StepReport flight = dynamics.step(no_force<2>, 0.004);
  CHECK(flight.sweeps == 1);
  CHECK(flight.contacts == 0);
}

TEST_CASE("contacts that exist only when closed push out positions and leave velocities alone") {
  for (const auto rule : {Activation::closed_at_mid_step, Activation::closed_at_end_of_step}) {
    auto disks = rigid_particles<2>({{0, 0}, {1.9, 0}}, {1, 1}, {1, 3}, {});
    RigidDynamics<2> dynamics(disks, frictionless,
                              {.solver = {}, .law = {.restitution = 1, .push_out = 0.2, .activation = rule}},
                              0.5);
    dynamics.step(no_force<2>, 0.01);
    const auto& x = dynamics.particles.position;
    CHECK(x[1][0] - x[0][0] == doctest::Approx(2 - 0.08).epsilon(1e-12));
    CHECK(x[0][0] + 3 * x[1][0] == doctest::Approx(3 * 1.9).epsilon(1e-12));  // the centre of mass stays
    CHECK(dynamics.particles.velocity[0] == Vec<2>{});
    CHECK(dynamics.particles.velocity[1] == Vec<2>{});
  }
}

TEST_CASE("a row of overlapping disks that one hits with e = 1 keeps its energy while it is pushed out") {
  std::vector<Vec<2>> row;
  for (int i = 0; i < 6; ++i) row.push_back({1.95 * i, 0});
  auto disks = rigid_particles<2>(row, std::vector<double>(6, 1), {1, 2, 1, 3, 1, 1}, {});
  disks.velocity[0] = {1, 0};
  RigidDynamics<2> dynamics(
      disks, frictionless,
      {.solver = {.max_sweeps = 100000, .tolerance = 1e-13},
       .law = {.restitution = 1, .push_out = 0.5, .activation = Activation::closed_at_mid_step}},
      0.5);
  for (int step = 0; step < 100; ++step) {
    dynamics.step(no_force<2>, 0.01);
    REQUIRE(kinetic_by_definition(dynamics.particles) == doctest::Approx(0.5).epsilon(1e-9));
  }
  for (int c = 0; c < dynamics.contacts.size(); ++c) CHECK(dynamics.contacts.gap[c] > -1e-9);
}
