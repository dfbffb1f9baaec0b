#include "softgrain/soft/history.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/elastic_grains.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/point_states.hpp"
#include "softgrain/state/archive.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double E = 1e7, yield = 1e5;

AnyLaw metal(double viscosity = 0, double saturation = 0) {
  return make_law(MaterialLaw::von_mises, {.young_modulus = E,
                                           .poisson_ratio = 0.3,
                                           .yield_stress = yield,
                                           .hardening_modulus = yield,
                                           .saturation_stress = saturation,
                                           .saturation_rate = saturation > 0 ? 10.0 : 0.0,
                                           .viscosity = viscosity});
}

AnyLaw pulled_back() {
  return make_law(
      MaterialLaw::von_mises,
      {.young_modulus = E, .poisson_ratio = 0.3, .yield_stress = yield, .kinematic_modulus = yield});
}
AnyLaw wax() {
  return make_law(MaterialLaw::norton, {.young_modulus = E,
                                        .poisson_ratio = 0.3,
                                        .creep_rate = 10,
                                        .creep_stress = yield,
                                        .creep_exponent = 4});
}
/// Times of relaxation above and below that of a pressing.
AnyLaw gel() {
  return make_law(MaterialLaw::prony, {.young_modulus = E,
                                       .poisson_ratio = 0.3,
                                       .relaxation_share_1 = 0.4,
                                       .relaxation_share_2 = 0.3,
                                       .relaxation_time_1 = 1e-4,
                                       .relaxation_time_2 = 1e-2});
}

/// Ten grains of different radii and angles that were pressed once, and are pressed otherwise now.
SoftGrains flowed_grains(const AnyLaw& law, double dt) {
  const auto shape = test::disk(2);
  std::vector<GrainPlacement> placed;
  for (int g = 0; g < 10; ++g) placed.push_back(test::placed(shape, 1 + 0.1 * g, {3.0 * g, 1}, {}, 0.4 * g));
  SoftGrains grains(std::move(placed), law, 1);
  test::move_nodes(grains, [](int, const Vec<2>& x) { return Vec<2>{1.1 * x[0] + 0.1 * x[1], 0.9 * x[1]}; });
  for (GrainBatch& batch : grains.batches) advance_history(grains, batch, dt);
  test::shake(grains, 0.05);
  return grains;
}

std::vector<Wide> histories(const SoftGrains& grains) {
  std::vector<Wide> all;
  for (const GrainBatch& batch : grains.batches)
    all.insert(all.end(), batch.history.begin(), batch.history.end());
  return all;
}

bool same_bits(const std::vector<Wide>& a, const std::vector<Wide>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const Wide& x, const Wide& y) {
           return all((x <= y) & (y <= x));
         });
}

/// A disk between a floor and a wall that comes down.
template <class Dynamics, class Options>
Dynamics pressed_disk(int cells, double speed, const Options& options, const AnyLaw& law = metal()) {
  const double R = 1e-3;
  const auto shape = test::disk(cells);
  double reach = 0;
  for (const Vec<2>& X : shape->grid.outline()) reach = std::max(reach, X[1] * R);
  return {{{test::placed(shape, R, {0, 0})}, law, 990},
          {test::floor_at(-reach), {.point = {0, reach}, .normal = {0, -1}, .velocity = {0, -speed}}},
          options};
}

template <class Dynamics>
double unexplained(const Dynamics& d) {
  const WorkBudget& w = d.work;
  return w.walls - d.grains.kinetic_energy() - w.internal - w.contacts - w.inertia;
}

}  // namespace

// K_ab of a cell by differences of the force, as in the test of elastic laws.
TEST_CASE("the stiffness of grains that flow, creep or relax is the derivative of their force") {
  for (const AnyLaw& law : {metal(), metal(0, yield), metal(1e3, yield), pulled_back(), wax(), gel()}) {
    constexpr double dt = 0.01, shift = 2 * E;
    SoftGrains grains = flowed_grains(law, dt);
    GrainBatch& batch = grains.batches[0];
    const double flowing = [&] {
      SoftGrains copy = grains;
      std::vector<FlowOfStep> steps;
      for (GrainBatch& of_copy : copy.batches) steps.push_back(advance_history(copy, of_copy, dt));
      return sum_of(copy, steps).share;
    }();
    CHECK((flowing > 0.3 || std::holds_alternative<Prony>(law)));  // much of it flows here
    BatchedCholesky matrix(batch.topology->pattern);
    matrix.clear();
    add_stiffness(grains, batch, matrix, dt);
    const int nodes = batch.topology->grid.nodes();
    for (int i = 0; i < nodes; ++i) matrix.add(i, i, {shift, 0.0, 0.0, shift});
    REQUIRE(matrix.factor() == 0);
    test::RandomNumbers random(8);
    std::vector<Wide> b(2 * nodes);
    for (Wide& entry : b)
      for (int lane = 0; lane < Wide::size; ++lane) entry.set(lane, E * random.uniform(-1, 1));
    std::vector<Wide> x = b;
    matrix.solve(x);
    constexpr double step = 1e-7;
    const WideVectors start = batch.position;
    const auto force_at = [&](double s) {
      for (int i = 0; i < nodes; ++i)
        for (int d = 0; d < 2; ++d) batch.position[i][d] = start[i][d] + Wide(s) * x[2 * i + d];
      WideVectors force;
      internal_force(grains, batch, force, dt);
      return force;
    };
    const WideVectors above = force_at(step), below = force_at(-step);
    double worst = 0;
    for (int i = 0; i < nodes; ++i)
      for (int d = 0; d < 2; ++d)
        for (int lane = 0; lane < Wide::size; ++lane) {
          const double Kx = (above[i][d] - below[i][d])[lane] / (2 * step);
          worst = std::max(worst, std::abs(shift * x[2 * i + d][lane] + Kx - b[2 * i + d][lane]) / E);
        }
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("a grain that is turned flows alike, wherever it was placed") {
  const auto shape = test::disk(2);
  const SoftGrains grains({test::placed(shape, 1, {0, 0}), test::placed(shape, 1, {3, 0}, {}, 0.9)}, metal(),
                          1);
  SoftGrains turned = grains;
  const auto stretch = [](const Vec<2>& x) { return Vec<2>{1.2 * x[0], x[1] / 1.15}; };
  const double c = std::cos(0.9), s = std::sin(0.9);
  test::move_nodes(turned, [&](int lane, const Vec<2>& x) {
    if (lane == 0) return stretch(x);
    const Vec<2> X{x[0] - 3, x[1]}, own{c * X[0] + s * X[1], c * X[1] - s * X[0]}, y = stretch(own);
    return Vec<2>{c * y[0] - s * y[1] + 3, s * y[0] + c * y[1]};
  });
  GrainBatch& batch = turned.batches[0];
  advance_history(turned, batch, 0);
  for (const Wide& number : batch.history) CHECK(number[0] == doctest::Approx(number[1]).epsilon(1e-12));
  CHECK(plastic_strain(turned).largest > 0.1);
  const PointState a = point_states(turned, 0)[0], b = point_states(turned, 1)[0];
  CHECK(a.von_mises == doctest::Approx(b.von_mises).epsilon(1e-10));
  CHECK(a.pressure == doctest::Approx(b.pressure).epsilon(1e-8));
  CHECK(trace(a.stress) == doctest::Approx(trace(b.stress)).epsilon(1e-8));
}

TEST_CASE(
    "a point that flows has the yield stress as its von Mises stress, with the stress across the plane") {
  SoftGrains grains({test::placed(test::square(2), 1, {0, 0})}, metal(), 1);
  test::move_nodes(grains, [](int, const Vec<2>& x) { return Vec<2>{1.1 * x[0], 0.95 * x[1]}; });
  advance_history(grains, grains.batches[0], 0);
  for (const PointState& point : point_states(grains, 0)) {
    const double J = determinant(point.F);
    CHECK(J * point.von_mises == doctest::Approx(yield * (1 + point.plastic_strain)).epsilon(1e-10));
    CHECK(J * point.pressure == doctest::Approx(-E / (3 * 0.4) * std::log(J)).epsilon(1e-10));
  }
}

TEST_CASE(
    "what a metal grain does not give back it has dissipated: the energies close, in both integrators") {
  const auto check = [](auto dynamics, double dt) {
    const double R = dynamics.grains.radius(0), speed = -dynamics.box.walls[1].velocity[1];
    for (double travel = 0; travel < 0.3 * R; travel += speed * dt) dynamics.step(dt);
    const double stored = stored_energy(dynamics.grains), walls = dynamics.work.walls;
    CHECK(plastic_strain(dynamics.grains).largest > 0.1);
    CHECK(dynamics.work.flow > 0.85 * walls);
    CHECK(dynamics.work.flow < walls);
    CHECK(std::abs(unexplained(dynamics)) < 1e-3 * walls);
    // what is left is the integrator's
    CHECK(std::abs(dynamics.work.internal - stored - dynamics.work.flow) < 0.02 * walls);
    CHECK(dynamics.last_flow.share > 0.1);
    CHECK(dynamics.last_flow.share < 1);
  };
  check(pressed_disk<ImplicitDynamics>(4, 0.2, ImplicitOptions{}), 1e-5);
  auto quick = pressed_disk<ExplicitDynamics>(4, 0.5, ExplicitOptions{.damping_share = 0.5});
  const double dt = stable_time_step(quick.grains);
  check(std::move(quick), dt);
}

TEST_CASE(
    "a grain that relaxes is softer under a slow wall, and what it does not give back it has dissipated") {
  double force[2];
  for (const int slow : {0, 1}) {
    const double speed = slow ? 0.2 : 5, dt = slow ? 1e-5 : 4e-7, R = 1e-3;
    ImplicitDynamics dynamics = pressed_disk<ImplicitDynamics>(4, speed, ImplicitOptions{}, gel());
    for (double travel = 0; travel < 0.2 * R; travel += speed * dt) dynamics.step(dt);
    const double stored = stored_energy(dynamics.grains), walls = dynamics.work.walls;
    force[slow] = -dynamics.wall_impulse(0)[1] / dt;
    CHECK(dynamics.work.flow > 0.02 * walls);
    CHECK(std::abs(unexplained(dynamics)) < 1e-3 * walls);
    CHECK(std::abs(dynamics.work.internal - stored - dynamics.work.flow) < 0.02 * walls);
    CHECK(plastic_strain(dynamics.grains).largest == 0);
  }
  CHECK(force[1] > 0.3 * force[0]);
  CHECK(force[1] < 0.8 * force[0]);
}

TEST_CASE("a step that is taken back leaves the history as it was, and the next one goes on from there") {
  ImplicitDynamics dynamics = pressed_disk<ImplicitDynamics>(3, 0.2, ImplicitOptions{});
  for (int k = 0; k < 20; ++k) dynamics.step(1e-5);
  ImplicitDynamics again = dynamics;
  const std::vector<Wide> before = histories(dynamics.grains);
  CHECK(plastic_strain(dynamics.grains).largest > 0);
  dynamics.options.tolerance = 1e-30;  // which no step reaches
  CHECK_THROWS_AS(dynamics.step(1e-5), NumericalError);
  CHECK(same_bits(histories(dynamics.grains), before));
  CHECK(dynamics.work.flow == again.work.flow);
  dynamics.options = again.options;
  dynamics.sub_step = again.sub_step;
  dynamics.step(1e-5);
  again.step(1e-5);
  CHECK(same_bits(histories(dynamics.grains), histories(again.grains)));
  CHECK_FALSE(same_bits(histories(dynamics.grains), before));
}

TEST_CASE("grains that flow go on from a checkpoint with the same bits, on one thread or two") {
  const auto check = [](auto dynamics, double dt) {
    using Dynamics = decltype(dynamics);
    ElasticGrains<Dynamics> whole(dynamics), resumed(dynamics);
    Box<2> box(dynamics.box.walls), other = box;
    for (int k = 0; k < 30; ++k) whole.step(box, dt);
    StateWriter writer;
    whole.visit(writer);
    CHECK(writer.arrays.contains("history"));
    StateReader reader(writer.arrays);
    resumed.visit(reader);
    other.walls = box.walls;
    set_threads(2);
    for (int k = 0; k < 10; ++k) whole.step(box, dt);
    set_threads(1);
    for (int k = 0; k < 10; ++k) resumed.step(other, dt);
    StateWriter a, b;
    whole.visit(a);
    resumed.visit(b);
    for (const auto& [name, array] : a.arrays) {
      CAPTURE(name);
      CHECK((array.values == b.arrays.at(name).values));
    }
    CHECK(whole.dynamics().work.flow > 0);
  };
  for (const AnyLaw& law : {metal(), pulled_back(), wax(), gel()}) {
    check(pressed_disk<ImplicitDynamics>(3, 0.2, ImplicitOptions{}, law), 1e-5);
    auto quick = pressed_disk<ExplicitDynamics>(3, 1, ExplicitOptions{.damping_share = 0.5}, law);
    const double dt = stable_time_step(quick.grains);
    check(std::move(quick), dt);
  }
}

TEST_CASE("force and history in one pass have the bits of force, then history") {
  for (const AnyLaw& law : {metal(), metal(1e3, yield), pulled_back(), wax(), gel()}) {
    constexpr double dt = 0.01;
    SoftGrains apart = flowed_grains(law, dt), together = apart;
    for (std::size_t b = 0; b < apart.batches.size(); ++b) {
      WideVectors force, same;
      FlowOfStep flow;
      CHECK(internal_force(apart, apart.batches[b], force, dt) == 0);
      const FlowOfStep expected = advance_history(apart, apart.batches[b], dt);
      CHECK(internal_force_and_history(together, together.batches[b], same, dt, flow) == 0);
      for (std::size_t i = 0; i < force.size(); ++i)
        for (int d = 0; d < 2; ++d) CHECK(all((force[i][d] <= same[i][d]) & (force[i][d] >= same[i][d])));
      CHECK(all((flow.dissipated <= expected.dissipated) & (flow.dissipated >= expected.dissipated)));
    }
    CHECK(same_bits(histories(apart), histories(together)));
  }
}
