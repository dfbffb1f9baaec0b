
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "softgrain/bpm/bonded_sample.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/observe/stress.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

/// Six grains of few primaries, a fast wall.
Case small_case() {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::bpm};
  c.sample.grains = 6;
  c.sample.packing_fraction = 0.6;
  c.bpm.primaries = 30;
  c.bpm.library = 2;
  c.loading.wall_velocity = 5;
  c.loading.max_strain = 0.6;
  c.time.step = 0.4e-6;
  return c;
}

std::map<std::string, double> row_of(Simulation& simulation) {
  std::map<std::string, double> row;
  for (const Quantity& quantity : test::next_row(simulation)) row[quantity.name] = quantity.value;
  return row;
}

/// Every bit of a sample (FNV-1a).
std::uint64_t hash_of(const BoxSample& sample) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto add = [&](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 255)) * 0x100000001b3ull;
  };
  add(sample.width);
  for (const PlacedGrain& grain : sample.grains)
    for (const double value : {grain.centre[0], grain.centre[1], grain.radius, grain.angle}) add(value);
  return hash;
}

const std::vector<double>& numbers(const Array& array) { return std::get<std::vector<double>>(array.values); }

}  // namespace

TEST_CASE("both models begin with the same sample, bit for bit") {
  Case c = small_case();
  c.sample.seed = 7;
  const BoxSample placed = sample_box(c);
  CHECK(hash_of(placed) == hash_of(sample_box({.grains = 6, .packing_fraction = 0.6, .seed = 7})));
  c.experiment.model = GrainModel::mpm;
  c.mpm.cells = 4;
  const Scene scene = create_simulation(c)->scene();
  // outlines of soft grains: their vertices lie evenly round the centre
  std::vector<Vec<2>> centre(6);
  std::vector<int> vertices(6, 0);
  const auto& grain = std::get<std::vector<std::int64_t>>(scene.outlines.at("grain").values);
  const auto& x = numbers(scene.outlines.at("position"));
  for (std::size_t v = 0; v < grain.size(); ++v) {
    centre[grain[v]] += Vec<2>{x[2 * v], x[2 * v + 1]};
    ++vertices[grain[v]];
  }
  for (int g = 0; g < 6; ++g) CHECK(norm((1.0 / vertices[g]) * centre[g] - placed.grains[g].centre) < 1e-12);
}

TEST_CASE("grains of primaries stand in their places without overlap, each with the mass of its disk") {
  const Case c = small_case();
  const BoxSample box = sample_box(c);
  const BpmSample sample = fill_box<2>(box, {prepare_library(library_of(c))}, {library_of(c)});
  const RigidParticles<2>& p = sample.particles;
  CHECK(p.size() == 180);
  CHECK(sample.displaced < 0.2);
  std::vector<double> mass(6, 0);
  std::vector<Vec<2>> centre(6);
  for (int i = 0; i < p.size(); ++i) {
    mass[p.grain[i]] += p.mass[i];
    centre[p.grain[i]] += p.mass[i] * p.position[i];
    for (const Wall<2>& wall : box_of(box).walls)
      CHECK(dot(p.position[i] - wall.point, wall.normal) > 0.998 * p.radius[i]);
    for (int j = 0; j < i; ++j)
      if (p.grain[i] != p.grain[j])
        CHECK(norm(p.position[i] - p.position[j]) > 0.999 * (p.radius[i] + p.radius[j]));
  }
  std::set<double> shapes;
  for (int g = 0; g < 6; ++g) {
    const PlacedGrain& grain = box.grains[g];
    CHECK(mass[g] == doctest::Approx(990 * std::numbers::pi * grain.radius * grain.radius));
    CHECK(norm((1 / mass[g]) * centre[g] - grain.centre) < (sample.displaced + 1e-9) * grain.radius);
    shapes.insert(std::round(1e6 * p.radius[30 * g] / grain.radius));
  }
  CHECK(shapes.size() == 2);  // of two different aggregates
}

TEST_CASE(
    "attraction holds within grains at the same F0/<a0> in all of them, friction differs inside and out") {
  Case c = small_case();
  c.contact.friction = 0.5;
  c.contact.wall_friction = 0.25;
  c.bpm.inner_friction = 0.125;
  c.bpm.cohesive_pressure = 2e6;
  Simulation simulation = test::simulation_of(c);
  for (int step = 0; step < 2000; ++step) simulation.step();
  const auto& p = test::bonded(simulation).particles;
  const auto& contacts = test::bonded(simulation).contacts;
  int inner = 0, between = 0, wall = 0;
  for (int k = 0; k < contacts.size(); ++k) {
    const int a = contacts.body_a[k], b = contacts.body_b[k];
    const bool is_wall = b >= p.size(), same = !is_wall && p.grain[a] == p.grain[b];
    CHECK(contacts.friction[k] == (is_wall ? 0.25 : same ? 0.125 : 0.5));
    (is_wall ? wall : same ? inner : between) += 1;
  }
  CHECK(inner > 0);
  CHECK(between > 0);
  CHECK(wall > 0);
}

TEST_CASE("F0 follows the size of the primaries, so that every grain has the same cohesive pressure") {
  const Case c = small_case();
  const BoxSample box = sample_box(c);
  const BpmSample sample = fill_box<2>(box, {prepare_library(library_of(c))}, {library_of(c)});
  // the same aggregate in two grains: <a0> scales with the radius
  CHECK(sample.mean_distance[0] / sample.mean_distance[2] ==
        doctest::Approx(box.grains[0].radius / box.grains[2].radius));
  // one grain alone, loaded in its place: its potential is that of F0 = sigma_I <a0>
  Case alone = c;
  alone.sample.grains = 1;
  alone.sample.packing_fraction = 0.4;
  Case stronger = alone;
  stronger.bpm.cohesive_pressure *= 3;
  Simulation a = test::simulation_of(alone), b = test::simulation_of(stronger);
  CHECK(row_of(b)["attraction_energy"] == doctest::Approx(3 * row_of(a)["attraction_energy"]));
  Case large = alone;  // twice as large: F0 and lengths double
  large.sample.smallest_diameter *= 2;
  large.sample.largest_diameter *= 2;
  Simulation l = test::simulation_of(large);
  CHECK(row_of(l)["attraction_energy"] == doctest::Approx(4 * row_of(a)["attraction_energy"]));
}

TEST_CASE("with primaries of one size, larger grains have more of them") {
  Case c = small_case();
  c.sample.grains = 12;
  c.bpm.equal = EqualPrimaries::size;
  c.bpm.library = 5;
  const BoxSample box = sample_box(c);
  const BpmSample sample = fill_box<2>(box, {prepare_library(library_of(c))}, {library_of(c)});
  double smallest = 1, largest = 0;
  for (int g = 0; g < 12; ++g) {
    CHECK(sample.begin[g + 1] - sample.begin[g] >= 30);
    double sum = 0;
    for (int i = sample.begin[g]; i < sample.begin[g + 1]; ++i) sum += sample.particles.radius[i];
    sum /= sample.begin[g + 1] - sample.begin[g];
    smallest = std::min(smallest, sum);
    largest = std::max(largest, sum);
  }
  CHECK(largest / smallest < 1.2);
}

TEST_CASE("a packing is compacted until its primaries are close packed, whole, and says why it ends") {
  Simulation simulation = test::simulation_of(small_case());
  CHECK(simulation.early_end().empty());
  double error = 0, work = 1;
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.steps_done() % 200 == 0) {
      auto row = row_of(simulation);
      REQUIRE(row["clusters"] == 6);
      error = row["energy_error"], work = row["wall_work"];
      CHECK(row["phi_0"] == doctest::Approx(0.6 * std::exp(row["strain"])));
    }
  }
  CHECK(std::abs(error) < 2e-3 * work);
  CHECK(simulation.progress() == 1);
  CHECK(simulation.steps_done() < simulation.steps_planned());
  CHECK(simulation.early_end().find(
            "random close packing, and overlap by more than 0.0005 of their radius") != std::string::npos);
  CHECK_FALSE(simulation.outcome().completed);
  CHECK(simulation.outcome().shortfall.find("before loading.max_strain") != std::string::npos);
  auto row = row_of(simulation);
  CHECK(row["solid_fraction"] > 0.82);
  CHECK(row["solid_fraction"] < 0.9);
  CHECK(row["z"] > 2);
  CHECK(row["stress_top"] > 5e5);
  const BoxSample sample = sample_box(small_case());
  const Vec<2> box{sample.width, sample.height};
  for (const Vec<2>& x : test::bonded(simulation).particles.position)
    for (int d = 0; d < 2; ++d) CHECK((x[d] > 0 && x[d] < box[d]));
}

TEST_CASE("a packing at rest has the stress of its walls by Love and Weber, and all walls agree") {
  Case c = small_case();
  c.loading.max_strain = 0.52;
  c.loading.hold = 3e-3;
  Simulation simulation = test::simulation_of(c);
  constexpr int last = 1000;
  while (simulation.steps_done() < simulation.steps_planned() - last) simulation.step();
  auto row = row_of(simulation);
  REQUIRE(test::bonded(simulation).particles.velocity.back() == Vec<2>{});
  const double area = simulation.box().volume();
  Mat<2> sigma;
  while (!simulation.finished()) {
    simulation.step();
    sigma += (1.0 / last) * contact_stress(simulation.model().contacts(), simulation.model().centres(), area);
  }
  row = row_of(simulation);        // wall stresses: means over the same steps
  CHECK(row["stress_top"] > 1e4);  // loaded; how much, each rounding decides anew
  CHECK(row["stress_top"] == doctest::Approx(row["stress_bottom"]).epsilon(0.02));
  CHECK(sigma(1, 1) == doctest::Approx(row["stress_top"]).epsilon(0.02));
  CHECK(sigma(0, 0) == doctest::Approx(row["stress_side"]).epsilon(0.02));
  CHECK(std::abs(sigma(0, 1) - sigma(1, 0)) < 0.02 * sigma(1, 1));
}

TEST_CASE("an overlap that is asked for ends a compaction before the close packing") {
  Case c = small_case();
  c.loading.max_overlap = 2e-5;
  Simulation simulation = test::simulation_of(c);
  double overlap = 0;
  while (!simulation.finished()) {
    CHECK(overlap < 2e-5);
    overlap = simulation.step().overlap_mean;
  }
  CHECK(overlap >= 2e-5);
  CHECK(simulation.early_end() == "loading.max_overlap is reached");
  CHECK(simulation.outcome().completed);
  auto row = row_of(simulation);
  CHECK(row["dissipation_friction"] == 0);
  CHECK(row["dissipation_rearrangement"] > 0);
  CHECK(row["dissipation_contact"] + row["dissipation_rearrangement"] == doctest::Approx(row["dissipation"]));
}

TEST_CASE("a stress ends the compaction") {
  Case c = small_case();
  c.loading.max_stress = 2e5;
  Simulation simulation = test::simulation_of(c);
  while (!simulation.finished()) simulation.step();
  CHECK(simulation.early_end() == "loading.max_stress is reached");
  CHECK(simulation.progress() == 1);
  // where the run ends is part of its state
  Simulation restored = test::simulation_of(c);
  restored.restore(simulation.checkpoint());
  CHECK(restored.finished());
  CHECK(restored.early_end() == simulation.early_end());
}

TEST_CASE("a restored compaction goes on bit for bit") {
  Case c = small_case();
  c.contact.friction = 0.5;
  Simulation through = test::simulation_of(c), resumed = test::simulation_of(c);
  for (int step = 0; step < 700; ++step) through.step();
  test::next_row(through);
  for (int step = 0; step < 137; ++step) through.step();
  resumed.restore(through.checkpoint());
  for (int step = 0; step < 500; ++step) {
    through.step();
    resumed.step();
  }
  REQUIRE(test::bonded(through).reference.generation > 10);
  const Checkpoint a = through.checkpoint(), b = resumed.checkpoint();
  REQUIRE(a.arrays.size() == b.arrays.size());
  for (const auto& array : a.arrays) {
    CAPTURE(array.first);
    CHECK((array.second.values == b.arrays.at(array.first).values));
  }
  CHECK(row_of(through) == row_of(resumed));
  const Scene scene = resumed.scene();
  CHECK(numbers(scene.particles.at("position")).size() == 360);
  CHECK(scene.wall_segments.size() == 16);
  CHECK(scene.particles.contains("grain"));
  CHECK(scene.outlines.contains("grain"));

  // whatever pushes a wall lies at its segment
  const auto& pairs = std::get<std::vector<std::int64_t>>(scene.contacts.at("pair").values);
  const auto &position = numbers(scene.particles.at("position")),
             &radius = numbers(scene.particles.at("radius"));
  int at_walls = 0;
  for (std::size_t k = 0; k < pairs.size(); k += 2) {
    const auto wall = pairs[k + 1] - static_cast<std::int64_t>(radius.size());
    if (wall < 0) continue;
    const double* segment = &scene.wall_segments[4 * wall];
    const int across = wall < 2 ? 1 : 0;
    CHECK(segment[across] == segment[across + 2]);
    CHECK(std::abs(position[2 * pairs[k] + across] - segment[across]) < 1.1 * radius[pairs[k]]);
    ++at_walls;
  }
  CHECK(at_walls > 0);
}
