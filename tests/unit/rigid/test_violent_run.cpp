#include <doctest/doctest.h>

#include <set>
#include <utility>

#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/rigid/step.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;
using test::Plane;
using test::Space;

namespace {

using PairSet = std::set<std::pair<int, int>>;

/// Fast bodies between walls that shake: some move by a third of the skin in a step.
template <int Dim>
RigidDynamics<Dim> violent_bodies(int per_side) {
  auto bodies = test::random_bodies<Dim>(per_side, 21);
  test::RandomNumbers random(22);
  for (int i = 0; i < bodies.size(); ++i) {
    bodies.velocity[i] = random.vector<Dim>(10);
    bodies.grain[i] = i / 7;
  }
  const double far = 2.2 * per_side;
  for (int k = 0; k < Dim; ++k) {
    Wall<Dim> opposite = bodies.walls[k];
    opposite.point[k] = far;
    opposite.normal = -opposite.normal;
    bodies.walls.push_back(opposite);
  }
  auto closed = rigid_particles<Dim>(bodies.position, bodies.radius, bodies.mass, bodies.walls);
  closed.grain = bodies.grain;
  for (int i = 0; i < closed.size(); ++i) closed.velocity[i] = bodies.velocity[i];
  return {closed, test::mixed_friction, {.solver = {.max_sweeps = 30}, .law = {}}, 0.3};
}

template <int Dim>
void shake_walls(RigidDynamics<Dim>& dynamics, int step) {
  for (int w = 0; w < 2 * Dim; ++w)
    set_wall_velocity(dynamics.particles, w,
                      (step / 10 % 2 == 0 ? 8.0 : -8.0) * dynamics.particles.walls[w].normal);
}

/// Every pair and wall that overlaps is in the list of contacts.
template <int Dim>
void check_contacts(const RigidDynamics<Dim>& dynamics) {
  const auto& p = dynamics.particles;
  PairSet listed;
  for (int c = 0; c < dynamics.contacts.size(); ++c)
    listed.emplace(dynamics.contacts.body_a[c], dynamics.contacts.body_b[c]);
  for (int i = 0; i < p.size(); ++i) {
    for (int j = i + 1; j < p.size(); ++j)
      if (norm(p.position[j] - p.position[i]) < p.radius[i] + p.radius[j]) REQUIRE(listed.contains({i, j}));
    for (int w = 0; w < static_cast<int>(p.walls.size()); ++w)
      if (dot(p.position[i] - p.walls[w].point, p.walls[w].normal) < p.radius[i])
        REQUIRE(listed.contains({i, p.wall_body(w)}));
  }
}

/// Every pair of one grain closer than 2 a0 is listed, and none of two grains.
void check_attraction(const AttractionForces& attraction, const RigidParticles<2>& p) {
  PairSet listed;
  attraction.for_each_pair([&](int i, int j) {
    REQUIRE(listed.emplace(i, j).second);
    REQUIRE(p.grain[i] == p.grain[j]);
  });
  for (int i = 0; i < p.size(); ++i) {
    for (int j = i + 1; j < p.size(); ++j) {
      const bool near = norm(p.position[j] - p.position[i]) <= 2 * (p.radius[i] + p.radius[j]);
      if (near && p.grain[i] == p.grain[j]) REQUIRE(listed.contains({i, j}));
    }
  }
}

}  // namespace

TEST_CASE_TEMPLATE("no contact is ever missing from the list in a violent run", Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  auto dynamics = violent_bodies<Dim>(Dim == 2 ? 9 : 4);
  for (int step = 0; step < 400; ++step) {
    shake_walls(dynamics, step);
    // the lists are used at the middle of the step, where forces are asked for
    dynamics.step([&](const auto&, auto) { check_contacts(dynamics); }, 0.01);
  }
  CHECK(dynamics.reference.generation > 60);
}

TEST_CASE("no attracting pair is ever missing from the list in a violent run") {
  auto dynamics = violent_bodies<2>(9);
  AttractionForces attraction({.F0 = 20, .gamma = 7});
  for (int step = 0; step < 300; ++step) {
    shake_walls(dynamics, step);
    dynamics.step(
        [&](const RigidParticles<2>& particles, std::span<Vec<2>> force) {
          attraction.update(particles, dynamics.reference);
          attraction.add_forces(particles, force);
          check_attraction(attraction, particles);
        },
        0.01);
  }
  CHECK(dynamics.reference.generation > 60);
}

TEST_CASE("a fast wall alone lets the lists be made again, and pushes the disk that it meets") {
  const Wall<2> wall{.point = {0, -5}, .normal = {0, 1}, .velocity = {0, 10}};
  RigidDynamics<2> dynamics(
      rigid_particles<2>({{0, 0}}, {1}, {1}, {wall}), [](int, int) { return 0.0; }, {}, 0.1);
  for (int step = 0; step < 100; ++step) dynamics.step([](const auto&, auto) {}, 0.005);
  CHECK(dynamics.particles.walls[0].point[1] == doctest::Approx(0).epsilon(1e-12));
  CHECK(dynamics.particles.position[0][1] == doctest::Approx(1).epsilon(1e-12));
  CHECK(dynamics.particles.velocity[0][1] == doctest::Approx(10).epsilon(1e-12));
}
