#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "softgrain/experiment/sample.hpp"
#include "softgrain/geometry/images.hpp"
#include "softgrain/math/random.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

struct Variant {
  const char* name;
  GrainModel model;
  Integrator integrator;
};
const Variant variants[] = {{"bonded", GrainModel::bpm, Integrator::backward_euler},
                            {"implicit", GrainModel::mpm, Integrator::backward_euler},
                            {"explicit", GrainModel::mpm, Integrator::symplectic_euler}};

/// Few grains in a cell that repeats along both axes.
Case periodic_packing(const Variant& variant) {
  Case c;
  c.experiment = {.loading = LoadingPath::stages, .model = variant.model};
  c.box = {.x = BoxEnd::periodic, .y = BoxEnd::periodic};
  c.mpm.cells = 3;
  c.mpm.integrator = variant.integrator;
  c.bpm.primaries = 30;
  c.bpm.library = 2;
  c.contact.friction = 0.2;
  c.sample.grains = 9;
  c.sample.packing_fraction = 0.7;
  c.loading.wall_velocity = 2;
  c.solver.precision = Precision::full;
  if (variant.model == GrainModel::bpm) c.time.step = 0.4e-6;
  return c;
}

Stage compress_and_shear(double strain, double rate, double shear_rate) {
  Stage stage{.drives = {{.part = Part::yy, .control = Control::rate, .value = rate},
                         {.part = Part::xx, .control = Control::rate, .value = rate}},
              .until = {}};
  if (shear_rate != 0)
    stage.drives.push_back({.part = Part::xy, .control = Control::rate, .value = shear_rate});
  stage.until.strain[0] = strain;
  return stage;
}

/// sum m (v - L x_c), over sum m |L x_c|.
double peculiar_momentum(const Simulation& simulation) {
  const Bodies bodies = simulation.model().bodies();
  const std::vector<Vec<2>> centre = simulation.model().centres();
  const Mat<2> L = simulation.box().cell.gradient();
  Vec<2> sum;
  double scale = 0;
  for (std::size_t i = 0; i < bodies.mass.size(); ++i) {
    const Vec<2> carried = L * centre[static_cast<std::size_t>(bodies.grain[i])];
    sum += bodies.mass[i] * (bodies.velocity[i] - carried);
    scale += bodies.mass[i] * norm(carried);
  }
  return norm(sum) / scale;
}

/// All grains moved by a vector, and back into the cell where they leave it.
Case translated(Case c, const Vec<2>& by) {
  for (PlacedGrain& grain : c.sample.placed) {
    grain.centre += by;
    grain.centre[0] -= c.box.width * std::floor(grain.centre[0] / c.box.width);
    grain.centre[1] -= c.box.height * std::floor(grain.centre[1] / c.box.height);
  }
  return c;
}

/// The same grains in their places, as a sample's file would give them.
Case with_places(Case c) {
  const BoxSample sample = sample_box(c);
  c.box.width = sample.width;
  c.box.height = sample.height;
  c.sample.placed = sample.grains;
  return complete_sample(c);
}

/// Of the packing, in the plane [Pa].
Mat<2> stress_of(const Simulation& simulation) {
  const Mat<3> stress = simulation.observe().packing->stress;
  Mat<2> in_plane;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) in_plane(i, j) = stress(i, j);
  return in_plane;
}

}  // namespace

TEST_CASE("a cell remapped is the same lattice, with the same gradient, and images go with it") {
  PeriodicCell<2> cell{.repeats = {true, true}};
  cell.edges = {{3.0, 4.0, 0.0, 2.0}};
  cell.rate = {{-0.3, 0.7, 0.0, -0.1}};
  PeriodicCell<2> other = cell;
  REQUIRE(other.remap());
  CHECK(other.edges(0, 1) == doctest::Approx(1));
  CHECK_FALSE(PeriodicCell<2>(other).remap());
  for (std::size_t k = 0; k < 4; ++k)
    CHECK(other.gradient().c[k] == doctest::Approx(cell.gradient().c[k]).epsilon(1e-14));
  const Vec<2> far = cell.shift({5, -7}) + Vec<2>{0.2, -0.1};
  CHECK(norm(far + cell.shift(cell.nearest(far)) - Vec<2>{0.2, -0.1}) < 1e-13);
  CHECK(norm(far + other.shift(other.nearest(far)) - Vec<2>{0.2, -0.1}) < 1e-13);
}

TEST_CASE("all pairs within reach are found through their images, and no pair twice, in a tilted cell too") {
  for (const bool both : {true, false}) {
    CAPTURE(both);
    PeriodicCell<2> cell{.repeats = {true, both}};
    cell.edges = both ? Mat<2>{{1.0, 0.4, 0.0, 0.9}} : Mat<2>{{1.0, 0.0, 0.0, 1.0}};
    std::vector<Vec<2>> points;
    for (std::uint64_t i = 0; i < 60; ++i)
      points.push_back({4 * random_uniform(1, 0, i) - 2, (both ? 4 : 1) * random_uniform(1, 1, i)});
    constexpr double reach = 0.2;
    std::vector<std::pair<int, int>> found, expected;
    for_each_close_pair<2>(points, cell, reach, [&](int i, int j, const Vec<2>& d, const auto& n) {
      CHECK(norm(points[j] + cell.shift(n) - points[i] - d) < 1e-12);
      if (norm(d) < reach) found.emplace_back(i, j);
    });
    for (int i = 0; i < 60; ++i)
      for (int j = i + 1; j < 60; ++j)
        for (int a = -9; a <= 9; ++a)
          for (int b = -9; b <= 9; ++b)
            if ((both || b == 0) && norm(points[j] + cell.shift({a, b}) - points[i]) < reach)
              expected.emplace_back(i, j);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    CHECK(found == expected);
    CHECK(found.size() > 100);
  }
}

TEST_CASE("a periodic cell has no middle: translated by any vector the run is the same") {
  for (const Variant& variant : variants) {
    CAPTURE(variant.name);
    const bool explicitly = variant.integrator == Integrator::symplectic_euler;
    Case c = with_places(periodic_packing(variant));
    c.stages = {compress_and_shear(0.1, 200, 300)};
    Simulation here = test::simulation_of(c);
    Simulation there = test::simulation_of(translated(c, {0.37 * c.box.width, -0.61 * c.box.height}));
    const int steps = variant.model == GrainModel::bpm ? 200 : explicitly ? 400 : 30;
    double stress = 0, difference = 0, across = 0;
    for (int k = 0; k < steps && !here.finished(); ++k) {
      here.step();
      there.step();
      stress = std::max(stress, std::abs(here.box().moment(1, 1)));
      for (std::size_t m = 0; m < 4; ++m)
        difference = std::max(difference, std::abs(here.box().moment.c[m] - there.box().moment.c[m]));
      for (const ContactPoint& contact : there.model().contacts())
        across = std::max(across, norm(contact.image));
    }
    CHECK(stress > 0);
    CHECK(across > 0);
    // round-off; or what Newton's method and the sweeps, in another order, leave
    const double allowed = explicitly ? 1e-9 : variant.model == GrainModel::mpm ? 1e-6 : 1e-3;
    CHECK(difference < allowed * stress);
    MESSAGE(variant.name << ": moments differ by " << difference / stress << " of the largest");
  }
}

TEST_CASE("what the cell gives is what its stress does at its rate, and no momentum comes from nowhere") {
  for (const Variant& variant : variants) {
    CAPTURE(variant.name);
    Case c = periodic_packing(variant);
    c.stages = {compress_and_shear(0.12, 60, 80)};
    Simulation simulation = test::simulation_of(c);
    double work = 0, momentum = 0;
    while (!simulation.finished()) {
      simulation.step();
      // -V sigma : L dt, with the stress of the motion
      work -= contract(stress_of(simulation), simulation.box().cell.gradient()) * simulation.box().volume() *
              simulation.time_step();
      momentum = std::max(momentum, peculiar_momentum(simulation));
    }
    const Energies end = simulation.energies();
    CHECK(work > 0);
    CHECK(work == doctest::Approx(end.wall_work).epsilon(0.02));
    CHECK(std::abs(end.error) < 2e-3 * end.wall_work);
    CHECK(momentum < 1e-6);
  }
}

TEST_CASE(
    "a sample repeated 2 x 2 has the stress and the contacts of the single one, as long as it stays so") {
  for (const Variant& variant : variants) {
    CAPTURE(variant.name);
    const bool explicitly = variant.integrator == Integrator::symplectic_euler;
    Case c = with_places(periodic_packing(variant));
    if (variant.model == GrainModel::bpm) c.bpm.library = 1;  // all grains alike
    c.stages = {compress_and_shear(0.1, 200, 300)};
    Case four = c;
    for (int k = 1; k < 4; ++k)
      for (PlacedGrain grain : c.sample.placed) {
        grain.centre += Vec<2>{(k % 2) * c.box.width, (k / 2) * c.box.height};
        four.sample.placed.push_back(grain);
      }
    four.box.width *= 2;
    four.box.height *= 2;
    Simulation single = test::simulation_of(c), repeated = test::simulation_of(complete_sample(four));
    const int steps = variant.model == GrainModel::bpm ? 500 : explicitly ? 1000 : 80;
    double stress = 0, difference = 0;
    std::size_t most_pairs = 0;
    for (int k = 0; k < steps; ++k) {
      single.step();
      repeated.step();
      stress = std::max(stress, std::abs(single.box().moment(1, 1)));
      for (std::size_t m = 0; m < 4; ++m)
        difference =
            std::max(difference, std::abs(single.box().moment.c[m] - repeated.box().moment.c[m] / 4));
      if (k % 10 != 0) continue;
      const std::size_t pairs = single.observe().packing->network.pairs.size();
      CHECK(repeated.observe().packing->network.pairs.size() == 4 * pairs);
      most_pairs = std::max(most_pairs, pairs);
    }
    CHECK(most_pairs >= (variant.model == GrainModel::bpm ? 2 : 4));
    CHECK(difference < 1e-2 * stress);  // solvers stop where all of a sample is within their tolerance
    MESSAGE(variant.name << ": moments differ by " << difference / stress << " of the largest");
  }
}

TEST_CASE("grains on a square lattice that repeats bear what one of them bears between four walls") {
  double before = 0;
  for (const int cells : {8, 16}) {
    CAPTURE(cells);
    Case c = periodic_packing(variants[1]);
    c.mpm.cells = cells;
    c.loading.wall_velocity = 0.5;
    constexpr double R = 1e-3;
    const auto lattice = [&](int n) {
      Case some = c;
      for (int k = 0; k < n * n; ++k)
        some.sample.placed.push_back(
            {.centre = {(2 * (k % n) + 1) * R, (2 * (k / n) + 1) * R}, .radius = R, .angle = 0});
      some.box.width = some.box.height = 2 * n * R;
      if (n == 1) some.box.x = some.box.y = BoxEnd::walls;
      some.stages = {compress_and_shear(0.03, 50, 0)};
      return complete_sample(some);
    };
    Simulation cell = test::simulation_of(lattice(3)), walls = test::simulation_of(lattice(1));
    while (!walls.finished()) {
      cell.step();
      walls.step();
    }
    REQUIRE(cell.finished());
    const Mat<2> in_cell = stress_of(cell), in_walls = stress_of(walls);
    const double difference = in_cell(1, 1) / in_walls(1, 1) - 1;
    CHECK(std::abs(difference) < 0.06);  // vertices meet curves, not a plane
    if (cells == 16) CHECK(std::abs(difference) < before / 2);
    before = std::abs(difference);
    CHECK(in_cell(0, 0) == doctest::Approx(in_cell(1, 1)).epsilon(1e-3));
    CHECK(std::abs(in_cell(0, 1)) < 1e-3 * in_walls(0, 0));
    CHECK(cell.observe().packing->coordination.z == 4);
  }
}
