#include "softgrain/lattice/updated_lagrangian.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/polygon.hpp"
#include "softgrain/math/tensor.hpp"

using namespace softgrain;

namespace {

constexpr double cell = 0.1, rho = 2;
constexpr ShapeFunction shapes[] = {ShapeFunction::bilinear, ShapeFunction::gimp, ShapeFunction::bspline};

AnyLaw rubber() { return make_law(MaterialLaw::neo_hookean, 1, 0.3); }
double stable() { return stable_time_step(rubber(), rho, cell); }

PointGrain unit_disk(const Vec<2>& centre = {}) { return disk_of_points(1, centre, cell, 80); }

UpdatedLagrangianDynamics free_grain(PointGrain grain, ShapeFunction shape) {
  return {{std::move(grain)}, {}, rubber(), rho, {.shape = shape, .cell = cell}};
}

/// Two grains of different size that meet off centre, where they touch already.
UpdatedLagrangianDynamics collision(ShapeFunction shape, ContactOn contact_on) {
  PointGrain a = unit_disk({0.02, 0.01}), b = disk_of_points(0.8, {1.5, 0.98}, cell, 64);
  for (Vec<2>& v : a.velocity) v = {0.1, 0};
  for (Vec<2>& v : b.velocity) v = {-0.1, 0.03};
  return {{std::move(a), std::move(b)},
          {},
          rubber(),
          rho,
          {.shape = shape, .contact_on = contact_on, .cell = cell, .friction = 0.4}};
}

Vec<2> momentum(const UpdatedLagrangianDynamics& dynamics) {
  Vec<2> sum;
  for (const PointGrain& grain : dynamics.grains) sum += grain.momentum(rho);
  return sum;
}

}  // namespace

TEST_CASE("a disk of points has the area and the centre of a circle, and so has its outline") {
  const PointGrain grain = unit_disk({0.513, -0.277});
  CHECK(grain.area() == doctest::Approx(std::numbers::pi).epsilon(1e-13));
  CHECK(polygon_area(grain.outline) == doctest::Approx(std::numbers::pi).epsilon(1e-13));
  Vec<2> centre;
  for (int p = 0; p < grain.points(); ++p) {
    centre += grain.volume[p] / grain.area() * grain.position[p];
    CHECK(norm(grain.position[p] - Vec<2>{0.513, -0.277}) < 1);
  }
  CHECK(norm(centre - Vec<2>{0.513, -0.277}) < 1e-4);
  CHECK(grain.points() == doctest::Approx(4 * std::numbers::pi / (cell * cell)).epsilon(0.05));
  CHECK_THROWS_AS(disk_of_points(0.1, {}, cell, 8), UsageError);
}

TEST_CASE("a linear velocity field strains all points inside alike") {
  for (const ShapeFunction shape : shapes) {
    CAPTURE(static_cast<int>(shape));
    const Mat<2> A{{0.3, -0.2, 0.5, 0.1}};
    PointGrain grain = unit_disk();
    for (int p = 0; p < grain.points(); ++p) grain.velocity[p] = A * grain.position[p];
    const std::vector<Vec<2>> start = grain.position;
    UpdatedLagrangianDynamics dynamics = free_grain(std::move(grain), shape);
    dynamics.options.pic_share = 0;  // else what nodes near the border feel goes further in
    const double dt = stable();
    dynamics.step(dt);
    int inside = 0;
    for (std::size_t p = 0; p < start.size(); ++p) {
      if (norm(start[p]) > 1 - 5 * cell) continue;
      ++inside;
      const Mat<2> expected = identity<2>() + dt * A;
      for (std::size_t k = 0; k < 4; ++k)
        CHECK(dynamics.grains[0].F[p].c[k] == doctest::Approx(expected.c[k]).epsilon(1e-12));
    }
    CHECK(inside > 200);
  }
}

TEST_CASE("a uniform stress moves nothing inside, and pulls at the border") {
  for (const ShapeFunction shape : shapes) {
    CAPTURE(static_cast<int>(shape));
    PointGrain grain = unit_disk();
    for (Mat<2>& F : grain.F) F = {{1.2, 0.1, 0, 0.95}};
    UpdatedLagrangianDynamics dynamics = free_grain(std::move(grain), shape);
    dynamics.step(stable());
    double inner = 0, outer = 0;
    const PointGrain& moved = dynamics.grains[0];
    for (int p = 0; p < moved.points(); ++p) {
      double& speed = norm(moved.position[p]) < 1 - 7.5 * cell ? inner : outer;
      speed = std::max(speed, norm(moved.velocity[p]));
    }
    CHECK(outer > 1e-3);
    CHECK(inner < 1e-12 * outer);
  }
}

TEST_CASE("a grain in free flight keeps its shape and its speed, whatever cells it crosses") {
  for (const ShapeFunction shape : shapes) {
    CAPTURE(static_cast<int>(shape));
    PointGrain grain = unit_disk();
    const PointGrain start = grain;
    const Vec<2> v{0.7, -0.4};
    for (Vec<2>& v_p : grain.velocity) v_p = v;
    UpdatedLagrangianDynamics dynamics = free_grain(std::move(grain), shape);
    const double dt = stable();
    for (int k = 0; k < 100; ++k) dynamics.step(dt);
    const PointGrain& end = dynamics.grains[0];
    CHECK(norm(100 * dt * v) > 5 * cell);
    for (int p = 0; p < end.points(); ++p) {
      CHECK(norm(end.position[p] - start.position[p] - 100 * dt * v) < 1e-12);
      for (std::size_t k = 0; k < 4; ++k) CHECK(std::abs(end.F[p].c[k] - identity<2>().c[k]) < 1e-11);
    }
    for (std::size_t k = 0; k < end.outline.size(); ++k)
      CHECK(norm(end.outline[k] - start.outline[k] - 100 * dt * v) < 1e-12);
  }
}

TEST_CASE("grains of points that meet with friction keep their momentum, on outlines and on nodes") {
  for (const ContactOn contact_on : {ContactOn::outline, ContactOn::grid_nodes})
    for (const ShapeFunction shape : shapes) {
      CAPTURE(static_cast<int>(shape));
      UpdatedLagrangianDynamics dynamics = collision(shape, contact_on);
      const Vec<2> start = momentum(dynamics), start_a = dynamics.grains[0].momentum(rho);
      int contacts = 0;
      for (int k = 0; k < 300; ++k) {
        const SoftStepReport report = dynamics.step(stable());
        contacts = std::max(contacts, report.contacts);
        CHECK(report.converged);
      }
      CHECK(contacts > 3);
      CHECK(norm(dynamics.grains[0].momentum(rho) - start_a) > 0.05);
      CHECK(norm(momentum(dynamics) - start) < 1e-12);
    }
}

TEST_CASE("gravity gives a free grain its weight times the time") {
  UpdatedLagrangianDynamics dynamics({unit_disk()}, {}, rubber(), rho, {.cell = cell, .gravity = {0.3, -2}});
  for (int k = 0; k < 10; ++k) dynamics.step(stable());
  const double weight_time = rho * std::numbers::pi * 10 * stable();
  CHECK(norm(momentum(dynamics) - weight_time * Vec<2>{0.3, -2}) < 1e-12);
}

TEST_CASE("the answer of a lattice contact to an impulse is its Delassus block, momentum is kept") {
  std::vector<PointGrain> grains{unit_disk(), disk_of_points(0.8, {1.75, 0}, cell, 64)};
  Lattice lattice(ShapeFunction::bspline, cell);
  lattice.reset(grains);
  const auto fill = [&](int g) {
    for (int p = 0; p < grains[g].points(); ++p)
      Stencil(lattice.shape(), grains[g].position[p], cell)
          .for_each_node([&](int i, int j, double N, const Vec<2>&) {
            lattice.mass[lattice.node(g, i, j)] += N * grains[g].volume[p];
          });
  };
  fill(0), fill(1);
  OutlineWeights outline{.first_vertex = {0}, .weights = {}};
  for (int g = 0; g < 2; ++g) {
    for (const Vec<2>& x : grains[g].outline)
      lattice.vertex_weights(g, x, 1e-4 * cell * cell, outline.weights.emplace_back());
    outline.first_vertex.push_back(static_cast<int>(outline.weights.size()));
  }
  LatticeContacts system(lattice);
  add_outline_contacts(grains, lattice, outline, {}, 1e-3, system);
  REQUIRE(system.size() > 3);
  for (int c = 0; c < system.size(); ++c) {
    CHECK(system.contacts()[c].grain == 1);  // the smaller one is the slave
    const Vec<2> dp{0.3, -0.2}, before = system.relative_velocity(c);
    system.apply_impulse(c, dp);
    const Vec<2> answer = system.relative_velocity(c) - before;
    CHECK(norm(answer - system.delassus_block(c) * dp) < 1e-12 * norm(answer));
    Vec<2> sum;
    for (int i = 0; i < lattice.nodes(); ++i) sum += lattice.mass[i] * lattice.velocity[i];
    CHECK(norm(sum) < 1e-14);
  }
}

TEST_CASE("an updated-Lagrangian point that is turned inside out is not computed on") {
  PointGrain grain = unit_disk();
  grain.F[17] = {{-1, 0, 0, 1}};
  UpdatedLagrangianDynamics dynamics = free_grain(std::move(grain), ShapeFunction::gimp);
  CHECK_THROWS_AS(dynamics.step(stable()), NumericalError);
}
