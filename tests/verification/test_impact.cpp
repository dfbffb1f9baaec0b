#include <doctest/doctest.h>

#include <cmath>

#include "support/gravity.hpp"

using namespace softgrain;

namespace {

struct Impact {
  double m_1, v_1, m_2, v_2;
};

/// Two disks on the x-axis that meet head-on within the time 0.3.
RigidDynamics<2> head_on(const Impact& impact, const ContactLaw& law) {
  auto disks = rigid_particles<2>({{-1.05, 0}, {0.55, 0}}, {1, 0.5}, {impact.m_1, impact.m_2}, {});
  disks.velocity = {{impact.v_1, 0}, {impact.v_2, 0}};
  RigidDynamics<2> dynamics(disks, test::friction(0.3), {.solver = {}, .law = law}, 0.1);
  for (int step = 0; step < 300; ++step) dynamics.step(test::no_force<2>(), 1e-3);
  return dynamics;
}

constexpr Impact impacts[] = {{1, 1, 1, -1}, {1, 2, 1, 0}, {3, 1, 0.5, -2}, {0.2, 0.5, 5, -0.1}};

double momentum(const RigidParticles<2>& disks) {
  return disks.mass[0] * disks.velocity[0][0] + disks.mass[1] * disks.velocity[1][0];
}

}  // namespace

TEST_CASE("after a head-on impact with e = 0 two disks move on together") {
  for (const Impact& i : impacts) {
    const auto dynamics = head_on(i, {});
    const double common = (i.m_1 * i.v_1 + i.m_2 * i.v_2) / (i.m_1 + i.m_2);
    for (const Vec<2>& v : dynamics.particles.velocity) {
      CHECK(v[0] == doctest::Approx(common).epsilon(1e-13));
      CHECK(v[1] == 0);
    }
    CHECK(std::abs(momentum(dynamics.particles) - (i.m_1 + i.m_2) * common) < 1e-14);
  }
}

TEST_CASE("a head-on impact reverses the share e of the relative velocity and keeps the momentum") {
  for (const double e : {1.0, 0.5}) {
    for (const Impact& i : impacts) {
      const auto dynamics =
          head_on(i, {.restitution = e, .push_out = 0, .activation = Activation::closed_at_mid_step});
      const double v_1 = dynamics.particles.velocity[0][0], v_2 = dynamics.particles.velocity[1][0];
      CHECK(v_2 - v_1 == doctest::Approx(e * (i.v_1 - i.v_2)).epsilon(1e-13));
      CHECK(std::abs(momentum(dynamics.particles) - i.m_1 * i.v_1 - i.m_2 * i.v_2) < 1e-14);
    }
  }
}

TEST_CASE("equal disks exchange their velocities in an elastic impact") {
  const auto dynamics =
      head_on({2, 3, 2, -1}, {.restitution = 1, .push_out = 0, .activation = Activation::closed_at_mid_step});
  CHECK(dynamics.particles.velocity[0][0] == doctest::Approx(-1).epsilon(1e-14));
  CHECK(dynamics.particles.velocity[1][0] == doctest::Approx(3).epsilon(1e-14));
}

namespace {

/// A disk or sphere without spin that hits the wall x_last = 0 with friction, coming from its upper side.
template <int Dim>
RigidDynamics<Dim> oblique(const Vec<Dim>& velocity, double mu) {
  Vec<Dim> start, up;
  start[Dim - 1] = 1.05;
  up[Dim - 1] = 1;
  auto body = rigid_particles<Dim>({start}, {1}, {2}, {{.point = {}, .normal = up, .velocity = {}}});
  body.velocity[0] = velocity;
  RigidDynamics<Dim> dynamics(body, test::friction(mu), {}, 0.1);
  for (int step = 0; step < 100; ++step) dynamics.step(test::no_force<Dim>(), 1e-3);
  return dynamics;
}

}  // namespace

TEST_CASE("a sliding disk loses exactly mu p_n of tangential momentum") {
  const double m = 2, mu = 0.2;
  const auto disk = oblique<2>({3, -1}, mu).particles;
  CHECK(m * (3 - disk.velocity[0][0]) == doctest::Approx(mu * m * 1).epsilon(1e-13));  // p_n = m v_n
  CHECK(std::abs(disk.velocity[0][1]) < 1e-12);
  CHECK(disk.spin[0][0] == doctest::Approx(-2 * mu * 1).epsilon(1e-13));  // I omega = -R mu p_n
}

TEST_CASE("a sliding sphere loses exactly mu p_n of tangential momentum against its way") {
  const double m = 2, mu = 0.2;
  const auto sphere = oblique<3>({3, 4, -1}, mu).particles;
  CHECK(m * (3 - sphere.velocity[0][0]) == doctest::Approx(0.6 * mu * m).epsilon(1e-13));
  CHECK(m * (4 - sphere.velocity[0][1]) == doctest::Approx(0.8 * mu * m).epsilon(1e-13));
  // the torque of friction -mu p_n (0.6, 0.8, 0) at -R e_z; I = 2/5 m R^2
  CHECK(sphere.spin[0][0] == doctest::Approx(-2.5 * mu * 0.8).epsilon(1e-13));
  CHECK(sphere.spin[0][1] == doctest::Approx(2.5 * mu * 0.6).epsilon(1e-13));
}

TEST_CASE("a disk that grips at impact rolls on with 2/3 of its speed, a sphere with 5/7") {
  const auto disk = oblique<2>({0.3, -1}, 0.5).particles;
  CHECK(disk.velocity[0][0] == doctest::Approx(2.0 / 3 * 0.3).epsilon(1e-13));
  CHECK(disk.spin[0][0] == doctest::Approx(-2.0 / 3 * 0.3).epsilon(1e-13));
  const auto sphere = oblique<3>({0.3, -0.4, -1}, 0.5).particles;
  CHECK(sphere.velocity[0][0] == doctest::Approx(5.0 / 7 * 0.3).epsilon(1e-13));
  CHECK(sphere.velocity[0][1] == doctest::Approx(-5.0 / 7 * 0.4).epsilon(1e-13));
}
