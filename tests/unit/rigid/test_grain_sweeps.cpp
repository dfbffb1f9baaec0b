#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "softgrain/core/parallel.hpp"
#include "softgrain/rigid/step.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;

namespace {

constexpr int tiles = 8, per_tile = 5;  // along a side
constexpr double dt = 0.02;

/// Random disks in a corner of walls, tile by tile: a tile is a grain. That in the corner is struck.
RigidParticles<2> grains_of_disks() {
  const auto bodies = test::random_bodies<2>(tiles * per_tile, 5);
  const auto tile = [](int i) {
    const int side = tiles * per_tile;
    return i / side / per_tile * tiles + i % side / per_tile;
  };
  std::vector<int> order(bodies.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return tile(i) < tile(j); });
  std::vector<Vec<2>> position;
  std::vector<double> radius, mass;
  for (const int i : order)
    position.push_back(bodies.position[i]), radius.push_back(bodies.radius[i]),
        mass.push_back(bodies.mass[i]);
  auto grains = rigid_particles<2>(position, radius, mass, bodies.walls);
  for (int i = 0; i < grains.size(); ++i) {
    grains.grain[i] = tile(order[i]);
    grains.velocity[i] = 0.02 * bodies.velocity[order[i]];
    if (grains.grain[i] == 0) grains.velocity[i] = {2, 1};
  }
  return grains;
}

/// Grains after a step of contacts alone.
RigidDynamics<2> stepped(const FrictionRule& friction, const SolverOptions& solver, Precision precision,
                         StepReport* report = nullptr) {
  RigidDynamics<2> dynamics(grains_of_disks(), friction,
                            {.solver = solver, .law = {.push_out = 0}, .precision = precision}, 0.2);
  const StepReport done = dynamics.step([](const RigidParticles<2>&, std::span<Vec<2>>) {}, dt);
  if (report != nullptr) *report = done;
  return dynamics;
}

double largest_difference(const RigidParticles<2>& a, const RigidParticles<2>& b) {
  double largest = 0;
  for (int i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a.velocity[i] - b.velocity[i]));
  return largest;
}

/// max |min(W p, u_n + max(g, 0)/dt)| over all contacts without friction, of the step that was made [m/s].
double worst_violation(const RigidDynamics<2>& dynamics) {
  const RigidContacts<2>& contacts = dynamics.contacts;
  const RigidParticles<2>& bodies = dynamics.particles;
  double worst = 0;
  for (int c = 0; c < contacts.size(); ++c) {
    const Vec<2> u = bodies.velocity[contacts.body_b[c]] - bodies.velocity[contacts.body_a[c]];
    const double u_n = dot(contacts.normal[c], u) + std::max(contacts.gap[c], 0.0) / dt;
    const double W = contacts.inverse_mass_a[c] + contacts.inverse_mass_b[c];
    worst = std::max(worst, std::abs(std::min(W * contacts.impulse[c][0], u_n)));
  }
  return worst;
}

double frictionless(int, int) { return 0; }

/// Scale 1 m/s.
SolverOptions options(double tolerance) {
  return {.max_sweeps = 100000,
          .tolerance = tolerance,
          .worst_factor = 2,
          .velocity_scale = 1,
          .extrapolated = true};
}

}  // namespace

TEST_CASE("grains that leave the sweep when they have converged end at the solution of the whole packing") {
  // all contacts in turn, in double precision, until rounding
  const FrictionRule rules[] = {frictionless, test::mixed_friction};
  for (const FrictionRule& friction : rules) {
    SolverOptions plain = options(1e-12);
    plain.extrapolated = false;
    StepReport report;
    const auto reference = stepped(friction, plain, Precision::full, &report);
    REQUIRE(report.converged);
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
      const auto solved = stepped(friction, options(tolerance), Precision::single, &report);
      CHECK(report.converged);
      CHECK(largest_difference(solved.particles, reference.particles) < 4 * tolerance);
    }
  }
}

TEST_CASE("no contact of a grain that has left the sweep is violated in the end") {
  for (const double tolerance : {1e-3, 3e-4, 1e-4}) {
    StepReport report;
    const auto solved = stepped(frictionless, options(tolerance), Precision::single, &report);
    REQUIRE(report.converged);
    CHECK(worst_violation(solved) < 1.5 * 2 * tolerance);
  }
}

TEST_CASE("grains that leave the sweep do so alike on any number of threads") {
  const int before = threads();
  set_threads(1);
  const auto one = stepped(test::mixed_friction, options(1e-5), Precision::single);
  set_threads(3);
  const auto three = stepped(test::mixed_friction, options(1e-5), Precision::single);
  set_threads(before);
  CHECK(largest_difference(one.particles, three.particles) == 0);
  CHECK(one.contacts.impulse == three.contacts.impulse);
}
