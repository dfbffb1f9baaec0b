#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "softgrain/material/element_test.hpp"
#include "softgrain/soft/history.hpp"
#include "support/solid_grains.hpp"
#include "support/solid_simulations.hpp"

using namespace softgrain;

namespace {

SolidGrains one_ball(const AnyLaw& law, bool mean_dilatation) {
  return {
      {{.topology = test::ball(2), .radius = 2, .centre = {}, .angle = test::some_turn(1), .velocity = {}}},
      {GrainMaterial{.law = law, .density = 1, .mean_dilatation = mean_dilatation}}};
}

/// One ball that follows F of the element test as a whole.
struct FollowingBall {
  SolidGrains grains;
  std::vector<Vec<3>> start;
  double volume = 0, dissipated = 0;
  Mat<3> stress;  // Cauchy's, from the forces on its nodes

  explicit FollowingBall(const AnyLaw& law, bool mean_dilatation = true)
      : grains(one_ball(law, mean_dilatation)) {
    const SolidTopology& shape = grains.topology(0);
    for (int i = 0; i < shape.grid.nodes(); ++i) start.push_back(grains.node_position(0, i));
    for (const SolidPoint& point : shape.points) volume += 8 * point.volume;
  }
  void go_to(const Mat<3>& F, double dt) {
    SolidBatch& batch = grains.batches[0];
    for (std::size_t i = 0; i < start.size(); ++i)
      for (int d = 0; d < 3; ++d)
        for (int lane = 0; lane < Wide::size; ++lane) batch.position[i][d].set(lane, (F * start[i])[d]);
    WidePlaces<3> force;
    FlowOfStep flow;
    REQUIRE(internal_force_and_history(grains, batch, force, dt, flow) == 0);
    dissipated += flow.dissipated[0] / volume;
    Mat<3> sum;  // sum_i f_i (x) x_i = V J sigma
    for (std::size_t i = 0; i < start.size(); ++i) {
      const Vec<3> f = lane_of(force[i], 0), x = F * start[i];
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) sum(a, b) += f[a] * x[b];
    }
    stress = (1 / (volume * determinant(F))) * sum;
  }
  double stored() const { return elastic_energy(grains, grains.batches[0])[0] / volume; }
};

}  // namespace

TEST_CASE("a ball that follows the element test bears what `softgrain law` says, stores and loses the same") {
  const MaterialParameters metal{.young_modulus = 1e7,
                                 .poisson_ratio = 0.3,
                                 .yield_stress = 1e5,
                                 .hardening_modulus = 3e5,
                                 .viscosity = 1e3};
  const MaterialParameters gel{.young_modulus = 1e6,
                               .poisson_ratio = 0.45,
                               .relaxation_share_1 = 0.5,
                               .relaxation_share_2 = 0.3,
                               .relaxation_time_1 = 0.05,
                               .relaxation_time_2 = 1};
  const MaterialParameters creeping{
      .young_modulus = 1e7, .poisson_ratio = 0.3, .creep_rate = 1, .creep_stress = 1e5, .creep_exponent = 4};
  const std::pair<MaterialLaw, MaterialParameters> laws[] = {
      {MaterialLaw::von_mises, metal}, {MaterialLaw::prony, gel}, {MaterialLaw::norton, creeping}};
  for (const auto& [name, parameters] : laws)
    for (const ElementPath path : {ElementPath::shear, ElementPath::cycle}) {
      CAPTURE(law_choice(name).name);
      const AnyLaw law = make_law(name, parameters);
      const ElementTest test{.path = path, .strain = 0.15, .rate = 1, .steps = 12};
      FollowingBall ball(law);
      ElementRow before;
      for (const ElementRow& row : drive_point(law, test)) {
        if (row.time == 0) continue;
        const Mat<3> F = path == ElementPath::shear
                             ? Mat<3>{{1, row.strain, 0, 0, 1, 0, 0, 0, 1}}
                             : Mat<3>::diagonal({std::exp(row.strain), row.stretch, 1});
        ball.go_to(F, row.time - before.time);
        const double unit = 1e-9 * parameters.young_modulus;
        CHECK(std::abs(ball.stress(0, 0) - row.stress_xx) < unit);
        CHECK(std::abs(ball.stress(1, 1) - row.stress_yy) < unit);
        CHECK(std::abs(ball.stress(2, 2) - row.stress_zz) < unit);
        CHECK(std::abs(ball.stress(0, 1) - row.stress_xy) < unit);
        CHECK(std::abs(ball.stored() - row.stored) < unit);
        CHECK(std::abs(ball.dissipated - row.dissipated) < unit);
        CHECK(plastic_strain(ball.grains).mean == doctest::Approx(row.plastic_strain).epsilon(1e-9));
        before = row;
      }
      CHECK(ball.dissipated > 0);
    }
}

TEST_CASE("before anything flows a ball of metal answers as Hencky's law, wherever its yield surface is") {
  const MaterialParameters parameters{.young_modulus = 1, .poisson_ratio = 0.3, .yield_stress = 0.01};
  FollowingBall metal(make_law(MaterialLaw::von_mises, parameters)),
      elastic(make_law(MaterialLaw::hencky, parameters));
  const Mat<3> F{{1.1, 0.1, 0, 0, 0.95, 0.05, 0, 0, 1}};
  metal.go_to(identity<3>(), 0), elastic.go_to(F, 0);
  metal.grains.batches[0].position = elastic.grains.batches[0].position;
  WidePlaces<3> of_metal, of_elastic;
  internal_force(metal.grains, metal.grains.batches[0], of_metal);
  internal_force(elastic.grains, elastic.grains.batches[0], of_elastic);
  for (std::size_t i = 0; i < of_metal.size(); ++i)
    CHECK(norm(lane_of(of_metal[i], 0) - lane_of(of_elastic[i], 0)) < 1e-13);
  CHECK(plastic_strain(metal.grains).largest == 0);
}

TEST_CASE("a sphere of metal between walls stays flat, and its work is stored, lost by flow, or in motion") {
  Case c = test::case_in_space(LoadingPath::diametral);
  c.mpm.cells = 4;
  c.mpm.law = MaterialLaw::von_mises;
  c.mpm.material = {
      .young_modulus = 1e7, .poisson_ratio = 0.3, .yield_stress = 1e5, .hardening_modulus = 1e5};
  c.grain.radius = 1e-3;
  c.loading.max_strain = 0.15;
  c.loading.unload_at = {0.14};
  c.loading.unload_by = 0.03;
  SimulationOf<3> simulation = test::solid_simulation_of(c);
  double largest_force = 0, least_force = 1e9;
  int turns = 0;
  while (!simulation.finished() && turns < 2) {
    simulation.step();
    const double force = simulation.box().outward_impulse(1) / simulation.time_step();
    largest_force = std::max(largest_force, force);
    if (turns == 1) least_force = std::min(least_force, force);
    turns += simulation.at_turning_point() ? 1 : 0;
  }
  const Observation end = simulation.observe();
  const double work = end.energies.wall_work, flow = *end.number("dissipation_plastic");
  CHECK(*end.number("plastic_strain") > 0.03);
  // Jackson and Green (2005): F = 2.84 (1 - exp(-0.82 (a/R)^-0.7)) sigma_y pi a^2, a^2 = 2 R d, when all is
  // plastic
  const double d = 1 - std::exp(-0.14), a = std::sqrt(2 * d);
  const double plastic =
      2.84 * (1 - std::exp(-0.82 * std::pow(a, -0.7))) * 1e5 * 1e-6 * std::numbers::pi * a * a;
  CHECK(largest_force == doctest::Approx(plastic).epsilon(0.2));
  CHECK(least_force == 0);  // the walls leave it long before they are back
  CHECK(flow > 0.5 * work);
  CHECK(std::abs(end.energies.error) < 1e-10 * work);
  // work of the internal forces = stored + flow, but for what damps the mesh's own vibrations
  CHECK(std::abs(*end.number("dissipation_integration")) < 0.05 * work);
  CHECK(end.energies.stored + end.energies.kinetic < 0.4 * work);
}
