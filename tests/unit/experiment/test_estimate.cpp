#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <tuple>

#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/ranks_estimate.hpp"
#include "softgrain/soft/reference_grid.hpp"
#include "softgrain/soft/solid_grid.hpp"

using namespace softgrain;

TEST_CASE("a loading without unloading takes travel over wall velocity over time step") {
  Case c;
  c.loading.unload_at = {};
  c.loading.max_strain = std::log(2.0);  // the wall crosses half the grain: R
  c.loading.wall_velocity = 0.5;
  c.grain.radius = 5e-3;
  c.time.step = 1e-6;
  CHECK(estimate(c).steps == 10000);
}

TEST_CASE("the points of a grain are those of its grid, whatever the number of cells") {
  Case c;
  c.experiment.model = GrainModel::mpm;
  for (const int n : {2, 3, 4, 5, 6, 8, 11}) {
    c.mpm.cells = n;
    c.experiment.dimension = 2;
    CHECK(points_of_grain(c) == 4 * static_cast<int>(disk_grid(n).cell.size()));
    c.experiment.dimension = 3;
    CHECK(points_of_grain(c) == 8 * static_cast<int>(ball_grid(n).cell.size()));
    c.experiment.model = GrainModel::rigid;
    CHECK(points_of_grain(c) == ball_grid(n).outline_nodes());
    c.experiment.model = GrainModel::mpm;
  }
}

TEST_CASE("the estimate counts the steps of every path") {
  Case c;
  c.loading = {
      .wall_velocity = 0.2, .max_strain = 0.35, .unload_at = {0.1}, .unload_by = 0.015, .hold = 1e-3};
  const auto travel = [&](double from, double to) {  // |d height| of one grain
    return 2 * c.grain.radius * std::abs(std::exp(-from) - std::exp(-to));
  };
  const double way = travel(0, 0.1) + travel(0.1, 0.085) + travel(0.085, 0.35);
  CHECK(estimate(c).steps == doctest::Approx((way / 0.2 + 3e-3) / 0.25e-6).epsilon(1e-3));
  c.loading = {.wall_velocity = 0.2, .max_strain = 0.35, .unload_at = {}};
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.sample.smallest_diameter = c.sample.largest_diameter = 2e-3;
  c.sample.packing_fraction = 0.5;
  c.time.step = 1e-6;
  const double side = std::sqrt(c.sample.grains * 3.14159265 * 1e-6 / 0.5);
  const double compaction = side * (1 - std::exp(-0.35)) / 0.2 / 1e-6;
  CHECK(estimate(c).steps == doctest::Approx(compaction).epsilon(1e-3));
  c.sample.aspect = 4;  // half as high
  CHECK(estimate(c).steps == doctest::Approx(compaction / 2).epsilon(1e-3));
}

TEST_CASE("half the time step doubles the steps and the hours") {
  Case c;
  c.time.step = 0.2e-6;
  const Estimate whole = estimate(c);
  c.time.step /= 2;
  const Estimate half = estimate(c);
  CHECK(half.steps == doctest::Approx(2 * whole.steps).epsilon(1e-3));
  CHECK(half.hours == doctest::Approx(2 * whole.hours).epsilon(1e-3));
  CHECK(half.memory == whole.memory);
}

TEST_CASE("a batch of eight grains costs what one grain costs") {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.time.step = 1e-6;
  c.sample.grains = 1;
  const Estimate one = estimate(c);
  c.sample.grains = 8;
  const Estimate eight = estimate(c);
  CHECK(eight.particles == 8 * one.particles);
  CHECK(eight.hours / eight.steps == doctest::Approx(one.hours / one.steps).epsilon(1e-3));  // but for rows
}

TEST_CASE("the hours are within a factor of two of what the paper's runs took") {
  // CPU time on one thread, experiments/paper and docs/performance.md
  Case c;
  c.grain.radius = 5e-3;
  CHECK(std::abs(std::log2(3600 * estimate(c).hours / 15)) < 1);  // one bonded grain, 69 011 steps
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::bpm};
  c.sample.grains = 300;
  c.loading.wall_velocity = 5;
  c.loading.max_strain = 0.40;
  c.loading.unload_at = {};
  c.bpm.primaries = 200;
  c.time.step = 0.1e-6;
  CHECK(std::abs(std::log2(3600 * estimate(c).hours / 224)) < 1);
  c.experiment.model = GrainModel::mpm;
  c.loading.max_packing_fraction = 0.985;
  c.mpm.cells = 16;
  c.time.step = 5e-6;
  CHECK(std::abs(std::log2(3600 * estimate(c).hours / 116)) < 1);
  c.time.step = 0;
  c.mpm.integrator = Integrator::symplectic_euler;
  CHECK(std::abs(std::log2(3600 * estimate(c).hours / 189)) < 1);
}

TEST_CASE("memory and disk of many small bonded grains are within a factor of two of what a run took") {
  // peak and files of 100 000 grains of 7 primaries, one step, a release build
  Case c;
  c.experiment.loading = LoadingPath::compaction;
  c.bpm.primaries = 7;
  c.sample.grains = 100000;
  c.loading.max_strain = 1e-9;  // one step
  c.output.snapshots = 1;
  const Estimate e = estimate(c);
  CHECK(std::abs(std::log2(e.memory / 2017e6)) < 1);
  CHECK(std::abs(std::log2(e.disk / 453e6)) < 1);
}

TEST_CASE("the hours of elastic grains are within a factor of two of what they took at any speed") {
  // CPU time of 20 grains of 6 cells under a top wall to eps = 0.3, and of one of 16 cells between walls to
  // 0.1
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.mpm.cells = 6;
  c.loading.max_strain = 0.3;
  struct Measured {
    double speed, seconds;
  };
  for (const auto& [speed, seconds] : {Measured{5, 0.58}, {0.5, 1.3}, {1e-2, 5.3}, {1e-3, 5.8}}) {
    CAPTURE(speed);
    c.loading.wall_velocity = speed;
    CHECK(std::abs(std::log2(3600 * estimate(c).hours / seconds)) < 1);
  }
  c.experiment.loading = LoadingPath::diametral;
  c.mpm.cells = 16;
  c.loading.max_strain = 0.1;
  for (const double speed : {0.2, 1e-2, 1e-3, 1.67e-5}) {
    c.loading.wall_velocity = speed;
    CHECK(std::abs(std::log2(3600 * estimate(c).hours / 0.32)) < 1);
  }
}

TEST_CASE("a run writes no more snapshots than it has steps") {
  Case c;
  c.output.snapshots = 100000;
  c.loading.max_strain = 1e-5;  // few steps
  c.loading.unload_at = {};
  const Estimate few = estimate(c);
  CHECK(few.steps < 10);
  c.output.snapshots = static_cast<int>(few.steps);
  CHECK(few.disk == estimate(c).disk);
}

TEST_CASE("the memory of elastic grains is within a quarter of what runs took") {
  // some steps each: with the page and files for ParaView, and without them
  struct Measured {
    int grains, cells;
    Integrator integrator;
    bool files;
    double speed, bytes;
  };
  constexpr auto implicit = Integrator::backward_euler, explicit_steps = Integrator::symplectic_euler;
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  for (const auto& [grains, cells, integrator, files, speed, bytes] :
       {Measured{300, 8, implicit, true, 20, 125e6},
        {300, 8, explicit_steps, true, 20, 76e6},
        {1000, 4, implicit, true, 20, 107e6},
        {1000, 4, explicit_steps, true, 20, 65e6},
        {10, 24, implicit, true, 20, 68e6},
        {300, 16, implicit, false, 20, 264e6},
        {300, 16, implicit, false, 0.05, 407e6},
        {300, 8, implicit, false, 0.05, 106e6},
        {1200, 16, implicit, false, 20, 962e6},
        {1200, 16, explicit_steps, false, 20, 105e6}}) {
    CAPTURE(grains);
    CAPTURE(cells);
    CAPTURE(speed);
    CAPTURE(bytes);
    c.sample.grains = grains;
    c.mpm.cells = cells;
    c.mpm.integrator = integrator;
    c.output.vtk = c.output.report = files;
    c.loading.wall_velocity = speed;
    CHECK(std::abs(estimate(c).memory / bytes - 1) < 0.25);
  }
}

TEST_CASE("the memory of the first of four ranks is within a fifth of what it took") {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.mpm.cells = 16;
  c.output.vtk = c.output.report = false;
  c.loading.wall_velocity = 20;
  for (const auto& [grains, integrator, bytes] : {std::tuple{300, Integrator::backward_euler, 120e6},
                                                  {1200, Integrator::backward_euler, 336e6},
                                                  {300, Integrator::symplectic_euler, 67e6},
                                                  {1200, Integrator::symplectic_euler, 156e6}}) {
    CAPTURE(grains);
    CAPTURE(bytes);
    c.sample.grains = grains;
    c.mpm.integrator = integrator;
    CHECK(std::abs(estimate_on_ranks(c, estimate(c), 4).memory / bytes - 1) < 0.2);
  }
}

TEST_CASE("ranks gain what docs/scaling.md says, and no more than they have batches") {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::bpm};
  c.sample.grains = 304;
  struct Said {
    int ranks;
    double gain;
  };
  const auto check = [&](const Estimate& alone, std::initializer_list<Said> gains) {
    CHECK(estimate_on_ranks(c, alone, 1).hours == doctest::Approx(alone.hours).epsilon(1e-12));
    for (const auto& [ranks, said] : gains) {
      CAPTURE(ranks);
      CHECK(std::abs(alone.hours / estimate_on_ranks(c, alone, ranks).hours / said - 1) < 0.05);
    }
  };
  // the page's packings, by the CPU time of a step
  check({.particles = 60800, .steps = 1000, .hours = 11.4 / 3600}, {{2, 1.4}, {4, 1.8}, {8, 2.0}, {64, 2.2}});
  c.experiment.model = GrainModel::mpm;
  const Estimate implicit{.particles = 304 * 896, .steps = 1000, .hours = 63.9 / 3600};
  check(implicit, {{2, 1.6}, {4, 2.4}, {8, 3.2}, {64, 4.3}});
  CHECK(estimate_on_ranks(c, implicit, 64).useful == 38);
  c.mpm.integrator = Integrator::symplectic_euler;
  check({.particles = 304 * 896, .steps = 1000, .hours = 6.8 / 3600},
        {{2, 1.26}, {4, 1.53}, {8, 1.7}, {64, 1.8}});
  c.mpm.formulation = Formulation::updated_lagrangian;
  CHECK(estimate_on_ranks(c, implicit, 8).useful == 1);
}
