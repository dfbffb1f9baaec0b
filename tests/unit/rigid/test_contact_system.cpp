#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/rigid/rigid_contact_system.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;
using test::Plane;
using test::Space;

namespace {

Vec<3> in_space(const Vec<1>& turning) { return {0, 0, turning[0]}; }
Vec<3> in_space(const Vec<2>& a) { return {a[0], a[1], 0}; }
Vec<3> in_space(const Vec<3>& a) { return a; }

/// Velocity of the point of body i at the arm (from its centre): v + omega x arm, omega = s/R.
template <int Dim>
Vec<3> point_velocity(const RigidParticles<Dim>& bodies, int i, const Vec<3>& arm) {
  if (i >= bodies.size()) return in_space(bodies.walls[i - bodies.size()].velocity);
  const Vec<3> omega = (1 / bodies.radius[i]) * in_space(bodies.spin[i]);
  return in_space(bodies.velocity[i]) + cross(omega, arm);
}

template <int Dim>
double radius_of(const RigidParticles<Dim>& bodies, int i) {
  return i < bodies.size() ? bodies.radius[i] : 0;
}

}  // namespace

TEST_CASE_TEMPLATE("the relative velocity is that of the two surface points that touch", Dimension, Plane,
                   Space) {
  constexpr int Dim = Dimension::value;
  test::ContactScene<Dim> scene(Dim == 2 ? 6 : 4);
  const auto system = scene.system();
  for (int c = 0; c < system.size(); ++c) {
    const int a = scene.contacts.body_a[c], b = scene.contacts.body_b[c];
    const Vec<3> n = in_space(scene.contacts.normal[c]);
    const Vec<3> u = point_velocity(scene.bodies, b, -radius_of(scene.bodies, b) * n) -
                     point_velocity(scene.bodies, a, radius_of(scene.bodies, a) * n);
    const Vec<Dim> local = system.relative_velocity(c);
    CHECK(local[0] == doctest::Approx(dot(n, u) + scene.offset[c]).epsilon(1e-13));
    const auto t = tangents(scene.contacts.normal[c]);
    for (int k = 1; k < Dim; ++k)
      CHECK(local[k] == doctest::Approx(dot(in_space(t[k - 1]), u)).epsilon(1e-13));
  }
}

TEST_CASE_TEMPLATE("unit impulses show a symmetric Delassus operator with the blocks that are stated",
                   Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  for (const double inertia_ratio : {2.0, 2.5, 1.0}) {
    test::ContactScene<Dim> scene(Dim == 2 ? 4 : 3);
    scene.bodies.inertia_ratio = inertia_ratio;
    auto system = scene.system();
    const int rows = Dim * system.size();
    std::vector<double> W(static_cast<std::size_t>(rows) * rows);
    const auto velocity_start = scene.bodies.velocity;
    const auto spin_start = scene.bodies.spin;
    std::vector<Vec<Dim>> u_start;
    for (int c = 0; c < system.size(); ++c) u_start.push_back(system.relative_velocity(c));
    for (int column = 0; column < rows; ++column) {
      Vec<Dim> unit;
      unit[column % Dim] = 1;
      system.apply_impulse(column / Dim, unit);
      for (int c = 0; c < system.size(); ++c) {
        const Vec<Dim> du = system.relative_velocity(c) - u_start[c];
        for (int k = 0; k < Dim; ++k) W[(Dim * c + k) * rows + column] = du[k];
      }
      scene.bodies.velocity = velocity_start;
      scene.bodies.spin = spin_start;
    }
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < rows; ++j) {
        REQUIRE(std::abs(W[i * rows + j] - W[j * rows + i]) < 1e-13);
        if (i / Dim != j / Dim) continue;
        REQUIRE(std::abs(W[i * rows + j] - system.delassus_block(i / Dim)(i % Dim, j % Dim)) < 1e-13);
      }
    }
  }
}

TEST_CASE_TEMPLATE("an impulse at a contact does the work p . (u- + u+)/2 and keeps the momentum", Dimension,
                   Plane, Space) {
  constexpr int Dim = Dimension::value;
  test::ContactScene<Dim> scene(Dim == 2 ? 5 : 3);
  scene.offset.assign(scene.offset.size(), 0);
  auto system = scene.system();
  test::RandomNumbers random(8);
  const auto momentum = [&] {
    Vec<Dim> sum;
    for (int i = 0; i < scene.bodies.size(); ++i) sum += scene.bodies.mass[i] * scene.bodies.velocity[i];
    return sum;
  };
  for (int c = 0; c < system.size(); ++c) {
    if (scene.contacts.body_b[c] >= scene.bodies.size()) continue;
    const Vec<Dim> p = random.vector<Dim>(1), before = system.relative_velocity(c), sum = momentum();
    const double energy = kinetic_energy(scene.bodies);
    system.apply_impulse(c, p);
    const double work = dot(p, 0.5 * (before + system.relative_velocity(c)));
    CHECK(kinetic_energy(scene.bodies) - energy == doctest::Approx(work).epsilon(1e-10));
    CHECK(norm(momentum() - sum) < 1e-13);
  }
}

TEST_CASE("the tangent of the plane is the normal turned left") {
  CHECK(tangents(Vec<2>{1, 0})[0] == Vec<2>{0, 1});
  CHECK(tangents(Vec<2>{0.6, 0.8})[0] == Vec<2>{-0.8, 0.6});
}

TEST_CASE("the tangents of space are orthonormal for every normal") {
  test::RandomNumbers random(4);
  std::vector<Vec<3>> normals{{1, 0, 0},  {0, -1, 0},      {0, 0, 1},
                              {0, 0, -1}, {0.6, 0.8, 0.0}, {0.6, -0.8, -0.0}};
  for (int trial = 0; trial < 10000; ++trial) normals.push_back(random.unit_vector<3>());
  for (const Vec<3>& n : normals) {
    const auto [t1, t2] = tangents(n);
    REQUIRE(std::abs(norm(t1) - 1) < 1e-14);
    REQUIRE(std::abs(norm(t2) - 1) < 1e-14);
    REQUIRE(std::abs(dot(t1, t2)) < 1e-14);
    REQUIRE(std::abs(dot(t1, n)) < 1e-14);
    REQUIRE(std::abs(dot(t2, n)) < 1e-14);
  }
}

TEST_CASE("the offset of an anticipated contact is gap/dt if open and beta gap/dt if overlapping") {
  const double dt = 0.1;
  const test::ContactScene<2> scene(6, test::mixed_friction, dt, {.push_out = 0.3});
  for (int c = 0; c < scene.contacts.size(); ++c) {
    const double gap = scene.contacts.gap[c];
    CHECK(scene.offset[c] == doctest::Approx((gap > 0 ? 1 : 0.3) * gap / dt).epsilon(1e-15));
  }
}

TEST_CASE("restitution returns a share of the velocity of approach, and only closed contacts act") {
  const double dt = 0.1, e = 0.7;
  const test::ContactScene<2> scene(
      6, test::mixed_friction, dt,
      {.restitution = e, .push_out = 0.3, .activation = Activation::closed_at_mid_step});
  for (int c = 0; c < scene.contacts.size(); ++c) {
    const double gap = scene.contacts.gap[c];
    const auto& v = scene.bodies.velocity;
    const double approach =
        dot(scene.contacts.normal[c], v[scene.contacts.body_b[c]] - v[scene.contacts.body_a[c]]);
    if (gap > 0)
      CHECK(scene.offset[c] > 1e20);  // no velocity ever answers it
    else
      CHECK(scene.offset[c] == doctest::Approx(e * approach).epsilon(1e-13));  // push-out moves positions
  }
}
