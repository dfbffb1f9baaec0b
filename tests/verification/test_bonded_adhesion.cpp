#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/geometry/ball.hpp"
#include "support/simulations.hpp"
#include "support/solid_simulations.hpp"

using namespace softgrain;

namespace {

constexpr double gravity = 10;
constexpr Adhesion glue{.surface_energy = 0.05, .range = 20e-6};

/// Grains of one primary each, side by side along the last axis and in touch.
template <int Dim>
BondedGrainsSetupOf<Dim> single_primaries(const std::vector<double>& radius, double density,
                                          std::vector<PairAdhesion> adhesion,
                                          std::vector<Wall<Dim>> walls = {}) {
  std::vector<Vec<Dim>> position;
  std::vector<double> mass;
  double at = 0;  // downwards
  for (const double r : radius) {
    Vec<Dim> x;
    x[Dim - 1] = at - r;
    position.push_back(x);
    mass.push_back(times_power<Dim>(density * unit_ball<Dim>, r));
    at -= 2 * r;
  }
  const int n = static_cast<int>(radius.size());
  BondedGrainsSetupOf<Dim> setup{
      .particles = rigid_particles<Dim>(std::move(position), radius, std::move(mass), std::move(walls)),
      .grain_radius = radius,
      .laws = std::vector<Attraction>(radius.size()),
      .kind = std::vector<int>(radius.size(), 0),
      .friction = {},
      .adhesion = std::move(adhesion),
      .options = {.solver = {.min_sweeps = 20, .max_sweeps = 400, .tolerance = 1e-12}, .law = {}},
      .skin = 50e-6,
      .density = density,
      .sigma_I = 1};
  for (int i = 0; i < n; ++i) setup.particles.grain[i] = i;
  return setup;
}

/// l of (theory (84)).
template <int Dim>
double face(double a, double b) {
  return times_power<Dim - 1>(1, a + b);
}

template <int Dim>
Wall<Dim> ceiling() {
  Wall<Dim> wall{};
  wall.normal[Dim - 1] = -1;
  return wall;
}

template <int Dim>
double energy(const BondedGrainsOf<Dim>& grains) {
  const Energies energies = grains.energies();
  return energies.kinetic + energies.stored;
}

/// Does a chain of primaries still hang after 25 ms from a ceiling that holds it by `of_wall` of what the
/// second is held by at the first?
template <int Dim>
bool hangs(double load, double of_wall) {
  const std::vector<double> radius{0.3e-3, 0.2e-3};
  const double F0 =
      2 * glue.surface_energy / glue.range *
      (of_wall > 1 ? face<Dim>(radius[0], radius[1]) : of_wall * face<Dim>(radius[0], radius[0]));
  const double hanging =
      of_wall > 1 ? times_power<Dim>(unit_ball<Dim>, radius[1])
                  : times_power<Dim>(unit_ball<Dim>, radius[0]) + times_power<Dim>(unit_ball<Dim>, radius[1]);
  const Adhesion wall{of_wall * glue.surface_energy, glue.range};
  auto setup = single_primaries<Dim>(radius, load * F0 / (gravity * hanging),
                                     {{.kind = 0, .other = 0, .law = glue}, {.kind = 0, .law = wall}},
                                     {ceiling<Dim>()});
  setup.gravity[Dim - 1] = -gravity;
  BondedGrainsOf<Dim> grains(std::move(setup));
  Box<Dim> box({ceiling<Dim>()});
  for (int k = 0; k < 5000; ++k) grains.step(box, 5e-6);
  return grains.dynamics().particles.position[1][Dim - 1] > -1.1e-3;
}

template <int Dim>
void check_pull_off() {
  for (const double of_wall : {20.0, 0.1}) {  // parts between the two, and at the wall
    CHECK(hangs<Dim>(0.995, of_wall));
    CHECK_FALSE(hangs<Dim>(1.005, of_wall));
  }
}

/// Two that touch and are thrown apart, the first faster than the second.
template <int Dim>
BondedGrainsOf<Dim> thrown(double kinetic_over_bond) {
  const std::vector<double> radius{0.3e-3, 0.2e-3};
  auto setup = single_primaries<Dim>(radius, 1000, {{.kind = 0, .other = 0, .law = glue}});
  const double m = setup.particles.mass[0], M = setup.particles.mass[1], reduced = m * M / (m + M);
  const double bond = face<Dim>(radius[0], radius[1]) * glue.surface_energy;
  const double v = std::sqrt(2 * kinetic_over_bond * bond / reduced);
  setup.particles.velocity[0][Dim - 1] = v * M / (m + M);
  setup.particles.velocity[1][Dim - 1] = -v * m / (m + M);
  return BondedGrainsOf<Dim>(std::move(setup));
}

/// Of the kinetic energy, over that of the bond, when they are far apart.
template <int Dim>
void check_escape() {
  const double bond = face<Dim>(0.3e-3, 0.2e-3) * glue.surface_energy;
  BondedGrainsOf<Dim> grains = thrown<Dim>(1.25);
  Box<Dim> box;
  const double start = energy(grains);
  for (int k = 0; k < 4000; ++k) {
    grains.step(box, 2e-7);
    CHECK(std::abs(energy(grains) - start) < 1e-4 * bond);
  }
  CHECK(grains.energies().stored == 0);
  CHECK(std::abs(grains.energies().kinetic / bond / 0.25 - 1) < 1e-3);
  CHECK(std::abs(grains.energies().error + 1.25 * bond) < 1e-4 * bond);  // its budget begins at rest

  BondedGrainsOf<Dim> bound = thrown<Dim>(0.8);
  for (int k = 0; k < 4000; ++k) bound.step(box, 2e-7);
  CHECK(bound.energies().stored < -0.5 * bond);  // they have come back, and lost their speed as they met
}

}  // namespace

TEST_CASE("primaries that adhere hold up to F0 = 2 w l/delta, between grains and at walls") {
  check_pull_off<2>();
  check_pull_off<3>();
}

TEST_CASE("to part two primaries that adhere takes the surface energy of their face") {
  check_escape<2>();
  check_escape<3>();
}

TEST_CASE("two primaries that pass within the range keep both momenta and their energy") {
  constexpr Adhesion weak{.surface_energy = 0.0025, .range = 20e-6};
  auto setup = single_primaries<3>({0.3e-3, 0.2e-3}, 1000, {{.kind = 0, .other = 0, .law = weak}});
  setup.particles.position[0] = {0, 0, 0};
  setup.particles.position[1] = {-0.15e-3, 0, -0.508e-3};  // it will pass at a gap of some um
  setup.particles.velocity[1] = {3, 0.2, -0.03};
  BondedGrainsOf<3> grains(std::move(setup));
  Box<3> box;
  const auto momenta = [&] {
    const RigidParticles<3>& p = grains.dynamics().particles;
    Vec<3> linear, angular;
    for (int i = 0; i < 2; ++i) {
      linear += p.mass[i] * p.velocity[i];
      angular += p.mass[i] * cross(p.position[i], p.velocity[i]);
    }
    return std::pair(linear, angular);
  };
  const auto [linear, angular] = momenta();
  const double start = energy(grains), speed = grains.dynamics().particles.velocity[1][2];
  bool touched = false, attracted = false;
  for (int k = 0; k < 4000; ++k) {
    grains.step(box, 0.2e-6);
    for (const auto& point : grains.contacts()) touched = touched || dot(point.force, point.normal) > 0;
    attracted = attracted || grains.energies().stored < 0;
  }
  CHECK(attracted);
  CHECK_FALSE(touched);
  CHECK(grains.dynamics().particles.velocity[1][2] > speed + 1e-3);  // deflected
  CHECK(norm(momenta().first - linear) < 1e-12 * norm(linear));
  CHECK(norm(momenta().second - angular) < 1e-12 * norm(angular));
  CHECK(std::abs(energy(grains) - start) < 1e-5 * face<3>(0.3e-3, 0.2e-3) * weak.surface_energy);
}

namespace {

/// Grains of 20 primaries that adhere, to each other and to walls: pressed together and pulled apart.
Case sticky_case(int dimension) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::bpm, .dimension = dimension};
  c.bpm.primaries = 20;
  c.bpm.library = 1;
  c.bpm.cohesive_pressure = 2e5;
  c.contact.friction = c.contact.wall_friction = 0.2;
  c.contact.surface_energy = 4;
  c.contact.wall_surface_energy = 6;
  c.sample.grains = dimension == 2 ? 10 : 4;
  c.sample.packing_fraction = dimension == 2 ? 0.6 : 0.35;
  c.loading.wall_velocity = 2;
  c.loading.max_strain = dimension == 2 ? 0.25 : 0.3;
  c.loading.unload_at = {dimension == 2 ? 0.24 : 0.29};
  c.loading.unload_by = dimension == 2 ? 0.15 : 0.2;
  c.output.report = false;
  return c;
}

template <class Simulation>
void check_balance(Simulation simulation, double& most_pulled) {
  double largest_work = 0;
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.steps_done() % 50 != 0) continue;
    const auto row = row_of(simulation.observe());
    simulation.begin_row();
    largest_work = std::max(largest_work, std::abs(test::value_of(row, "wall_work")));
    CHECK(std::abs(test::value_of(row, "energy_error")) < 1e-3 * largest_work + 1e-9);
    most_pulled = std::min(most_pulled, test::value_of(row, "stress_top"));
  }
}

}  // namespace

TEST_CASE("a compact of bonded grains that adhere is pulled apart, and its energy is accounted for") {
  double pulled = 0;
  check_balance(test::simulation_of(sticky_case(2)), pulled);
  CHECK(pulled < -1e3);  // [Pa] the lid pulls
  pulled = 0;
  check_balance(test::solid_simulation_of(sticky_case(3)), pulled);
  CHECK(pulled < -1e3);
  Case periodic = sticky_case(2);
  periodic.experiment.loading = LoadingPath::isotropic;
  periodic.box.x = periodic.box.y = BoxEnd::periodic;
  pulled = 0;
  check_balance(test::simulation_of(periodic), pulled);
}

TEST_CASE("only the pair of kinds that is named adheres") {
  Case c = sticky_case(2);
  c.contact.surface_energy = c.contact.wall_surface_energy = 0;
  c.sample.grains = 8;
  const Case::Kind kind = [&] {
    Case::Kind of = kind_of(c);
    of.grains = 4;
    return of;
  }();
  c.kinds = {kind, kind};
  c.kinds[0].name = "a", c.kinds[1].name = "b";
  c.pairs = {{.kind = 0, .other = 1, .surface_energy = 4.0}};
  Simulation simulation = test::simulation_of(c);
  int pulling = 0;
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.steps_done() % 100 != 0) continue;
    for (const ContactPoint& point : simulation.model().contacts()) {
      if (dot(point.force, point.normal) >= 0) continue;
      ++pulling;
      REQUIRE(point.b >= 0);
      CHECK((point.a < 4) != (point.b < 4));
    }
  }
  CHECK(pulling > 10);
}
