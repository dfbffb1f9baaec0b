#include <doctest/doctest.h>

#include <cmath>

#include "support/gravity.hpp"

using namespace softgrain;

namespace {

constexpr double g = 9.81;

/// A body with kappa = m R^2 / I on a plane x_last = 0 with friction; gravity is tilted by the slope a,
/// downhill along +x.
template <int Dim>
RigidDynamics<Dim> on_plane(double inertia_ratio, double mu) {
  Vec<Dim> start, up;
  start[Dim - 1] = 0.1;
  up[Dim - 1] = 1;
  auto body = rigid_particles<Dim>({start}, {0.1}, {3}, {{.point = {}, .normal = up, .velocity = {}}});
  body.inertia_ratio = inertia_ratio;
  return {body, test::friction(mu), {.solver = {}, .law = {.push_out = 0}}, 0.05};
}

template <int Dim>
void slide_for(RigidDynamics<Dim>& dynamics, double slope, double time) {
  const double dt = 1e-3;
  Vec<Dim> tilted;
  tilted[0] = g * std::sin(slope);
  tilted[Dim - 1] = -g * std::cos(slope);
  for (int step = 0; step < std::lround(time / dt); ++step) dynamics.step(test::gravity(tilted), dt);
}

constexpr double block = 1e-12;  // so much inertia that nothing turns it

}  // namespace

TEST_CASE("a block on an incline sticks below the angle of friction") {
  for (const double mu : {0.2, 0.5, 1.0}) {
    auto plane = on_plane<2>(block, mu);
    auto space = on_plane<3>(block, mu);
    slide_for(plane, std::atan(mu) - 1e-3, 1);
    slide_for(space, std::atan(mu) - 1e-3, 1);
    CHECK(std::abs(plane.particles.position[0][0]) < 1e-10);
    CHECK(norm(space.particles.position[0] - Vec<3>{0, 0, 0.1}) < 1e-10);
  }
}

TEST_CASE("above the angle of friction a block slides by g t^2 (sin a - mu cos a)/2") {
  for (const double mu : {0.0, 0.2, 0.5}) {
    for (const double slope : {std::atan(mu) + 0.02, std::atan(mu) + 0.3}) {
      auto plane = on_plane<2>(block, mu);
      auto space = on_plane<3>(block, mu);
      slide_for(plane, slope, 1.5);
      slide_for(space, slope, 1.5);
      const double x = g * 1.5 * 1.5 * (std::sin(slope) - mu * std::cos(slope)) / 2;
      CHECK(plane.particles.position[0][0] == doctest::Approx(x).epsilon(1e-9));
      CHECK(space.particles.position[0][0] == doctest::Approx(x).epsilon(1e-9));
      CHECK(plane.particles.position[0][1] == doctest::Approx(0.1).epsilon(1e-12));
    }
  }
}

TEST_CASE("a disk rolls down an incline with 2/3 g sin a, a sphere with 5/7 g sin a") {
  const double slope = 0.4, time = 1.5;
  auto disk = on_plane<2>(2, 1);
  auto sphere = on_plane<3>(2.5, 1);
  slide_for(disk, slope, time);
  slide_for(sphere, slope, time);
  const double v = g * std::sin(slope) * time;
  CHECK(disk.particles.velocity[0][0] == doctest::Approx(2.0 / 3 * v).epsilon(1e-10));
  CHECK(disk.particles.spin[0][0] == doctest::Approx(-2.0 / 3 * v).epsilon(1e-10));
  CHECK(sphere.particles.velocity[0][0] == doctest::Approx(5.0 / 7 * v).epsilon(1e-10));
  CHECK(sphere.particles.spin[0][1] == doctest::Approx(5.0 / 7 * v).epsilon(1e-10));
}

TEST_CASE("a disk rolls without sliding up to tan a = 3 mu, a sphere up to 7/2 mu") {
  const double mu = 0.2;
  for (const double side : {-1e-3, 1e-3}) {
    auto disk = on_plane<2>(2, mu);
    auto sphere = on_plane<3>(2.5, mu);
    slide_for(disk, std::atan(3 * mu) + side, 0.5);
    slide_for(sphere, std::atan(3.5 * mu) + side, 0.5);
    const double disk_slip = disk.particles.velocity[0][0] + disk.particles.spin[0][0];
    const double sphere_slip = sphere.particles.velocity[0][0] - sphere.particles.spin[0][1];
    CHECK((std::abs(disk_slip) < 1e-10) == (side < 0));
    CHECK((std::abs(sphere_slip) < 1e-10) == (side < 0));
  }
}
