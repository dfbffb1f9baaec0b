#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

/// A small grain under a wall so fast that the lists of pairs are made again about every 80 steps.
Case small_case() {
  Case c;
  c.bpm.primaries = 60;
  c.loading = {.wall_velocity = 4, .max_strain = 0.1, .unload_at = {}};
  c.time.step = 0.25e-6;
  return c;
}

void advance(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) simulation.step();
}

void check_same_row(Simulation& a, Simulation& b) {
  const auto row_a = test::next_row(a), row_b = test::next_row(b);
  REQUIRE(row_a.size() == row_b.size());
  for (std::size_t k = 0; k < row_a.size(); ++k) {
    CAPTURE(row_a[k].name);
    CHECK(row_a[k].name == row_b[k].name);
    CHECK(row_a[k].value == row_b[k].value);
  }
}

void check_same_state(const Simulation& a, const Simulation& b) {
  const Checkpoint x = a.checkpoint(), y = b.checkpoint();
  CHECK(x.step == y.step);
  CHECK(x.time == y.time);
  REQUIRE(x.arrays.size() == y.arrays.size());
  for (const auto& array : x.arrays) {
    CAPTURE(array.first);
    REQUIRE(y.arrays.contains(array.first));
    CHECK(array.second.columns == y.arrays.at(array.first).columns);
    CHECK((array.second.values == y.arrays.at(array.first).values));
  }
}

}  // namespace

TEST_CASE("a restored compression goes on bit for bit, whenever it was saved") {
  Simulation through = test::simulation_of(small_case());
  std::vector<Checkpoint> saved;
  std::vector<int> generation;
  for (int step = 0; step < 200; ++step) {
    if (step == 1 || step == 100 || step == 137) saved.push_back(through.checkpoint());
    if (step % 50 == 0) generation.push_back(test::bonded(through).reference.generation);
    if (step == 60) test::next_row(through);  // starts a new row, whose sums are then part of the state
    through.step();
  }
  REQUIRE(generation.back() > generation[2]);  // the lists were made again between 100 and 150
  REQUIRE(generation[2] > generation[0]);      // and before 100
  const std::vector<Quantity> row = test::next_row(through);
  for (const Checkpoint& checkpoint : saved) {
    CAPTURE(checkpoint.step);
    Simulation resumed = test::simulation_of(small_case());
    resumed.restore(checkpoint);
    CHECK(resumed.steps_done() == checkpoint.step);
    for (std::int64_t step = checkpoint.step; step < 200; ++step) {
      if (step == 60) test::next_row(resumed);
      resumed.step();
    }
    const std::vector<Quantity> again = test::next_row(resumed);
    for (std::size_t k = 0; k < row.size(); ++k) {
      CAPTURE(row[k].name);
      CHECK(again[k].value == row[k].value);
    }
    check_same_state(through, resumed);
  }
}

TEST_CASE("a restored compression shows at once what the saved one showed") {
  Case c = small_case();
  c.loading.max_strain = 0.5;
  Simulation saved = test::simulation_of(c), restored = test::simulation_of(c);
  advance(saved, 3000);  // far enough for primaries to have found other neighbours
  restored.restore(saved.checkpoint());
  const Scene a = saved.scene(), b = restored.scene();
  for (const char* field : {"position", "velocity", "radius", "coordination"})
    CHECK((a.particles.at(field).values == b.particles.at(field).values));
  CHECK(a.wall_segments == b.wall_segments);
  CHECK((a.contacts.at("pair").values == b.contacts.at("pair").values));
  const auto& before = std::get<std::vector<double>>(a.particles.at("pressure").values);
  const auto& after = std::get<std::vector<double>>(b.particles.at("pressure").values);
  for (std::size_t i = 0; i < before.size(); ++i) CHECK(after[i] == doctest::Approx(before[i]).epsilon(1e-3));
  check_same_row(saved, restored);
}

TEST_CASE("a checkpoint of another case is refused by the array that does not fit") {
  Case other = small_case();
  other.bpm.primaries = 61;
  Simulation of_sixty = test::simulation_of(small_case()), of_one_more = test::simulation_of(other);
  CHECK_THROWS_WITH_AS(of_one_more.restore(of_sixty.checkpoint()),
                       doctest::Contains("no array 'position' of 2 numbers a row and 61 rows: it belongs to"),
                       IoError);
  Checkpoint incomplete = of_sixty.checkpoint();
  incomplete.arrays.erase("wall_point");
  CHECK_THROWS_WITH_AS(
      of_sixty.restore(incomplete),
      doctest::Contains("no array 'wall_point' of 2 numbers a row and 2 rows: it belongs to"), IoError);
}

TEST_CASE("the walls start at the grain's lowest and highest point, and the top one follows the path") {
  Simulation simulation = test::simulation_of(small_case());
  const auto& particles = test::bonded(simulation).particles;
  double low = 1, high = -1;
  for (int i = 0; i < particles.size(); ++i) {
    low = std::min(low, particles.position[i][1] - particles.radius[i]);
    high = std::max(high, particles.position[i][1] + particles.radius[i]);
  }
  CHECK(simulation.box().walls[0].point[1] == doctest::Approx(low).epsilon(1e-14));
  CHECK(simulation.box().walls[1].point[1] == doctest::Approx(high).epsilon(1e-14));
  CHECK(test::value_of(test::next_row(simulation), "strain") == 0);
  advance(simulation, 100);
  CHECK(simulation.box().walls[0].point[1] == doctest::Approx(low).epsilon(1e-14));
  CHECK(simulation.box().walls[1].point[1] == doctest::Approx(high - 100 * 4 * 0.25e-6).epsilon(1e-12));
  const auto row = test::next_row(simulation);
  CHECK(test::value_of(row, "strain") ==
        doctest::Approx(-std::log(1 - 50 * 4 * 0.25e-6 / 5e-3)).epsilon(1e-9));
  CHECK(test::value_of(row, "wall_height") == doctest::Approx(high - low - 1e-4).epsilon(1e-12));
  CHECK(test::value_of(row, "time") == doctest::Approx(100 * 0.25e-6).epsilon(1e-14));
}

TEST_CASE("the grain weighs rho pi R^2 and friction differs inside and at the walls") {
  Case c = small_case();
  c.bpm.inner_friction = 0.2;
  c.contact.wall_friction = 0.5;
  const Simulation simulation = test::simulation_of(c);
  const auto& particles = test::bonded(simulation).particles;
  const double mass = std::accumulate(particles.mass.begin(), particles.mass.end(), 0.0);
  CHECK(mass == doctest::Approx(990 * std::numbers::pi * 25e-6).epsilon(1e-13));
  const auto& contacts = test::bonded(simulation).contacts;
  int inner = 0, outer = 0;
  for (int k = 0; k < contacts.size(); ++k) {
    const bool wall = contacts.body_b[k] >= particles.size();
    CHECK(contacts.friction[k] == (wall ? 0.5 : 0.2));
    ++(wall ? outer : inner);
  }
  CHECK(inner > 60);
  CHECK(outer >= 2);
}

TEST_CASE("progress runs from zero to one over the planned steps") {
  Case c = small_case();
  c.loading.max_strain = 0.001;
  const auto simulation = create_simulation(c);
  // travel 2 R (1 - exp(-0.001)) = 9.995 um at 1 um a step
  REQUIRE(simulation->steps_planned() == 10);
  CHECK(simulation->progress() == 0);
  CHECK_FALSE(simulation->finished());
  for (int k = 0; k < 10; ++k) simulation->step();
  CHECK(simulation->finished());
  CHECK(simulation->progress() == 1);
}

TEST_CASE("a turning point is the state between two legs of the path") {
  Case c = small_case();
  c.loading = {.wall_velocity = 4, .max_strain = 0.002, .unload_at = {0.001}, .unload_by = 0.0005};
  Simulation simulation = test::simulation_of(c);
  std::vector<std::int64_t> turns;
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.at_turning_point()) turns.push_back(simulation.steps_done());
  }
  // 9.995 um down, 5 um up, 15 um down, at 1 um a step
  CHECK(turns == std::vector<std::int64_t>{10, 15});
  CHECK(simulation.steps_done() == 30);
}

TEST_CASE("a row's wall forces are means over the steps since the last row") {
  Simulation simulation = test::simulation_of(small_case());
  advance(simulation, 100);
  test::next_row(simulation);
  double bottom = 0, top = 0;
  for (int k = 0; k < 10; ++k) {
    simulation.step();
    bottom -= test::bonded(simulation).wall_impulse(0)[1] / (10 * 0.25e-6);
    top += test::bonded(simulation).wall_impulse(1)[1] / (10 * 0.25e-6);
  }
  const auto row = test::next_row(simulation);
  CHECK(top > 0);
  CHECK(test::value_of(row, "force_bottom") == doctest::Approx(bottom).epsilon(1e-12));
  CHECK(test::value_of(row, "force_top") == doctest::Approx(top).epsilon(1e-12));
  CHECK(test::value_of(row, "stress_top") ==
        doctest::Approx(top / test::value_of(row, "width")).epsilon(1e-12));
}

TEST_CASE("the width is that of the grain, and the scene's contacts are those of the row") {
  Simulation simulation = test::simulation_of(small_case());
  advance(simulation, 200);
  while (test::bonded(simulation).wall_impulse(1) == Vec<2>{}) simulation.step();
  const auto& particles = test::bonded(simulation).particles;
  double left = 1, right = -1;
  for (int i = 0; i < particles.size(); ++i) {
    left = std::min(left, particles.position[i][0] - particles.radius[i]);
    right = std::max(right, particles.position[i][0] + particles.radius[i]);
  }
  const auto row = test::next_row(simulation);
  CHECK(test::value_of(row, "width") == doctest::Approx(right - left).epsilon(1e-13));

  const Scene scene = simulation.scene();
  const auto& pairs = std::get<std::vector<std::int64_t>>(scene.contacts.at("pair").values);
  const auto& coordination = std::get<std::vector<double>>(scene.particles.at("coordination").values);
  const double contacts = test::value_of(row, "contacts");
  const auto inner =
      static_cast<double>(std::ranges::count_if(pairs, [](std::int64_t i) { return i < 60; })) - contacts;
  CHECK(pairs.size() == 2 * contacts);
  CHECK(test::value_of(row, "z_primaries") == doctest::Approx(2 * inner / 60).epsilon(1e-14));
  CHECK(contacts > inner);  // the walls'
  // an inner contact belongs to two primaries, one with a wall to one
  CHECK(std::accumulate(coordination.begin(), coordination.end(), 0.0) == contacts + inner);
}

TEST_CASE("in a grain without load the pushing contacts balance the pulling attraction") {
  Case c = small_case();
  c.loading.wall_velocity = 1e-3;
  Simulation simulation = test::simulation_of(c);
  advance(simulation, 1000);
  const auto scene = simulation.scene();
  const auto& pressure = std::get<std::vector<double>>(scene.particles.at("pressure").values);
  const auto& radius = std::get<std::vector<double>>(scene.particles.at("radius").values);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < radius.size(); ++i) {
    sum += radius[i] * radius[i] * pressure[i];
    squares += radius[i] * radius[i];
  }
  CHECK(std::abs(sum / squares) < 0.02 * test::value_of(test::next_row(simulation), "sigma_I"));
}

TEST_CASE("a grain torn in two counts two clusters") {
  Simulation simulation = test::simulation_of(small_case());
  CHECK(test::value_of(test::next_row(simulation), "clusters") == 1);
  Checkpoint torn = simulation.checkpoint();
  const double a0 = small_case().bpm.attraction / test::value_of(test::next_row(simulation), "sigma_I");
  auto& x = std::get<std::vector<double>>(torn.arrays.at("position").values);
  for (std::size_t i = 0; i < x.size(); i += 2)
    if (x[i] > 0) x[i] += 0.8 * a0;  // still within the reach of the attraction
  simulation.restore(torn);
  CHECK(test::value_of(test::next_row(simulation), "clusters") == 2);
}

TEST_CASE("a compression that cannot be run is refused with the key and the value") {
  const auto with = [](auto change) {
    Case c = small_case();
    change(c);
    return [c] { create_simulation(c); };
  };
  CHECK_THROWS_AS(with([](Case& c) { c.contact.restitution = 0.5; })(), UsageError);
  CHECK_THROWS_AS(with([](Case& c) { c.contact.push_out = 2; })(), UsageError);
  CHECK_THROWS_AS(with([](Case& c) { c.bpm.attraction = -1; })(), UsageError);
  CHECK_THROWS_AS(with([](Case& c) { c.bpm.attraction = 0, c.time.step = 0; })(), UsageError);
  CHECK_THROWS_AS(with([](Case& c) { c.time.step = 1.01 * critical_bond_step(c); })(), UsageError);
  CHECK_THROWS_AS(with([](Case& c) { c.bpm.primaries = 3; })(), UsageError);
  CHECK_THROWS_AS(with([](Case& c) { c.loading.wall_velocity = 0; })(), UsageError);
}

TEST_CASE("a wall that leaves no room ends with a NumericalError that says what to change") {
  Case c = small_case();
  c.loading = {.wall_velocity = 50, .max_strain = 4, .unload_at = {}};
  Simulation simulation = test::simulation_of(c);
  try {
    while (!simulation.finished()) simulation.step();
    FAIL("rigid primaries went into a gap smaller than one of them");
  } catch (const NumericalError& error) {
    CHECK(std::string(error.what()).find("time.step") != std::string::npos);
  }
}
