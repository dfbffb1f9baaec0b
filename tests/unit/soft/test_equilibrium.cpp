#include "softgrain/soft/equilibrium.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <vector>

#include "softgrain/geometry/polygon.hpp"
#include "softgrain/material/elastic_law.hpp"
#include "softgrain/soft/point_states.hpp"
#include "support/energy_differences.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

/// Ten grains of different radii and angles on a coarse grid: two batches, the second with empty lanes.
SoftGrains ten_grains(MaterialLaw law, double nu = 0.3) {
  const auto shape = test::disk(2);
  std::vector<GrainPlacement> grains;
  for (int g = 0; g < 10; ++g) grains.push_back(test::placed(shape, 1 + 0.1 * g, {3.0 * g, 1}, {}, 0.4 * g));
  return {std::move(grains), make_law(law, test::parameters(1, nu)), 1};
}

bool objective(const AnyLaw& law) {
  return std::visit([]<class Law>(const Law&) { return Law::objective; }, law);
}

/// P of an undeformed point that is brought to F.
Mat<2> stress_of(const AnyLaw& any, const Mat<2>& F) {
  return std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (HistoryLaw<Law, 2>)
          return law.stress(F, Law::template undeformed<2, double>(), 0);
        else
          return law.stress(F);
      },
      any);
}

double largest(const Vec<2, Wide>& v) {
  double size = 0;
  for (int lane = 0; lane < Wide::size; ++lane) size = std::max(size, norm(test::lane_of(v, lane)));
  return size;
}

}  // namespace

TEST_CASE("internal force is the derivative of the elastic energy") {
  for (const LawChoice& choice : law_choices()) {
    CAPTURE(choice.name);
    SoftGrains grains = ten_grains(choice.law);
    test::shake(grains, 0.05);
    test::move_nodes(grains, [](int lane, const Vec<2>& x) {  // J from 0.5 to 2 in the last lanes
      return Vec<2>{x[0], (lane < 5 ? 1 : lane == 5 ? 2 : lane == 6 ? 0.5 : 0.8) * x[1]};
    });
    GrainBatch& batch = grains.batches[0];
    WideVectors force;
    REQUIRE(internal_force(grains, batch, force) == 0);
    std::vector<std::size_t> nodes(batch.position.size());
    std::iota(nodes.begin(), nodes.end(), std::size_t{0});
    CHECK(test::worst_of_energy_differences<2>(grains, batch, force, nodes, 1e-6) < 1e-7);
  }
}

// K is seen through its factor: of (A + K) x = b the solution must satisfy A x + K x = b with K x by
// differences of the force.
TEST_CASE("the stiffness in the Cholesky factor is the derivative of the internal force") {
  for (const LawChoice& choice : law_choices()) {
    CAPTURE(choice.name);
    SoftGrains grains = ten_grains(choice.law);
    test::shake(grains, 0.05);
    GrainBatch& batch = grains.batches[0];
    BatchedCholesky matrix(batch.topology->pattern);
    matrix.clear();
    add_stiffness(grains, batch, matrix);
    const int nodes = batch.topology->grid.nodes();
    constexpr double shift = 2;
    for (int i = 0; i < nodes; ++i) matrix.add(i, i, {shift, 0.0, 0.0, shift});
    REQUIRE(matrix.factor() == 0);
    test::RandomNumbers random(8);
    std::vector<Wide> b(2 * nodes);
    for (Wide& entry : b)
      for (int lane = 0; lane < Wide::size; ++lane) entry.set(lane, random.uniform(-1, 1));
    std::vector<Wide> x = b;
    matrix.solve(x);

    constexpr double step = 1e-6;
    const WideVectors start = batch.position;
    const auto force_at = [&](double s) {
      for (int i = 0; i < nodes; ++i)
        for (int d = 0; d < 2; ++d) batch.position[i][d] = start[i][d] + Wide(s) * x[2 * i + d];
      WideVectors force;
      internal_force(grains, batch, force);
      return force;
    };
    const WideVectors above = force_at(step), below = force_at(-step);
    double worst = 0;
    for (int i = 0; i < nodes; ++i)
      for (int d = 0; d < 2; ++d)
        for (int lane = 0; lane < Wide::size; ++lane) {
          const double Kx = (above[i][d] - below[i][d])[lane] / (2 * step);
          worst = std::max(worst, std::abs(shift * x[2 * i + d][lane] + Kx - b[2 * i + d][lane]));
        }
    CHECK(worst < 1e-8);
  }
}

TEST_CASE("a grain turned and moved as a rigid body feels no force and has no energy") {
  for (const LawChoice& choice : law_choices()) {
    CAPTURE(choice.name);
    SoftGrains grains = ten_grains(choice.law);
    if (!objective(grains.law(grains.batches[0]))) continue;
    test::move_nodes(grains, [](int lane, const Vec<2>& x) {
      const double c = std::cos(0.7 * lane), s = std::sin(0.7 * lane);
      return Vec<2>{c * x[0] - s * x[1] + 5, s * x[0] + c * x[1] - 2};
    });
    for (const GrainBatch& batch : grains.batches) {
      WideVectors force;
      REQUIRE(internal_force(grains, batch, force) == 0);
      for (const auto& f : force) CHECK(largest(f) < 1e-13);
      for (int lane = 0; lane < Wide::size; ++lane)
        CHECK(std::abs(elastic_energy(grains, batch)[lane]) < 1e-13);
    }
  }
}

TEST_CASE("internal forces sum to zero, and so do their moments about any point") {
  for (const LawChoice& choice : law_choices()) {
    CAPTURE(choice.name);
    SoftGrains grains = ten_grains(choice.law);
    test::shake(grains, 0.05);
    const GrainBatch& batch = grains.batches[0];
    WideVectors force;
    internal_force(grains, batch, force);
    Vec<2, Wide> sum;
    Wide moment = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i) {
      sum += force[i];
      moment += batch.position[i][0] * force[i][1] - batch.position[i][1] * force[i][0];
    }
    CHECK(largest(sum) < 1e-14);
    if (!objective(grains.law(grains.batches[0]))) continue;
    for (int lane = 0; lane < Wide::size; ++lane) CHECK(std::abs(moment[lane]) < 1e-13);
  }
}

TEST_CASE("the smallest J of a grain is that of its most squeezed point") {
  SoftGrains grains = ten_grains(MaterialLaw::neo_hookean);
  test::shake(grains, 0.1);
  for (int g = 0; g < grains.size(); ++g) {
    double least = 1e9;
    for (const PointState& point : point_states(grains, g)) {
      const auto& F = point.F;
      least = std::min(least, F(0, 0) * F(1, 1) - F(0, 1) * F(1, 0));
    }
    const auto [batch, lane] = grains.batch_of(g);
    CHECK(least_J(*batch)[lane] == doctest::Approx(least).epsilon(1e-14));
  }
}

TEST_CASE("patch test: one F everywhere gives one stress everywhere, and forces on the outline only") {
  const Mat<2> F{{1.1, 0.2, -0.1, 0.9}};
  for (const LawChoice& choice : law_choices()) {
    CAPTURE(choice.name);
    const auto shape = test::disk(3);
    SoftGrains grains({test::placed(shape, 2, {0, 0})}, make_law(choice.law, test::parameters(1, 0.3)), 1);
    test::move_nodes(grains, [&](int, const Vec<2>& x) { return F * x; });
    const auto states = point_states(grains, 0);
    REQUIRE(states.size() == shape->points.size());
    const Mat<2> P = stress_of(grains.law(grains.batches[0]), F);
    const double J = F(0, 0) * F(1, 1) - F(0, 1) * F(1, 0);
    for (const PointState& point : states)
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          CHECK(point.F(i, j) == doctest::Approx(F(i, j)));
          const double cauchy = (P(i, 0) * F(j, 0) + P(i, 1) * F(j, 1)) / J;
          CHECK(std::abs(point.stress(i, j) - cauchy) < 1e-14);
        }
    // of laws that flow the mean of all three: the bulk modulus E/(3 (1 - 2 nu)) times ln J, over J
    const double pressure = grains.has_history() ? -std::log(J) / (1.2 * J)
                                                 : -(states[0].stress(0, 0) + states[0].stress(1, 1)) / 2;
    CHECK(std::abs(states[0].pressure - pressure) < 1e-14);
    WideVectors force;
    internal_force(grains, grains.batches[0], force);
    const ReferenceGrid& grid = shape->grid;
    for (int i = 0; i < grid.outline_begin; ++i) CHECK(largest(force[i]) < 1e-14);
    // on the outline the force is P N over half of each edge: P (X_next - X_previous) turned right, over 2
    const int n = grid.outline_nodes();
    for (int k = 0; k < n; ++k) {
      const auto X = grid.outline();
      const Vec<2> chord = X[(k + 1) % n] - X[(k + n - 1) % n];
      const Vec<2> traction = P * (-1.0 * perpendicular(chord));  // R/2 = 1
      CHECK(norm(test::lane_of(force[grid.outline_begin + k], 0) - traction) < 1e-14);
    }
  }
}

TEST_CASE("a grain turned inside out is named by its lane, whatever the law") {
  for (const LawChoice& choice : law_choices()) {
    CAPTURE(choice.name);
    SoftGrains grains = ten_grains(choice.law);
    GrainBatch& batch = grains.batches[0];
    for (Vec<2, Wide>& x : batch.position) x[1].set(3, -x[1][3]);  // the mirror image
    WideVectors force;
    CHECK(internal_force(grains, batch, force) == 1u << 3);
  }
}

TEST_CASE("a grain is free of stress as it was placed, at any angle, whatever the law") {
  for (const LawChoice& choice : law_choices()) {
    CAPTURE(choice.name);
    const SoftGrains grains = ten_grains(choice.law);
    for (const GrainBatch& batch : grains.batches) {
      const Wide energy = elastic_energy(grains, batch);
      for (int lane = 0; lane < Wide::size; ++lane) CHECK(std::abs(energy[lane]) < 1e-14);
    }
    for (int g = 0; g < grains.size(); ++g)
      for (const PointState& point : point_states(grains, g)) {
        CHECK(std::abs(point.F(0, 1)) < 1e-14);
        CHECK(std::abs(point.pressure) < 1e-14);
      }
  }
}

// theory, section 10, orientation: Hooke's energy of a pure rotation by phi is 2 (lambda + mu) (1 - cos
// phi)^2 V
TEST_CASE("small-strain Hooke takes a turn after placement for the strain cos(phi) - 1, and says how much") {
  SoftGrains grains = ten_grains(MaterialLaw::small_strain_hooke);
  const auto [lambda, mu] = lame(1, 0.3);
  test::move_nodes(grains, [](int, const Vec<2>& x) {
    return Vec<2>{std::cos(0.2) * x[0] - std::sin(0.2) * x[1], std::sin(0.2) * x[0] + std::cos(0.2) * x[1]};
  });
  const double e = 1 - std::cos(0.2);
  for (const GrainBatch& batch : grains.batches) {
    const Wide energy = elastic_energy(grains, batch);
    for (int lane = 0; lane < Wide::size; ++lane) {
      const double area =  // of the cells
          polygon_area(batch.topology->grid.outline()) * batch.radius[lane] * batch.radius[lane];
      CHECK(energy[lane] == doctest::Approx(2 * (lambda + mu) * e * e * area).epsilon(1e-10));
    }
  }
}

TEST_CASE(
    "a cell that keeps its area stores no energy of volume, though each of its points changes its own") {
  const auto cell = std::make_shared<const Topology>(
      ReferenceGrid{.node = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, .cell = {{0, 1, 2, 3}}, .outline_begin = 0});
  for (const LawChoice& choice : law_choices()) {
    CAPTURE(choice.name);
    const auto energy = [&](double nu) {  // mu = 1
      SoftGrains grains({test::placed(cell, 1, {0, 0})},
                        make_law(choice.law, test::parameters(2 * (1 + nu), nu)), 1);
      for (int i = 0; i < 4; ++i)  // the hourglass
        grains.batches[0].position[i][0] += Wide(i % 2 == 0 ? 1e-3 : -1e-3);
      return elastic_energy(grains, grains.batches[0])[0];
    };
    REQUIRE(energy(0) > 1e-7);
    CHECK(energy(0.4999) < 1.05 * energy(0));  // lambda is 0 and 5000
  }
}
