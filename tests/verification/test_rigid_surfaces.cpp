#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "softgrain/soft/rigid_surface.hpp"
#include "support/meshes.hpp"
#include "support/rigid_solids.hpp"
#include "support/solid_grains.hpp"

// Rigid grains in space with the surface of a mesh, by closed forms of mechanics.

using namespace softgrain;
using test::angular_momentum;
using test::Twist;
using test::twist_of;

namespace {

using Shape = std::shared_ptr<const SolidTopology>;

constexpr double density = 2;
const SolverOptions exact{.max_sweeps = 2000, .tolerance = 1e-13, .relaxation = 1.2};
const double half = 1 / std::sqrt(3);  // of a cube's side, over its radius

Shape shape_of(const TriangleMesh& mesh, int n) {
  return std::make_shared<const SolidTopology>(rigid_surface(StarSurface(mesh), n));
}
const Shape& cube() {
  static const Shape shape = shape_of(test::cube_mesh(3), 4);
  return shape;
}
const Vec<3> axes{1, 0.8, 0.5};
const Shape& ellipsoid() {
  static const Shape shape = shape_of(test::ellipsoid_mesh(axes, 4), 6);
  return shape;
}

SolidGrains rigid(std::vector<PlacementOf<3>> placed) {
  return {std::move(placed), {test::rigid_material(density)}};
}

Vec<3> centre_of(const SolidGrains& grains, int grain) {
  return grains.node_position(grain, grains.topology(grain).grid.nodes() - 1);
}

void set_twist(SolidGrains& grains, const Twist& twist) {
  for (SolidBatch& batch : grains.batches) {
    RigidTwistOf<3> all;
    for (int d = 0; d < 3; ++d) all.velocity[d] = Wide(twist.velocity[d]), all.spin[d] = Wide(twist.spin[d]);
    set_rigid_twist(all, batch.position, batch.velocity);
  }
}

/// Mass and moments of inertia of a body in axes of its own, with R = 1.
struct Body {
  double mass;
  Vec<3> inertia;
};

void check_inertia(const Shape& shape, const Body& body, double bound) {
  const SolidGrains grains = rigid(
      {{.topology = shape, .radius = 0.5, .centre = {1, 2, 3}, .angle = test::some_turn(2), .velocity = {}}});
  const SolidBatch& batch = grains.batches[0];
  double mass = 0;
  Vec<3> first;
  for (int i = 0; i < shape->grid.nodes(); ++i) {
    const double m = grains.node_mass(batch, i)[0];
    mass += m;
    first += m * (lane_of(batch.position[i], 0) - Vec<3>{1, 2, 3});
  }
  CHECK(std::abs(mass / (body.mass / 8) - 1) < bound);
  CHECK(norm(first) < 1e-13);
  const Mat<3, Wide> I = inertia_tensor(grains, batch, batch.position);
  const Mat<3> Q = test::some_turn(2);
  const Mat<3> expected = (1.0 / 32) * (Q * (Mat<3>::diagonal(body.inertia) * transpose(Q)));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) CHECK(std::abs(I(i, j)[0] - expected(i, j)) < bound * expected(i, i));
}

}  // namespace

TEST_CASE(
    "a rigid cube and ellipsoid have mass, centre and inertia of the closed form; flat faces stay flat") {
  const double m = density * 8 * half * half * half, I = m * 2 * half * half / 3;
  check_inertia(cube(), {m, {I, I, I}}, 1e-12);
  CHECK(std::abs(cube()->patch_fullness - 1) < 1e-12);  // no patch bulges over an edge
  for (const PatchNet& net : cube()->patches) {
    const SurfacePatch patch(net, cube()->grid.node.data());
    const Vec<3> x = patch.at(0.3, 0.8).place;
    CHECK(std::abs(std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])}) - half) < 1e-12);
    const auto weights = patch_weights(net, 0.3, 0.8);
    Vec<3> by_weights;
    for (std::size_t k = 0; k < 16; ++k)
      by_weights += weights[k] * cube()->grid.node[static_cast<std::size_t>(net.vertex[k])];
    CHECK(norm(by_weights - x) < 1e-14);
  }
  const double M = density * 4 * std::acos(-1.0) / 3 * axes[0] * axes[1] * axes[2];
  const auto about = [&](int i, int j) { return M / 5 * (axes[i] * axes[i] + axes[j] * axes[j]); };
  check_inertia(ellipsoid(), {M, {about(1, 2), about(0, 2), about(0, 1)}}, 0.016);  // of 2048 triangles
  CHECK(std::abs(ellipsoid()->patch_fullness - 1) < 0.01);
}

namespace {

/// Euler's equations of a free body, by Runge-Kutta in small steps: its spin in axes of its own.
Vec<3> spin_by_euler(const Vec<3>& I, Vec<3> w, double time) {
  const auto rate = [&](const Vec<3>& s) {
    return Vec<3>{(I[1] - I[2]) / I[0] * s[1] * s[2], (I[2] - I[0]) / I[1] * s[2] * s[0],
                  (I[0] - I[1]) / I[2] * s[0] * s[1]};
  };
  const int steps = 20000;
  const double h = time / steps;
  for (int k = 0; k < steps; ++k) {
    const Vec<3> a = rate(w), b = rate(w + (h / 2) * a), c = rate(w + (h / 2) * b), d = rate(w + h * c);
    w += (h / 6) * (a + 2 * b + 2 * c + d);
  }
  return w;
}

}  // namespace

TEST_CASE("a free ellipsoid tumbles by Euler's equations and keeps its angular momentum and energy") {
  SolidGrains grains = rigid({{.topology = ellipsoid(), .radius = 1, .centre = {}, .velocity = {}}});
  const Vec<3> spin{0.05, 1, 0.02};  // about the middle axis, where it does not stay
  set_twist(grains, {{0.3, -0.1, 0.2}, spin});
  const Mat<3, Wide> I = inertia_tensor(grains, grains.batches[0], grains.batches[0].position);
  ExplicitStep<3> dynamics(std::move(grains), test::walls_at(-100, 100), {});
  const Vec<3> momentum = dynamics.grains.momentum();
  const double energy = dynamics.grains.kinetic_energy();
  const Vec<3> angular = angular_momentum(dynamics.grains);
  double error = 0, last = 0;
  for (const double dt : {0.04, 0.02}) {
    ExplicitStep<3> run(dynamics.grains, test::walls_at(-100, 100), {});
    const int steps = static_cast<int>(std::lround(20 / dt));
    double off = 0;
    for (int k = 0; k < steps; ++k) {
      run.step(dt);
      off = std::max(off, std::abs(run.grains.kinetic_energy() / energy - 1));
    }
    CHECK(norm(run.grains.momentum() - momentum) < 1e-12 * norm(momentum));
    CHECK(norm(angular_momentum(run.grains) - angular) < 1e-11 * norm(angular));
    CHECK(off < 2e-4);
    const SolidBatch& batch = run.grains.batches[0];
    const RigidPoseOf<3> pose = rigid_pose(batch, batch.position);
    Mat<3> Q;
    for (std::size_t k = 0; k < 9; ++k) Q.c[k] = pose.turn.c[k][0];
    const Vec<3> own = transpose(Q) * twist_of(run.grains, 0).spin;
    const Vec<3> expected = spin_by_euler({I(0, 0)[0], I(1, 1)[0], I(2, 2)[0]}, spin, 20);
    CHECK(norm(expected - spin) > 0.5);  // it has turned over
    error = norm(own - expected);
    CHECK(error < 0.02);
    if (last > 0) CHECK(error < 0.3 * last);  // second order
    last = error;
  }
}

TEST_CASE(
    "a cube rests on a floor with its weight, slides to rest after v^2/(2 mu g), and stays on its edge's "
    "side") {
  const double g = 1, v0 = 0.5, mu = 0.3, dt = 0.005;
  ExplicitStep<3> dynamics(
      rigid({{.topology = cube(), .radius = 1, .centre = {0, 0, half}, .velocity = {v0, 0, 0}}}),
      test::walls_at(0, 10), {.solver = exact, .wall_friction = mu, .gravity = {0, 0, -g}});
  const double weight = g * density * 8 * half * half * half;
  const int stop = static_cast<int>(v0 / (mu * g) / dt);
  for (int k = 0; k < 2 * stop; ++k) {
    const SoftStepReport report = dynamics.step(dt);
    REQUIRE(report.converged);
    CHECK(std::abs(-dynamics.wall_impulse(0)[2] / dt / weight - 1) < 1e-6);
  }
  const Vec<3> x = centre_of(dynamics.grains, 0);
  CHECK(std::abs(x[0] / (v0 * v0 / (2 * mu * g)) - 1) < 0.01);
  CHECK(std::abs(x[1]) < 1e-9);
  CHECK(std::abs(x[2] - half) < 1e-9);
  const Twist end = twist_of(dynamics.grains, 0);
  CHECK(norm(end.velocity) < 1e-9);
  CHECK(norm(end.spin) < 1e-9);
}

TEST_CASE("a sphere lies on a cube's face, a cube on an ellipsoid's top, at the sum of their heights") {
  const double g = 1, dt = 0.004;
  for (const bool cube_below : {true, false}) {
    const Shape ball = std::make_shared<const SolidTopology>(rigid_ball(4));
    std::vector<PlacementOf<3>> placed;
    double height = half;
    if (cube_below) {
      placed = {{.topology = cube(), .radius = 1, .centre = {0, 0, half}, .velocity = {}},
                {.topology = ball, .radius = 0.3, .centre = {0.1, 0.05, 2 * half + 0.31}, .velocity = {}}};
      height = 2 * half + 0.3;
    } else {
      placed = {{.topology = cube(), .radius = 1, .centre = {0, 0, half}, .velocity = {}},
                {.topology = cube(),
                 .radius = 0.5,
                 .centre = {0.05, 0.02, 2 * half + 0.5 * half + 0.01},
                 .velocity = {}}};
      height = 2 * half + 0.5 * half;
    }
    ExplicitStep<3> dynamics(rigid(placed), test::walls_at(0, 10),
                             {.solver = exact, .friction = 0.5, .wall_friction = 0.5, .gravity = {0, 0, -g}});
    for (int k = 0; k < 500; ++k) dynamics.step(dt);
    CHECK(std::abs(centre_of(dynamics.grains, 1)[2] - height) < 1e-6);
    CHECK(std::abs(centre_of(dynamics.grains, 0)[2] - half) < 1e-6);
    CHECK(norm(twist_of(dynamics.grains, 1).velocity) < 1e-6);
  }
}

TEST_CASE(
    "an oblique impact of a cube and an ellipsoid keeps momentum, angular momentum and its account of "
    "energy") {
  ExplicitStep<3> dynamics(rigid({{.topology = cube(),
                                   .radius = 1,
                                   .centre = {},
                                   .angle = test::some_turn(1),
                                   .velocity = {1, 0.2, 0}},
                                  {.topology = ellipsoid(),
                                   .radius = 0.8,
                                   .centre = {1.9, 0.4, 0.3},
                                   .angle = test::some_turn(3),
                                   .velocity = {-0.5, 0, 0.1}}}),
                           test::walls_at(-20, 20), {.solver = exact, .friction = 0.4});
  const Vec<3> momentum = dynamics.grains.momentum(), angular = angular_momentum(dynamics.grains);
  const double before = dynamics.grains.kinetic_energy();
  for (int k = 0; k < 1500; ++k) dynamics.step(0.001);
  CHECK(norm(dynamics.grains.momentum() - momentum) < 1e-11 * norm(momentum));
  CHECK(norm(angular_momentum(dynamics.grains) - angular) < 5e-3 * norm(angular));
  const double lost = before - dynamics.grains.kinetic_energy();
  CHECK(norm(twist_of(dynamics.grains, 1).spin) > 0.05);
  CHECK(lost > 0.05 * before);
  CHECK(std::abs(dynamics.work.contacts / lost - 1) < 1e-3);
}

TEST_CASE("an elastic sphere pressed by the faces of two rigid cubes bears what walls would press it with") {
  const auto force = [](bool walls) {
    const double nu = 0.45, v = 0.03;
    std::vector<PlacementOf<3>> placed{
        {.topology = test::ball(6), .radius = 1, .centre = {}, .angle = test::some_turn(1), .velocity = {}}};
    const double R = 3 / half;  // their faces reach beyond the sphere
    if (!walls)
      for (const double side : {-1.0, 1.0})
        placed.push_back(
            {.topology = cube(), .radius = R, .centre = {0, 0, side * (1 + 3)}, .velocity = {}, .kind = 1});
    SolidGrains grains(std::move(placed),
                       {GrainMaterial{.law = make_law(MaterialLaw::neo_hookean, 1, nu), .density = 1},
                        GrainMaterial{.law = {}, .density = 1, .rigid = true}});
    const double start = walls ? 1 : 1 + 6;
    ExplicitStep<3> dynamics(std::move(grains), test::walls_at(-start, start, v), {.damping_share = 0.5});
    const double dt = 0.6 * longest_stable_step(dynamics.grains, 0.5), steps = 0.2 / v / dt;
    double sum = 0;
    int count = 0;
    for (int k = 0; k < steps; ++k) {
      dynamics.step(dt);
      if (k < 0.95 * steps) continue;
      sum += norm(dynamics.wall_impulse(1)) / dt;
      ++count;
    }
    return sum / count;
  };
  const double by_walls = force(true), by_cubes = force(false);
  CHECK(by_walls > 0.02);
  // vertices and middles of patches meet faces as they meet walls; vertices alone are 5 % too soft
  CHECK(std::abs(by_cubes / by_walls - 1) < 1e-3);
}
