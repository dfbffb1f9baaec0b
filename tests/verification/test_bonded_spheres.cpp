#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/observe/columns.hpp"
#include "support/gravity.hpp"
#include "support/solid_simulations.hpp"

using namespace softgrain;

namespace {

constexpr double R = 5e-3;

std::map<std::string, double> row_of(SimulationOf<3>& simulation) {
  std::map<std::string, double> row;
  for (const Quantity& quantity : softgrain::row_of(simulation.observe()))
    row[quantity.name] = quantity.value;
  simulation.begin_row();
  return row;
}

/// A grain with R between walls that come together.
Case between_walls(int primaries) {
  Case c;
  c.experiment = {.loading = LoadingPath::diametral, .model = GrainModel::bpm, .dimension = 3};
  c.grain.radius = R;
  c.bpm.primaries = primaries;
  c.bpm.force = 0.5;
  c.loading = {.wall_velocity = 0.3, .max_strain = 0.1, .unload_at = {}};
  return c;
}

/// Spheres of radius 1 and mass 1 at these places, in pairs that belong to one grain.
RigidParticles<3> spheres_at(const std::vector<Vec<3>>& position) {
  const std::vector<double> ones(position.size(), 1);
  return rigid_particles<3>(position, ones, ones, {});
}

/// Momentum, and angular momentum about the origin with that of the spins.
std::pair<Vec<3>, Vec<3>> momenta(const RigidParticles<3>& p) {
  Vec<3> linear, angular;
  for (int i = 0; i < p.size(); ++i) {
    linear += p.mass[i] * p.velocity[i];
    angular += p.mass[i] * cross(p.position[i], p.velocity[i]);
    angular += (p.mass[i] * p.radius[i] / p.inertia_ratio) * p.spin[i];  // I omega = m R s/kappa
  }
  return {linear, angular};
}

}  // namespace

TEST_CASE("two spheres part head on with e times their speed, and an oblique impact keeps both momenta") {
  for (const Precision precision : {Precision::full, Precision::single}) {
    for (const double e : {0.0, 0.5}) {
      RigidDynamics<3> dynamics(
          spheres_at({{0, 0, 0}, {1.2, 1.2, 1.2}}), test::friction(0),
          {.solver = {.min_sweeps = 40, .max_sweeps = 40, .tolerance = 1e-9},
           .law = {.restitution = e, .push_out = 0, .activation = Activation::closed_at_mid_step},
           .precision = precision},
          0.5);
      dynamics.particles.velocity[0] = {1, 1, 1};
      for (int step = 0; step < 100; ++step) dynamics.step(test::no_force<3>(), 1e-3);
      const Vec<3> u = dynamics.particles.velocity[1] - dynamics.particles.velocity[0];
      for (int k = 0; k < 3; ++k) CHECK(std::abs(u[k] - e) < 1e-6);
      CHECK(norm(momenta(dynamics.particles).first - Vec<3>{1, 1, 1}) < 1e-12);
    }
    RigidDynamics<3> oblique(spheres_at({{0, 0, 0}, {1.5, 1, 0.9}}), test::friction(0.3),
                             {.solver = {.min_sweeps = 60, .max_sweeps = 60, .tolerance = 1e-9},
                              .law = {},
                              .precision = precision},
                             0.5);
    oblique.particles.velocity[0] = {2, -1, 0.5};
    oblique.particles.spin[1] = {0.3, 1, -0.4};
    const auto [linear, angular] = momenta(oblique.particles);
    const double before = kinetic_energy(oblique.particles);
    for (int step = 0; step < 300; ++step) oblique.step(test::no_force<3>(), 1e-3);
    CHECK(norm(momenta(oblique.particles).first - linear) < 1e-12);
    CHECK(norm(momenta(oblique.particles).second - angular) < 2e-3);  // of the order of the step
    CHECK(kinetic_energy(oblique.particles) < before);
    CHECK(norm(oblique.particles.spin[0]) > 0.01);
  }
}

TEST_CASE(
    "to part two spheres takes the work of the attraction's closed form, and beyond its reach nothing") {
  constexpr double F0 = 3, gamma = 7, a0 = 2, out = 1.9 * a0;
  const double closed = F0 * a0 / (gamma - 1) * (1 - std::pow(a0 / out, gamma - 1));
  auto particles = spheres_at({{0, 0, 0}, {a0, 0, 0}});
  NeighbourReference<3> reference{.skin = 0.1, .position = {}, .wall_point = {}};
  AttractionForcesOf<3> attraction({.F0 = F0, .gamma = gamma});
  const Vec<3> along{2.0 / 3, -1.0 / 3, 2.0 / 3};
  double work = 0;
  constexpr int steps = 4000;
  for (int k = 0; k < steps; ++k) {
    particles.position[1] = (a0 + (out - a0) * (k + 0.5) / steps) * along;
    set_reference(reference, particles);
    attraction.update(particles, reference);
    std::vector<Vec<3>> force(2);
    attraction.add_forces(particles, force);
    work -= dot(force[1], along) * (out - a0) / steps;
  }
  CHECK(std::abs(work / closed - 1) < 1e-6);
  particles.position[1] = 2.001 * a0 * along;
  std::vector<Vec<3>> force(2);
  attraction.add_forces(particles, force);
  CHECK(norm(force[0]) == 0);
}

TEST_CASE("a ball of 300 primaries is isostatic, dense and round") {
  const auto grain = prepare_aggregate<3>({.primaries = 300});
  CHECK(grain.coordination > 5.5);  // primaries of the surface have fewer; 5.92 of 500, 5.97 of 2000
  CHECK(grain.coordination < 6.0);
  CHECK(grain.roundness < 0.2);
  double inside = 0;  // volume of the primaries whose centres lie in the inner ball, over that of the ball
  for (std::size_t i = 0; i < grain.radius.size(); ++i)
    if (norm(grain.position[i]) < 0.7) inside += std::pow(grain.radius[i] / 0.7, 3);
  CHECK(inside > 0.6);
  CHECK(inside < 0.7);
}

TEST_CASE("a free ball that turns keeps its momenta, its energy and its shape") {
  const auto grain = prepare_aggregate<3>({.primaries = 40});
  std::vector<double> mass;
  for (const double r : grain.radius) mass.push_back(r * r * r);
  RigidDynamics<3> dynamics(rigid_particles<3>(grain.position, grain.radius, mass, {}), test::friction(0),
                            {.solver = {.min_sweeps = 30, .max_sweeps = 30, .relaxation = 1.2}, .law = {}},
                            0.15 * grain.mean_distance);
  const double F0 = grain.mean_distance * grain.mean_distance;  // sigma_I = 1
  AttractionForcesOf<3> attraction({.F0 = F0, .gamma = 7});
  const Vec<3> omega{0.02, -0.03, 0.05}, drift{0.01, 0.02, 0};
  for (int i = 0; i < dynamics.particles.size(); ++i)
    dynamics.particles.velocity[i] = drift + cross(omega, dynamics.particles.position[i]);
  const auto [linear, angular] = momenta(dynamics.particles);
  const double kinetic = kinetic_energy(dynamics.particles);
  const double dt = 0.02 * std::sqrt(mass.front() * grain.mean_distance / F0);
  for (int step = 0; step < 800; ++step)
    dynamics.step(
        [&](const RigidParticles<3>& particles, std::span<Vec<3>> force) {
          attraction.update(particles, dynamics.reference);
          attraction.add_forces(particles, force);
        },
        dt);
  const auto [linear_then, angular_then] = momenta(dynamics.particles);
  CHECK(norm(linear_then - linear) < 1e-12 * norm(linear) + 1e-13);
  CHECK(norm(angular_then - angular) < 1e-3 * norm(angular));
  CHECK(std::abs(kinetic_energy(dynamics.particles) / kinetic - 1) < 0.02);
}

TEST_CASE("a ball between walls stays whole, its energy is accounted for, and both walls bear the same") {
  Case c = between_walls(80);
  SimulationOf<3> simulation = test::solid_simulation_of(c);
  double top = 0, bottom = 0;
  std::map<std::string, double> row;
  while (!simulation.finished()) {
    for (int step = 0; step < 100 && !simulation.finished(); ++step)
      REQUIRE(simulation.step().overlap_max < 2e-3);
    row = row_of(simulation);
    CHECK(row["clusters"] == 1);
    CHECK(std::abs(row["energy_error"]) < 1e-6 * -row["attraction_energy"]);
    top += row["force_top"];
    bottom += row["force_bottom"];
  }
  CHECK(std::abs(row["energy_error"]) < 1e-4 * row["wall_work"]);
  CHECK(std::abs(top - bottom) < 0.05 * top);
  const double sigma = row["stress_top"] / row["sigma_I"];
  CHECK(sigma > 0.05);
  CHECK(sigma < 1);
}

TEST_CASE("balls that have settled in a box press its bottom with their weight") {
  constexpr double gravity = 1000;
  Case c;
  c.experiment = {.loading = LoadingPath::stages, .model = GrainModel::bpm, .dimension = 3};
  c.box.gravity_z = -gravity;
  c.bpm.primaries = 20;
  c.bpm.library = 1;
  c.bpm.cohesive_pressure = 1e5;
  c.sample.grains = 5;
  c.sample.packing_fraction = 0.35;
  c.contact.friction = c.contact.wall_friction = 0.3;
  c.loading.wall_velocity = 0.5;
  c.stages = {{.name = "rest", .until = {.time = 8e-3}}};
  SimulationOf<3> simulation = test::solid_simulation_of(c);
  double weight = 0;
  for (const double m : simulation.model().bodies().mass) weight += gravity * m;
  while (simulation.progress() < 0.8) simulation.step();
  simulation.begin_row();
  while (!simulation.finished()) simulation.step();
  auto row = row_of(simulation);
  CHECK(std::abs(row["force_bottom"] / weight - 1) < 0.02);
  CHECK(row["force_top"] == 0);
  CHECK(row["clusters"] == 5);
  CHECK(std::abs(row["energy_error"]) < 1e-3 * row["gravity_work"]);
}

namespace {

/// How the units scale between two similar experiments.
struct Similarity {
  double time, length, force;

  double factor(const std::string& unit) const {
    const std::map<std::string, double> factors{{"", 1},       {"s", time},
                                                {"m", length}, {"Pa", force / (length * length)},
                                                {"N", force},  {"J", force * length}};
    return factors.at(unit);
  }
};

/// Powers of two change no mantissa, so that similar experiments agree to the last bit.
void check_similar(const Case& original_case, const Case& scaled_case, const Similarity& similarity) {
  SimulationOf<3> original = test::solid_simulation_of(original_case),
                  scaled = test::solid_simulation_of(scaled_case);
  REQUIRE(original.steps_planned() == scaled.steps_planned());
  int rows = 0;
  while (!original.finished()) {
    original.step();
    scaled.step();
    if (original.steps_done() % 50 != 0) continue;
    const auto row = softgrain::row_of(original.observe()), scaled_row = softgrain::row_of(scaled.observe());
    for (std::size_t k = 0; k < row.size(); ++k) {
      CAPTURE(row[k].name);
      REQUIRE(scaled_row[k].value == similarity.factor(row[k].unit) * row[k].value);
    }
    ++rows;
  }
  CHECK(rows > 3);
}

}  // namespace

TEST_CASE("curves of balls collapse over F0/<a0>^2: another F0, or another size, to the last bit") {
  Case c = between_walls(30);
  c.loading = {.wall_velocity = 1, .max_strain = 0.04, .unload_at = {}};
  c.time.step = 1e-6;
  Case strong = c;  // accelerations are four times as large: half the time
  strong.bpm.force *= 4;
  strong.loading.wall_velocity *= 2;
  strong.time.step /= 2;
  check_similar(c, strong, {.time = 0.5, .length = 1, .force = 4});
  Case large = c;  // of the same sigma_I: masses grow eightfold, forces fourfold, twice the time at one speed
  large.grain.radius *= 2;
  large.bpm.force *= 4;
  large.time.step *= 2;
  check_similar(c, large, {.time = 2, .length = 2, .force = 4});
}
