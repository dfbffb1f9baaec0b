#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "support/energy_differences.hpp"
#include "support/solid_grains.hpp"

using namespace softgrain;

namespace {

/// f_i = sum_p V_p P_p dN_i/dX of one lane, from F and the law alone.
std::vector<Vec<3>> plain_force(const SolidGrains& grains, const SolidBatch& batch, int lane) {
  const SolidTopology& shape = *batch.topology;
  const auto law = std::get<NeoHookean<LogVolume>>(grains.law(batch));
  std::vector<Vec<3>> force(shape.grid.node.size());
  for (std::size_t p = 0; p < shape.points.size(); ++p) {
    const auto& cell = shape.grid.cell[p / 8];
    Mat<3> F;
    for (std::size_t a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          F(i, j) +=
              batch.position[static_cast<std::size_t>(cell[a])][i][lane] * shape.points[p].gradient[a][j];
    const Mat<3> P = law.stress(F);
    for (std::size_t a = 0; a < 8; ++a)
      force[static_cast<std::size_t>(cell[a])] += shape.points[p].volume * (P * shape.points[p].gradient[a]);
  }
  return force;
}

double largest(const WidePlaces<3>& v) {
  double size = 0;
  for (const Vec<3, Wide>& of_node : v)
    for (int lane = 0; lane < Wide::size; ++lane) size = std::max(size, norm(lane_of(of_node, lane)));
  return size;
}

}  // namespace

TEST_CASE("the grid of a ball has its vertices on the sphere, no folded cell, and the mass of the ball") {
  for (const int n : {2, 3, 4, 6}) {
    CAPTURE(n);
    const SolidTopology ball(ball_grid(n));
    CHECK(ball.grid.outline_nodes() == 6 * n * n + 2);
    CHECK(static_cast<int>(ball.grid.quad.size()) == 6 * n * n);
    for (int i = ball.grid.outline_begin; i < ball.grid.nodes(); ++i)
      CHECK(norm(ball.grid.node[static_cast<std::size_t>(i)]) == doctest::Approx(1));
    for (const SolidPoint& point : ball.points) CHECK(point.volume > 0);
    double mass = 0;
    for (const double of_node : ball.node_volume) mass += of_node;
    CHECK(mass == doctest::Approx(4 * std::numbers::pi / 3));
    CHECK(ball.volume == doctest::Approx(4 * std::numbers::pi / 3));
  }
  CHECK(ball_grid(6).nodes() == 997);  // 6912 points
  CHECK(ball_grid(6).cell.size() == 864);
  CHECK_THROWS_AS(ball_grid(1), UsageError);
}

TEST_CASE("the force from edges is the force from F") {
  SolidGrains grains = test::balls(3, 8, 0.45);
  test::shake(grains, 0.02);
  const SolidBatch& batch = grains.batches[0];
  WidePlaces<3> force;
  REQUIRE(internal_force(grains, batch, force) == 0);
  for (const int lane : {0, 5}) {
    const auto plain = plain_force(grains, batch, lane);
    double worst = 0;
    for (std::size_t i = 0; i < plain.size(); ++i)
      worst = std::max(worst, norm(lane_of(force[i], lane) - plain[i]));
    CHECK(worst < 1e-13);  // forces are about 0.1
  }
}

TEST_CASE("the force of grains in space is the derivative of their elastic energy") {
  using enum MaterialLaw;
  for (const MaterialLaw law : {neo_hookean, neo_hookean_quadratic, hencky, yeoh})
    for (const bool mean_dilatation : {false, true}) {
      CAPTURE(law_choice(law).name);
      CAPTURE(mean_dilatation);
      SolidGrains grains = test::balls(2, 8, 0.4, mean_dilatation, law);
      test::shake(grains, 0.03);
      SolidBatch& batch = grains.batches[0];
      WidePlaces<3> force;
      REQUIRE(internal_force(grains, batch, force) == 0);
      CHECK(test::worst_of_energy_differences<3>(grains, batch, force, {0, 13, 30, 52}, 1e-5) < 1e-8);
    }
}

TEST_CASE("a grain in space that turns and moves as a rigid body feels no force") {
  for (const bool mean_dilatation : {false, true}) {
    SolidGrains grains = test::balls(3, 8, 0.45, mean_dilatation);
    const Mat<3> Q = test::some_turn(5);
    test::move_nodes(grains, [&](const Vec<3>& x) { return Q * x + Vec<3>{1, -2, 3}; });
    WidePlaces<3> force;
    REQUIRE(internal_force(grains, grains.batches[0], force) == 0);
    CHECK(largest(force) < 1e-13);
    CHECK(std::abs(elastic_energy(grains, grains.batches[0])[3]) < 1e-13);
  }
}

TEST_CASE("a grain in space that is turned inside out is named") {
  SolidGrains grains = test::balls(2, 3, 0.3);
  grains.batches[0].position[0][2].set(1, 5.0);
  WidePlaces<3> force;
  CHECK((internal_force(grains, grains.batches[0], force) & 7u) == 2u);
  CHECK(least_J(grains.batches[0])[1] < 0);
  CHECK(least_J(grains.batches[0])[0] == doctest::Approx(1));
}

// From an independent program: 0.111 and 0.071 R/c_E, c_E = sqrt(E/rho), with density not scaled to the
// ball's volume.
TEST_CASE("the stable step of a ball is that of the grid as a whole") {
  const double by_mass = std::sqrt(ball_grid(4).fullness);
  CHECK(longest_stable_step(test::balls(4, 1, 0.45), 0) == doctest::Approx(0.111 * by_mass).epsilon(0.03));
  CHECK(longest_stable_step(test::balls(4, 1, 0.45), 0.5) ==
        doctest::Approx(0.111 * by_mass / std::sqrt(2)).epsilon(0.03));
}

TEST_CASE("explicit steps of a ball stay bounded just below the stable step, and grow just above") {
  const auto grown = [](double share) {
    ExplicitStep<3> dynamics(test::balls(2, 1, 0.45), {}, {});
    test::shake(dynamics.grains, 1e-9);
    const double dt = share * longest_stable_step(dynamics.grains, 0);
    dynamics.stable = {.longest = 10, .until_look = 100000};
    for (int k = 0; k < 400; ++k) dynamics.step(dt);
    return dynamics.grains.kinetic_energy();
  };
  CHECK(grown(0.97) < 1e-16);
  CHECK_THROWS_AS(grown(1.05), NumericalError);  // a point is turned inside out
}

TEST_CASE("laws of the plane, or that do not turn with the grain, are refused in space") {
  MaterialParameters parameters{.young_modulus = 1, .poisson_ratio = 0.3, .yield_stress = 1};
  const auto refused = [&](MaterialLaw law) {
    CHECK_THROWS_AS(require_solid({make_law(law, parameters), 1}), UsageError);
  };
  require_solid({make_law(MaterialLaw::von_mises, parameters), 1});
  parameters.kinematic_modulus = 0.1;
  refused(MaterialLaw::von_mises);
  refused(MaterialLaw::small_strain_hooke);
  refused(MaterialLaw::corotated);
}
