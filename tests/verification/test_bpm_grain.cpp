#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "softgrain/bpm/aggregate.hpp"
#include "support/gravity.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

constexpr double R = 5e-3;

std::map<std::string, double> row_of(Simulation& simulation) {
  std::map<std::string, double> row;
  for (const Quantity& quantity : test::next_row(simulation)) row[quantity.name] = quantity.value;
  return row;
}

}  // namespace

TEST_CASE("a grain of 300 primaries is isostatic, dense and round") {
  for (const std::uint64_t seed : {1, 2}) {
    const Aggregate grain = prepare_aggregate({.primaries = 300, .seed = seed});
    CHECK(grain.coordination > 3.85);
    CHECK(grain.coordination < 4.0);
    CHECK(grain.roundness < 0.1);
    double fraction = 0;  // area of the primaries over that of the round grain
    for (const double r : grain.radius) fraction += r * r;
    CHECK(fraction > 0.78);
    CHECK(fraction < 0.85);
  }
}

TEST_CASE("a free grain stays at rest, whole and in shape") {
  const Aggregate grain = prepare_aggregate({.primaries = 300});
  double squares = 0;
  for (const double r : grain.radius) squares += r * r;
  std::vector<Vec<2>> start;
  std::vector<double> radius, mass;
  for (std::size_t i = 0; i < grain.radius.size(); ++i) {
    start.push_back(R * grain.position[i]);
    radius.push_back(R * grain.radius[i]);
    mass.push_back(990 * std::numbers::pi * R * R * grain.radius[i] * grain.radius[i] / squares);
  }
  RigidDynamics<2> dynamics(
      rigid_particles<2>(start, radius, mass, {}), test::friction(0),
      {.solver = {.min_sweeps = 10, .max_sweeps = 50, .tolerance = 1e-5, .relaxation = 1.3}, .law = {}},
      0.15 * grain.mean_distance * R);
  AttractionForces attraction({.F0 = 100, .gamma = 7});
  double kinetic_late = 0, overlap_late = 0;
  for (int step = 0; step < 4000; ++step) {  // 1 ms, 60 periods of a bond
    const StepReport report = dynamics.step(
        [&](const RigidParticles<2>& particles, std::span<Vec<2>> force) {
          attraction.update(particles, dynamics.reference);
          attraction.add_forces(particles, force);
        },
        0.25e-6);
    if (step < 1000) continue;
    kinetic_late = std::fmax(kinetic_late, kinetic_energy(dynamics.particles));
    overlap_late = std::fmax(overlap_late, report.overlap_max);
  }
  const double binding = -attraction.energy(dynamics.particles);
  CHECK(kinetic_late < 1e-5 * binding);
  CHECK(overlap_late < 1e-4);
  Vec<2> momentum;
  for (int i = 0; i < dynamics.particles.size(); ++i) {
    CHECK(norm(dynamics.particles.position[i] - start[i]) < 2e-3 * R);
    momentum += mass[i] * dynamics.particles.velocity[i];
  }
  CHECK(norm(momentum) < 1e-12);
}

TEST_CASE("a grain between walls yields at a fraction of its cohesive pressure, whole, and lets go") {
  Case c;
  c.bpm.primaries = 300;
  c.loading = {.wall_velocity = 0.1, .max_strain = 0.065, .unload_at = {0.06}, .unload_by = 0.04};
  c.time.step = 0.25e-6;
  Simulation simulation = test::simulation_of(c);
  double top = 0, bottom = 0, difference = 0, yield = 0, strain_of_release = 0;
  int rows = 0, yield_rows = 0;
  std::map<std::string, double> row;
  while (row["leg"] < 2) {
    for (int step = 0; step < 500; ++step) REQUIRE(simulation.step().overlap_max < 2e-3);
    row = row_of(simulation);
    REQUIRE(row["clusters"] == 1);
    REQUIRE(std::abs(row["energy_error"]) < 1e-4 * row["wall_work"]);
    if (row["leg"] == 1 && row["force_top"] > 0) strain_of_release = row["strain"];
    if (row["leg"] > 0) continue;
    top += row["force_top"];
    bottom += row["force_bottom"];
    difference += std::abs(row["force_top"] - row["force_bottom"]);
    ++rows;
    if (row["strain"] < 0.03) continue;
    yield += row["stress_top"];
    ++yield_rows;
  }
  CHECK(rows > 40);
  CHECK(std::abs(top - bottom) < 0.03 * top);
  CHECK(difference < 0.2 * top);
  CHECK(yield / yield_rows > 0.1 * row["sigma_I"]);
  CHECK(yield / yield_rows < 0.3 * row["sigma_I"]);
  // the wall leaves the grain while it still moves up; large primaries give back more than small ones
  CHECK(strain_of_release > 0.06 - 0.035);
  CHECK(row["dissipation"] > 0);
}

namespace {

/// How the units scale between two similar experiments.
struct Similarity {
  double time, length, force;

  double factor(const std::string& unit) const {
    const std::map<std::string, double> factors{
        {"", 1}, {"s", time}, {"m", length}, {"Pa", force / length}, {"N/m", force}, {"J/m", force * length}};
    return factors.at(unit);
  }
};

Case small_case() {
  Case c;
  c.bpm.primaries = 100;
  c.loading = {.wall_velocity = 1, .max_strain = 0.04, .unload_at = {0.03}, .unload_by = 0.01};
  return c;
}

/// Powers of two change no mantissa, so that similar experiments agree to the last bit.
void check_similar(const Case& scaled_case, const Similarity& similarity) {
  Simulation original = test::simulation_of(small_case()), scaled = test::simulation_of(scaled_case);
  REQUIRE(original.steps_planned() == scaled.steps_planned());
  while (!original.finished()) {
    original.step();
    scaled.step();
    if (original.steps_done() % 50 != 0) continue;
    const auto row = test::next_row(original), scaled_row = test::next_row(scaled);
    for (std::size_t k = 0; k < row.size(); ++k) {
      CAPTURE(row[k].name);
      REQUIRE(scaled_row[k].value == similarity.factor(row[k].unit) * row[k].value);
    }
  }
}

}  // namespace

TEST_CASE("stress is proportional to F0: four times the attraction at twice the speed gives the same curve") {
  Case strong = small_case();
  strong.bpm.attraction *= 4;
  strong.loading.wall_velocity *= 2;
  strong.time.step /= 2;
  check_similar(strong, {.time = 0.5, .length = 1, .force = 4});
}

TEST_CASE("a grain twice as large with eight times the attraction gives the same curve over F0/a0") {
  // masses grow fourfold, so that accelerations and lengths both double
  Case large = small_case();
  large.grain.radius *= 2;
  large.bpm.attraction *= 8;
  large.loading.wall_velocity *= 2;
  check_similar(large, {.time = 1, .length = 2, .force = 8});
}
