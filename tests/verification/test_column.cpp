#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "support/gravity.hpp"

using namespace softgrain;

namespace {

constexpr double g = 9.81, dt = 1e-3;

/// Accurate to round-off: the residual is a velocity over g dt.
RigidStepOptions exact() {
  return {.solver = {.max_sweeps = 200000, .tolerance = 1e-13, .velocity_scale = g * dt}, .law = {}};
}

/// Bodies of different sizes and masses on top of each other, on the floor x_last = 0.
template <int Dim>
RigidDynamics<Dim> column(double mu) {
  std::vector<Vec<Dim>> position(10);
  std::vector<double> radius, mass;
  double height = 0;
  for (int i = 0; i < 10; ++i) {
    radius.push_back(1 + 0.1 * (i % 4));
    mass.push_back(1 + 0.5 * i);
    position[i][Dim - 1] = height + radius[i];
    height += 2 * radius[i];
  }
  Vec<Dim> up;
  up[Dim - 1] = 1;
  const Wall<Dim> floor{.point = {}, .normal = up, .velocity = {}};
  return {rigid_particles<Dim>(position, radius, mass, {floor}), test::friction(mu), exact(), 0.2};
}

template <int Dim>
void check_column(double mu) {
  auto dynamics = column<Dim>(mu);
  Vec<Dim> down;
  down[Dim - 1] = -g;
  const auto start = dynamics.particles.position;
  for (int step = 0; step < 10; ++step) REQUIRE(dynamics.step(test::gravity(down), dt).converged);
  const auto& mass = dynamics.particles.mass;
  for (int c = 0; c < dynamics.contacts.size(); ++c) {
    const int a = dynamics.contacts.body_a[c], b = dynamics.contacts.body_b[c];
    const int lowest = b == 10 ? 0 : std::max(a, b);
    const double above = std::accumulate(mass.begin() + lowest, mass.end(), 0.0);
    CHECK(dynamics.contacts.impulse[c][0] / dt == doctest::Approx(above * g).epsilon(1e-8));
  }
  CHECK(dynamics.contacts.size() == 10);
  const double weight = g * std::accumulate(mass.begin(), mass.end(), 0.0);
  CHECK(-dynamics.wall_impulse(0)[Dim - 1] / dt == doctest::Approx(weight).epsilon(1e-8));
  for (int i = 0; i < 10; ++i) CHECK(norm(dynamics.particles.position[i] - start[i]) < 1e-12);
}

}  // namespace

TEST_CASE("every contact in a column of disks at rest carries the weight above it") {
  check_column<2>(0);
  check_column<2>(0.4);
}

TEST_CASE("every contact in a stack of spheres at rest carries the weight above it") {
  check_column<3>(0);
  check_column<3>(0.4);
}

TEST_CASE("a disk on two disks between walls presses the walls with m g / (2 sqrt 3)") {
  const double top = 1 + std::sqrt(3.0), m = 4, m_top = 7;
  const std::vector<Wall<2>> walls{{.point = {0, 0}, .normal = {0, 1}, .velocity = {}},
                                   {.point = {-2, 0}, .normal = {1, 0}, .velocity = {}},
                                   {.point = {2, 0}, .normal = {-1, 0}, .velocity = {}}};
  RigidDynamics<2> dynamics(rigid_particles<2>({{-1, 1}, {1, 1}, {0, top}}, {1, 1, 1}, {m, m, m_top}, walls),
                            test::friction(0), exact(), 0.1);
  for (int step = 0; step < 5; ++step) dynamics.step(test::gravity<2>({0, -g}), dt);
  CHECK(-dynamics.wall_impulse(0)[1] / dt == doctest::Approx((2 * m + m_top) * g).epsilon(1e-8));
  const double thrust = m_top * g / (2 * std::sqrt(3.0));
  CHECK(-dynamics.wall_impulse(1)[0] / dt == doctest::Approx(thrust).epsilon(1e-8));
  CHECK(dynamics.wall_impulse(2)[0] / dt == doctest::Approx(thrust).epsilon(1e-8));
}

TEST_CASE("a sphere in the corner of three planes presses each with m g / sqrt 3") {
  std::vector<Wall<3>> walls(3);
  for (int k = 0; k < 3; ++k) walls[k].normal[k] = 1;
  RigidDynamics<3> dynamics(rigid_particles<3>({{1, 1, 1}}, {1}, {2}, walls), test::friction(0), exact(),
                            0.1);
  const double each = g / std::sqrt(3.0);
  dynamics.step(test::gravity<3>({-each, -each, -each}), dt);
  for (int k = 0; k < 3; ++k)
    CHECK(-dynamics.wall_impulse(k)[k] / dt == doctest::Approx(2 * each).epsilon(1e-12));
}
