#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "support/program_runs.hpp"
#include "support/solid_grains.hpp"

// Elastic spheres between two walls with friction, dragged along them by a body force: against Cattaneo
// (1938) and Mindlin (1949). With P the normal and T the tangential force of a contact, k_n = dP/dd,
//   delta = 3 mu P/(2 k_t) (1 - (1 - T/(mu P))^(2/3)),  k_t = 2(1 - nu)/(2 - nu) k_n.
// The sphere's own shear adds a part in proportion to T, which a run without slip measures.

using namespace softgrain;

namespace {

constexpr double nu = 0.45, mu = 0.3, depth = 0.1;
/// dP/dd at d/R = 0.1 of the converged axisymmetric solution (test_soft_sphere.cpp) [E R].
constexpr double normal_stiffness = 0.955;

struct Dragged {
  double normal = 0;                  ///< P [E R^2]
  std::vector<double> shear, centre;  ///< T over mu P, and the way of the centre of mass [R]
};

/// The mean of eight orientations, at T/(mu P) = 0.1, 0.2 ... 0.8. `friction` acts once they are pressed.
Dragged drag(int n, double friction, double time_of_drag) {
  ExplicitStep<3> dynamics(test::balls(n, Wide::size, nu), test::walls_at(-1, 1), {.damping_share = 0.5});
  const double dt = 0.8 * longest_stable_step(dynamics.grains, 0.5);
  // of a contact in the last step: 0 tangential, 2 normal
  const auto force = [&](int axis) {
    const Vec<3>&at_bottom = dynamics.wall_impulse(0), &at_top = dynamics.wall_impulse(1);
    return (at_top[axis] + (axis == 2 ? -1 : 1) * at_bottom[axis]) / (2 * dt * Wide::size);
  };
  // both walls go `way` in a time; the mean normal force
  const auto press = [&](double way, double time) {
    const int steps = static_cast<int>(time / dt);
    dynamics.box.walls[0].velocity = {0, 0, way / (steps * dt)};
    dynamics.box.walls[1].velocity = {0, 0, -way / (steps * dt)};
    double mean = 0;
    for (int k = 0; k < steps; ++k) {
      dynamics.step(dt);
      mean += force(2) / steps;
    }
    return mean;
  };
  press(depth, 20);
  dynamics.options.damping = 0.3;
  press(0, 40);
  Dragged dragged;
  dragged.normal = press(0, 10);
  dynamics.options.damping = 0.1;
  dynamics.options.wall_friction = friction;
  const SolidBatch& batch = dynamics.grains.batches[0];
  const auto centre = [&] {
    const Wide x = centre_of_mass(dynamics.grains, batch, batch.position)[0];
    double mean = 0;
    for (int lane = 0; lane < Wide::size; ++lane) mean += x[lane] / Wide::size;
    return mean;
  };
  const double start = centre(), limit = mu * dragged.normal;
  for (double time = 0; dragged.shear.size() < 8; time += dt) {
    const double share = time / time_of_drag;
    dynamics.options.gravity = {2 * limit * share / dynamics.grains.mass(0), 0, 0};
    dynamics.step(dt);
    if (share < 0.1 * (static_cast<double>(dragged.shear.size()) + 1)) continue;
    dragged.shear.push_back(force(0) / limit);
    dragged.centre.push_back(centre() - start);
  }
  return dragged;
}

/// The largest relative difference from the closed form.
double worst_error(int n, double time_of_drag) {
  const Dragged slips = drag(n, mu, time_of_drag), sticks = drag(n, 100, time_of_drag);
  const double k_t = 2 * (1 - nu) / (2 - nu) * normal_stiffness, limit = mu * slips.normal;
  const double compliance = sticks.centre[1] / (sticks.shear[1] * limit);  // with the sphere's own shear
  double worst = 0;
  for (std::size_t k = 0; k < slips.shear.size(); ++k) {
    const double T = slips.shear[k] * limit;
    const double expected =
        1.5 * limit / k_t * (1 - std::pow(1 - slips.shear[k], 2.0 / 3)) + (compliance - 1 / k_t) * T;
    worst = std::max(worst, std::abs(slips.centre[k] / expected - 1));
  }
  return worst;
}

}  // namespace

TEST_CASE("a sphere that is dragged along walls slips as Cattaneo and Mindlin say") {
  CHECK(worst_error(4, 60) < 0.2);
  if (test::torture()) CHECK(worst_error(12, 200) < 0.06);
}
