#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

Case packing(GrainModel model) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = model};
  c.grain.density = 990;
  c.bpm.primaries = 20;
  c.mpm.cells = 3;
  c.contact.friction = 0.3;
  c.sample.grains = 6;
  c.sample.packing_fraction = 0.5;
  c.loading = {.wall_velocity = 5, .max_strain = 0.5, .unload_at = {}};
  return c;
}

void advance(Simulation& simulation, double strain) {
  while (simulation.strain() < strain) simulation.step();
}

/// W as rows of a full matrix.
std::vector<std::vector<double>> full(const ContactProblem& problem) {
  std::vector<std::vector<double>> W(problem.q.size(), std::vector<double>(problem.q.size()));
  for (const MatrixEntry& entry : problem.W) W[entry.row][entry.column] = entry.value;
  return W;
}

/// u = W p + q, from the entries.
std::vector<double> velocities(const SolvedContactProblem& solved) {
  std::vector<double> u = solved.problem.q;
  for (const MatrixEntry& entry : solved.problem.W)
    u[entry.row] += entry.value * solved.impulse[entry.column];
  return u;
}

int pushing(const SolvedContactProblem& solved) {
  int count = 0;
  for (std::size_t k = 0; k < solved.impulse.size(); k += 2) count += solved.impulse[k] > 0;
  return count;
}

}  // namespace

TEST_CASE("W p + q of a step of bonded grains is the velocity at which their surfaces part after it") {
  const Case c = packing(GrainModel::bpm);
  const auto simulation = create_simulation(c);
  advance(*simulation, 0.4);
  const SolvedContactProblem solved = simulation->step_and_catch_problem();
  const auto& dynamics = test::bonded(*simulation);
  const auto& particles = dynamics.particles;
  const auto& contacts = dynamics.contacts;
  REQUIRE(solved.problem.contacts() == contacts.size());
  CHECK(pushing(solved) > 20);
  const std::vector<double> u = velocities(solved);
  const auto W = full(solved.problem);
  for (int k = 0; k < contacts.size(); ++k) {
    const int a = contacts.body_a[k], b = contacts.body_b[k];
    const Vec<2>& n = contacts.normal[k];
    const Vec<2> t{-n[1], n[0]};
    const Vec<2> apart = particles.velocity[b] - particles.velocity[a];
    const double spin = particles.spin[a][0] + particles.spin[b][0];
    const double offset =
        contacts.gap[k] * (contacts.gap[k] > 0 ? 1 : c.contact.push_out) / bonded_time_step(c);
    CHECK(u[2 * k] == doctest::Approx(dot(n, apart) + offset).epsilon(1e-9));
    CHECK(std::abs(u[2 * k + 1] - (dot(t, apart) - spin)) < 1e-8);
    const double W_nn = 1 / particles.mass[a] + (b < particles.size() ? 1 / particles.mass[b] : 0);
    CHECK(W[2 * k][2 * k] == doctest::Approx(W_nn).epsilon(1e-12));
    CHECK(W[2 * k + 1][2 * k + 1] == doctest::Approx(3 * W_nn).epsilon(1e-12));
  }
  CHECK(2 * solved.problem.W.size() < u.size() * u.size());  // sparse
}

TEST_CASE(
    "the problem of an implicit step of elastic grains is symmetric and solved by the step's impulses") {
  const auto simulation = create_simulation(packing(GrainModel::mpm));
  advance(*simulation, 0.4);
  const SolvedContactProblem solved = simulation->step_and_catch_problem();
  CHECK(pushing(solved) > 5);
  const auto W = full(solved.problem);
  for (std::size_t i = 0; i < W.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      CHECK(std::abs(W[i][j] - W[j][i]) < 1e-7 * std::sqrt(W[i][i] * W[j][j]));  // single precision
  const ContactSolution own = assess_impulses(in_natural_units(solved), 0);
  const ContactSolution exact = solve_contact_problem(in_natural_units(solved).problem, {.tolerance = 1e-10});
  CHECK(own.residual < 1e-3);
  CHECK(exact.converged);
  CHECK(own.energy == doctest::Approx(exact.energy).epsilon(1e-3));
}

TEST_CASE("catching the problem of a step changes nothing of the step") {
  for (const GrainModel model : {GrainModel::bpm, GrainModel::mpm}) {
    CAPTURE(model);
    const auto plain = create_simulation(packing(model)), watched = create_simulation(packing(model));
    for (int k = 0; k < 30; ++k) {
      plain->step();
      watched->step_and_catch_problem();
    }
    CHECK(std::get<0>(plain->checkpoint().arrays.at("position").values) ==
          std::get<0>(watched->checkpoint().arrays.at("position").values));
  }
}

TEST_CASE("explicit integration has no contact problem to show") {
  Case c = packing(GrainModel::mpm);
  c.mpm.integrator = Integrator::symplectic_euler;
  CHECK_THROWS_AS(create_simulation(c)->step_and_catch_problem(), UsageError);
}
