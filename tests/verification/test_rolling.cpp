#include <doctest/doctest.h>

#include <cmath>

#include "support/gravity.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;

namespace {

constexpr double g = 9.81, mu = 0.3, dt = 1e-4;

/// Steps until the time at which friction mu m g ends the sliding of the speed v_0: (1 + kappa) mu g t = v_0.
template <int Dim>
int steps_of_sliding(double v_0, double kappa) {
  return static_cast<int>(std::lround(v_0 / ((1 + kappa) * mu * g) / dt));
}

}  // namespace

TEST_CASE("a sliding disk ends rolling with 2/3 of its speed, after v_0 / (3 mu g)") {
  const double v_0 = 3;
  auto disk = rigid_particles<2>({{0, 0.2}}, {0.2}, {5}, {{.point = {}, .normal = {0, 1}, .velocity = {}}});
  disk.velocity[0] = {v_0, 0};
  RigidDynamics<2> dynamics(disk, test::friction(mu), {}, 0.1);
  const auto slip = [&] { return dynamics.particles.velocity[0][0] + dynamics.particles.spin[0][0]; };
  const int sliding = steps_of_sliding<2>(v_0, 2);
  for (int step = 0; step < sliding - 2; ++step) dynamics.step(test::gravity<2>({0, -g}), dt);
  CHECK(slip() > 1e-4);
  for (int step = 0; step < 4; ++step) dynamics.step(test::gravity<2>({0, -g}), dt);
  CHECK(std::abs(slip()) < 1e-12);
  for (int step = 0; step < 1000; ++step) dynamics.step(test::gravity<2>({0, -g}), dt);
  CHECK(dynamics.particles.velocity[0][0] == doctest::Approx(2.0 / 3 * v_0).epsilon(1e-11));
}

TEST_CASE("a sliding sphere ends rolling with 5/7 of its velocity, on any plane") {
  test::RandomNumbers random(6);
  for (int trial = 0; trial < 5; ++trial) {
    const Vec<3> n = random.unit_vector<3>(), way = cross(n, random.unit_vector<3>());
    const Vec<3> v_0 = (3 / norm(way)) * way;
    auto sphere = rigid_particles<3>({0.2 * n}, {0.2}, {5}, {{.point = {}, .normal = n, .velocity = {}}});
    sphere.velocity[0] = v_0;
    RigidDynamics<3> dynamics(sphere, test::friction(mu), {}, 0.1);
    const auto slip = [&] {  // v + omega x (-R n)
      return norm(dynamics.particles.velocity[0] - cross(dynamics.particles.spin[0], n));
    };
    const int sliding = steps_of_sliding<3>(3, 2.5);
    for (int step = 0; step < sliding - 2; ++step) dynamics.step(test::gravity(-g * n), dt);
    CHECK(slip() > 1e-4);
    for (int step = 0; step < 1000; ++step) dynamics.step(test::gravity(-g * n), dt);
    CHECK(slip() < 1e-12);
    CHECK(norm(dynamics.particles.velocity[0] - (5.0 / 7) * v_0) < 1e-10);
  }
}
