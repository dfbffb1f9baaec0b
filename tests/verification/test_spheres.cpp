#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "support/gravity.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;

namespace {

/// The disks' plane is y = 0, so that e_z of the plane is -e_y of space.
Vec<3> in_space(const Vec<2>& a) { return {a[0], 0, a[1]}; }
Vec<3> in_space(const Vec<1>& spin) { return {0, -spin[0], 0}; }

/// The same bodies as spheres with centres in a plane, with the disks' kappa.
RigidParticles<3> as_spheres(const RigidParticles<2>& disks) {
  std::vector<Vec<3>> position;
  for (const Vec<2>& x : disks.position) position.push_back(in_space(x));
  std::vector<Wall<3>> walls;
  for (const Wall<2>& w : disks.walls)
    walls.push_back({in_space(w.point), in_space(w.normal), in_space(w.velocity)});
  auto spheres = rigid_particles<3>(position, disks.radius, disks.mass, walls);
  spheres.inertia_ratio = disks.inertia_ratio;
  for (int i = 0; i < disks.size(); ++i) {
    spheres.velocity[i] = in_space(disks.velocity[i]);
    spheres.spin[i] = in_space(disks.spin[i]);
  }
  return spheres;
}

/// Runs both and compares their states at the end.
void check_same_trajectory(const FrictionRule& friction, const ContactLaw& law, int steps) {
  const RigidStepOptions options{.solver = {.max_sweeps = 20000, .tolerance = 1e-13, .velocity_scale = 1},
                                 .law = law};
  const auto bodies = test::random_bodies<2>(7, 51);
  RigidDynamics<2> disks(bodies, friction, options, 0.3);
  RigidDynamics<3> spheres(as_spheres(bodies), friction, options, 0.3);
  int contacts = 0;
  for (int step = 0; step < steps; ++step) {
    contacts += disks.step(test::gravity<2>({-1, -2}), 0.01).contacts;
    spheres.step(test::gravity<3>({-1, 0, -2}), 0.01);
  }
  CHECK(contacts > 2 * steps);
  for (int i = 0; i < bodies.size(); ++i) {
    CHECK(norm(in_space(disks.particles.position[i]) - spheres.particles.position[i]) < 1e-9);
    CHECK(norm(in_space(disks.particles.velocity[i]) - spheres.particles.velocity[i]) < 1e-8);
    CHECK(norm(in_space(disks.particles.spin[i]) - spheres.particles.spin[i]) < 1e-8);
  }
}

constexpr ContactLaw moreau{.restitution = 0.5, .activation = Activation::closed_at_mid_step};

}  // namespace

TEST_CASE("frictionless spheres in a plane move as disks do") {
  check_same_trajectory(test::friction(0), {}, 150);
  check_same_trajectory(test::friction(0), moreau, 150);
}

TEST_CASE("spheres in a plane with friction and the disks' inertia move as disks do") {
  check_same_trajectory(test::friction(0.4), {}, 50);
  check_same_trajectory(test::mixed_friction, moreau, 50);
}
