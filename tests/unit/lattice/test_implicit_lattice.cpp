#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "softgrain/core/parallel.hpp"
#include "softgrain/lattice/compliant_contacts.hpp"
#include "softgrain/lattice/updated_lagrangian.hpp"
#include "softgrain/material/lame.hpp"
#include "softgrain/math/tensor.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;

namespace {

constexpr double E = 1e7, nu = 0.45, rho = 990;

UpdatedLagrangianOptions implicit_options(ShapeFunction shape, ContactOn contact_on, double cell) {
  return {.shape = shape, .contact_on = contact_on, .cell = cell, .implicit = true};
}

Wall<2> wall(const Vec<2>& point, const Vec<2>& normal, const Vec<2>& velocity = {}) {
  return {.point = point, .normal = normal, .velocity = velocity};
}

/// A block of whole cells, width x height of them, its corner at the origin; vertices all along its edges.
PointGrain block(int width, int height, double cell) {
  PointGrain grain;
  grain.radius = cell * std::min(width, height) / 2;
  for (int j = 0; j < 2 * height; ++j)
    for (int i = 0; i < 2 * width; ++i) {
      grain.position.push_back({cell * (0.5 * i + 0.25), cell * (0.5 * j + 0.25)});
      grain.volume.push_back(0.25 * cell * cell);
    }
  grain.velocity.resize(grain.position.size());
  grain.F.assign(grain.position.size(), identity<2>());
  const auto edge = [&](int cells, Vec<2> from, const Vec<2>& along) {
    for (int k = 0; k < cells; ++k) grain.outline.push_back(from + (k * cell) * along);
  };
  edge(width, {}, {1, 0});
  edge(height, {width * cell, 0}, {0, 1});
  edge(width, {width * cell, height * cell}, {-1, 0});
  edge(height, {0, height * cell}, {0, -1});
  return grain;
}

double momentum(const UpdatedLagrangianDynamics& d, int axis) {
  double sum = 0;
  for (const PointGrain& grain : d.grains) sum += grain.momentum(d.density)[axis];
  return sum;
}

double kinetic_energy(const UpdatedLagrangianDynamics& d) {
  double sum = 0;
  for (const PointGrain& grain : d.grains) sum += grain.kinetic_energy(d.density);
  return sum;
}

/// walls + gravity - dK - internal - inertia - contacts - damping [J/m], from rest.
double energy_error(const UpdatedLagrangianDynamics& d) {
  const WorkBudget& w = d.work;
  return w.walls + w.gravity - kinetic_energy(d) - w.internal - w.inertia - w.contacts - w.damping;
}

constexpr double R = 5e-3;

/// A disk between walls, of which the top one comes down.
UpdatedLagrangianDynamics pressed_disk(const UpdatedLagrangianOptions& options, MaterialLaw law,
                                       double speed) {
  PointGrain grain = disk_of_points(R, {}, options.cell, 64);
  double reach = 0;
  for (const Vec<2>& x : grain.outline) reach = std::max(reach, x[1]);
  return {{grain},
          {wall({0, -reach}, {0, 1}), wall({0, reach}, {0, -1}, {0, -speed})},
          make_law(law, E, nu),
          rho,
          options};
}

/// F/(E* R) at an approach d/R, the mean over both walls and 10 % of d.
double force_at(UpdatedLagrangianDynamics& d, double approach, double speed, double dt) {
  const auto steps_to = [&](double a) { return static_cast<int>(2 * a * R / (speed * dt)); };
  for (int step = 0; step < steps_to(0.95 * approach); ++step) d.step(dt);
  double impulse = 0, time = 0;
  for (int step = steps_to(0.95 * approach); step < steps_to(1.05 * approach); ++step, time += dt) {
    d.step(dt);
    impulse += (d.wall_impulse(1)[1] - d.wall_impulse(0)[1]) / 2;
  }
  return impulse / time * (1 - nu * nu) / (E * R);
}

}  // namespace

TEST_CASE("the matrix of a grain's nodes is the derivative of their forces, for a law of finite strain too") {
  for (const MaterialLaw name : {MaterialLaw::small_strain_hooke, MaterialLaw::neo_hookean})
    for (const ShapeFunction shape : {ShapeFunction::bilinear, ShapeFunction::gimp, ShapeFunction::bspline}) {
      CAPTURE(shape);
      test::RandomNumbers random(3);
      const double cell = 0.4, dt = 0.5, step = name == MaterialLaw::neo_hookean ? 1e-6 : 1e-2;
      const AnyLaw law = make_law(name, 1, 0.3);
      PointGrain grain = disk_of_points(1, {0.03, 0.01}, cell, 16);
      for (Mat<2>& F : grain.F)
        for (double& entry : F.c) entry += random.uniform(-0.05, 0.05);
      Lattice lattice(shape, cell);
      lattice.reset(std::vector<PointGrain>{grain});
      std::vector<Stencil> stencil;
      for (int p = 0; p < grain.points(); ++p) {
        stencil.emplace_back(shape, grain.position[p], cell);
        stencil[p].for_each_node([&](int column, int row, double N, const Vec<2>&) {
          lattice.mass[lattice.node(0, column, row)] += N * grain.volume[p];
        });
      }
      GrainEquations equations;
      equations.number(lattice, 0, stencil);
      std::vector<Mat<2>> F;
      REQUIRE(strained(lattice, 0, grain, stencil, dt, F));
      REQUIRE(equations.factor(lattice, grain, stencil, F, law, dt));
      std::vector<Vec<2>> before(lattice.nodes()), after(lattice.nodes());
      add_internal_force(lattice, 0, grain, stencil, F, law, before);
      for (const int i : equations.nodes())
        lattice.velocity[i] = {step * random.uniform(-1, 1), step * random.uniform(-1, 1)};
      REQUIRE(strained(lattice, 0, grain, stencil, dt, F));
      add_internal_force(lattice, 0, grain, stencil, F, law, after);
      std::vector<Vec<2>> change;  // A dt v = M v/dt - df
      for (const int i : equations.nodes())
        change.push_back((lattice.mass[i] / dt) * lattice.velocity[i] - (after[i] - before[i]));
      equations.solve(change);
      double error = 0;
      for (std::size_t k = 0; k < change.size(); ++k)
        error = std::max(error, norm(1 / dt * change[k] - lattice.velocity[equations.nodes()[k]]));
      CHECK(error < (name == MaterialLaw::neo_hookean ? 1e-3 : 1e-9) * step);
    }
}

TEST_CASE("a block between four walls comes to rest with the modulus of uniaxial strain in implicit steps") {
  // sigma_yy = M e, sigma_xx = lambda e of the strain e = 1e-4, M = lambda + 2 mu; to the square of e
  const Lame modulus = lame(E, nu);
  for (const ContactOn contact_on : {ContactOn::outline, ContactOn::grid_nodes}) {
    CAPTURE(contact_on);
    const double cell = 1e-3, dt = 1e-4, e = 1e-4;
    const int width = 6, height = 8;
    const double W = width * cell, H = height * cell, speed = e * H / dt;
    UpdatedLagrangianOptions options = implicit_options(ShapeFunction::bilinear, contact_on, cell);
    options.tolerance = 1e-8;
    UpdatedLagrangianDynamics d({block(width, height, cell)},
                                {wall({0, 0}, {0, 1}), wall({0, H}, {0, -1}, {0, -speed}),
                                 wall({0, 0}, {1, 0}), wall({W, 0}, {-1, 0})},
                                make_law(MaterialLaw::small_strain_hooke, E, nu), rho, options);
    d.step(dt);
    d.box.walls[1].velocity = {};
    for (int step = 0; step < 30; ++step) CHECK(d.step(dt).converged);
    const double M = modulus.lambda + 2 * modulus.mu;
    CHECK(std::abs(d.wall_impulse(1)[1] / dt / (M * e * W) - 1) < 2 * e);
    CHECK(std::abs(-d.wall_impulse(0)[1] / dt / (M * e * W) - 1) < 2 * e);
    CHECK(std::abs(d.wall_impulse(3)[0] / dt / (modulus.lambda * e * H) - 1) < 2 * e);
    CHECK(std::abs(d.elastic_energy() / (M * e * e * W * H / 2) - 1) < 2 * e);
  }
}

TEST_CASE("a grain of points falls freely by backward Euler") {
  const double dt = 2e-5, g = -9.81;
  UpdatedLagrangianOptions options = implicit_options(ShapeFunction::gimp, ContactOn::grid_nodes, 0.118 * R);
  options.gravity = {0, g};
  UpdatedLagrangianDynamics d({disk_of_points(R, {0.3e-3, 0.1e-3}, options.cell, 64)}, {},
                              make_law(MaterialLaw::neo_hookean, E, nu), rho, options);
  const std::vector<Vec<2>> start = d.grains[0].position;
  const int steps = 40;
  for (int step = 0; step < steps; ++step) d.step(dt);
  for (int p = 0; p < d.grains[0].points(); ++p) {
    CHECK(std::abs(d.grains[0].velocity[p][1] / (g * steps * dt) - 1) < 1e-9);
    CHECK(std::abs((d.grains[0].position[p] - start[p])[1] / (g * dt * dt * steps * (steps + 1) / 2) - 1) <
          1e-6);
  }
  CHECK(d.elastic_energy() < 1e-12 * kinetic_energy(d));
  CHECK(std::abs(energy_error(d)) < 1e-9 * kinetic_energy(d));
}

TEST_CASE("grains that collide on a lattice in implicit steps keep their momentum and account for energy") {
  for (const ContactOn contact_on : {ContactOn::outline, ContactOn::grid_nodes}) {
    CAPTURE(contact_on);
    const double cell = 0.16 * R;
    UpdatedLagrangianOptions options = implicit_options(ShapeFunction::bilinear, contact_on, cell);
    options.friction = 0.4;
    UpdatedLagrangianDynamics d(
        {disk_of_points(R, {0, 0}, cell, 48), disk_of_points(0.8 * R, {1.5 * R, 1.15 * R}, cell, 40)}, {},
        make_law(MaterialLaw::neo_hookean, E, nu), rho, options);
    for (Vec<2>& v : d.grains[1].velocity) v = {-2, -1};
    const double x = momentum(d, 0), y = momentum(d, 1), kinetic = kinetic_energy(d);
    double met = 0;
    for (int step = 0; step < 40; ++step) {
      d.step(1e-5);
      for (const Vec<2>& p : d.impulse) met += p[0];
    }
    CHECK(met > 0.1 * std::abs(x));
    CHECK(std::abs(momentum(d, 0) / x - 1) < 1e-11);
    CHECK(std::abs(momentum(d, 1) / y - 1) < 1e-11);
    CHECK(kinetic_energy(d) + d.elastic_energy() < kinetic);
    CHECK(std::abs(energy_error(d) + kinetic) < 1e-3 * kinetic);
    CHECK(d.work.friction >= 0);
  }
}

TEST_CASE("the force on a disk of points is the same in explicit and in implicit steps of any length") {
  const double speed = 0.5, approach = 0.05;
  UpdatedLagrangianOptions options = implicit_options(ShapeFunction::gimp, ContactOn::outline, 0.16 * R);
  options.implicit = false;
  const MaterialLaw law = MaterialLaw::neo_hookean;
  const double stable = stable_time_step(make_law(law, E, nu), rho, options.cell);
  UpdatedLagrangianDynamics with_explicit = pressed_disk(options, law, speed);
  const double force = force_at(with_explicit, approach, speed, stable);
  options.implicit = true;
  CHECK(std::abs(force / 0.03168 - 1) < 0.06);  // finite elements: what this lattice can do
  double shortest = 0;
  for (const double steps : {3., 10., 20., 40.}) {
    UpdatedLagrangianDynamics d = pressed_disk(options, law, speed);
    const double implicit = force_at(d, approach, speed, steps * stable);
    MESSAGE("implicit over explicit force, steps ", steps, " times as long: ", implicit / force);
    CHECK(std::abs(implicit / force - 1) < 0.04);
    if (shortest == 0) shortest = implicit;
    CHECK(std::abs(implicit / shortest - 1) < 0.015);
    CHECK(std::abs(energy_error(d)) < 1e-3 * d.work.walls);
  }
}

TEST_CASE("implicit steps on a lattice have the same bits on one and on three threads") {
  const auto run = [](int count) {
    set_threads(count);
    const double cell = 0.16 * R;
    UpdatedLagrangianOptions options = implicit_options(ShapeFunction::bilinear, ContactOn::grid_nodes, cell);
    options.friction = 0.3;
    UpdatedLagrangianDynamics d({disk_of_points(R, {0, 0}, cell, 48), disk_of_points(R, {2 * R, 0}, cell, 48),
                                 disk_of_points(R, {R, 1.74 * R}, cell, 48)},
                                {wall({0, -R}, {0, 1}), wall({0, 2.75 * R}, {0, -1}, {0, -2})},
                                make_law(MaterialLaw::neo_hookean, E, nu), rho, options);
    for (int step = 0; step < 6; ++step) d.step(1e-5);
    return d;
  };
  const int before = threads();
  const UpdatedLagrangianDynamics one = run(1), three = run(3);
  set_threads(before);
  for (std::size_t g = 0; g < one.grains.size(); ++g) {
    CHECK((one.grains[g].position == three.grains[g].position));
    CHECK((one.grains[g].velocity == three.grains[g].velocity));
  }
  CHECK((one.impulse == three.impulse));
  CHECK(!one.impulse.empty());
}
