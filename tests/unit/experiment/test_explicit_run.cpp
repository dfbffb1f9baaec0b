#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "support/simulations.hpp"

using namespace softgrain;
using test::advance;
using test::value_of;

namespace {

Case squeezed_grain(int cells, double speed) {
  Case c;
  c.experiment = {.loading = LoadingPath::diametral, .model = GrainModel::mpm};
  c.mpm.cells = cells;
  c.mpm.integrator = Integrator::symplectic_euler;
  c.loading = {.wall_velocity = speed, .max_strain = 1.5};
  return c;
}

}  // namespace

TEST_CASE("an explicit grain is squeezed to strain 1.5 without energy from nothing") {
  for (const double speed : {2.0, 20.0}) {
    CAPTURE(speed);
    const auto simulation = create_simulation(squeezed_grain(4, speed));
    double taken = 0;  // by contacts and integration
    while (!simulation->finished()) {
      advance(*simulation, 20);
      const auto row = test::next_row(*simulation);
      const double dissipation = value_of(row, "dissipation"), work = value_of(row, "wall_work");
      CHECK(dissipation > taken - 1e-3 * work);
      taken = std::max(taken, dissipation);
      CHECK(std::abs(value_of(row, "energy_error")) < 1e-9 * (work + 1e-9));
      CHECK(value_of(row, "least_J") > 0);
    }
    const auto end = test::next_row(*simulation);
    CHECK(value_of(end, "strain") == doctest::Approx(1.5).epsilon(0.01));
    // the law alone: at strain 1.5 a grain between walls of 0.446 R is no thinner than their distance
    CHECK(value_of(end, "elastic_energy") > 700);
    CHECK(value_of(end, "dissipation") < 0.02 * value_of(end, "wall_work"));
  }
}

TEST_CASE("an explicit run whose steps are divided goes on from a checkpoint with the same bits") {
  const Case c = squeezed_grain(3, 10);
  const auto whole = create_simulation(c);
  while (whole->strain() < 1.3) whole->step();
  CHECK(value_of(test::next_row(*whole), "iterations") > 1);  // sub-steps
  advance(*whole, 3);
  const Checkpoint half = whole->checkpoint();
  const auto resumed = create_simulation(c);
  resumed->restore(half);
  advance(*whole, 15), advance(*resumed, 15);
  const Checkpoint a = whole->checkpoint(), b = resumed->checkpoint();
  CHECK(a.step > half.step + 10);
  for (const auto& [name, array] : a.arrays) {
    CAPTURE(name);
    CHECK((array.values == b.arrays.at(name).values));
  }
  Checkpoint changed = half;
  changed.arrays["until_look"] = {1, std::vector<std::int64_t>{-1}};
  CHECK_THROWS_AS(resumed->restore(changed), IoError);
}

TEST_CASE("an explicit time step up to the longest stable one runs, a longer one is refused with it") {
  Case c = squeezed_grain(4, 2);
  const double longest = longest_time_step(c);
  CHECK(longest > create_simulation(c)->time());
  c.time.step = longest;
  CHECK_NOTHROW(create_simulation(c)->step());
  c.time.step = 1.001 * longest;
  CHECK_THROWS_WITH_AS(create_simulation(c), doctest::Contains("or \"auto\""), UsageError);
  c.experiment.loading = LoadingPath::isotropic;  // the smallest grain that the case allows
  c.time.step = 1.001 * longest * c.sample.smallest_diameter / 2 / c.grain.radius;
  CHECK_THROWS_AS(check_time_step(c), UsageError);
  c.time.step = 0.999 * longest * c.sample.smallest_diameter / 2 / c.grain.radius;
  CHECK_NOTHROW(check_time_step(c));
  c.mpm.integrator = Integrator::backward_euler;
  c.time.step = 1;
  CHECK_NOTHROW(check_time_step(c));
}

TEST_CASE("the residual of an explicit step is the one that its contact solver measured") {
  Case c = squeezed_grain(8, 2);
  const auto simulation = create_simulation(c);
  double worst = 0;
  for (int step = 0; step < 400; ++step) {
    const StepReport report = simulation->step();
    CHECK(report.residual_limit == doctest::Approx(16 * 4.5e-6));
    CHECK(report.converged ==
          (report.residual_max <= report.residual_limit && report.residual_mean <= 4.5e-6));
    worst = std::max(worst, report.residual_max);
  }
  CHECK(worst > 1e-12);
}
