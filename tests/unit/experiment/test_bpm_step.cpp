#include "softgrain/experiment/bpm_step.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/advice.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/run.hpp"
#include "support/simulations.hpp"

using namespace softgrain;

namespace {

Case packing() {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::bpm};
  c.bpm.primaries = 200;
  return c;
}

/// What a run with the stable step reached.
struct Quality {
  double converged = 0, overlap_max = 0, steps = 0;
};
Quality quality_of(const Case& c) {
  Simulation grain = test::simulation_of(c);
  Quality quality;
  while (!grain.finished()) {
    const StepReport report = grain.step();
    quality.converged += report.converged ? 1 : 0;
    quality.overlap_max = std::max(quality.overlap_max, report.overlap_max);
    ++quality.steps;
  }
  quality.converged /= quality.steps;
  return quality;
}

}  // namespace

TEST_CASE("the paper's grain gets the step of 0.25 us, its packing about the paper's 0.1 us") {
  CHECK(stable_bond_step(Case{}) == 0.25e-6);
  CHECK(stable_bond_step(packing()) == doctest::Approx(0.1e-6).epsilon(0.05));
}

TEST_CASE("the step follows sqrt(m a0/F0): by size, density, attraction, exponent and number of primaries") {
  const Case paper;
  const auto scaled = [&](auto change) {
    Case c = paper;
    change(c);
    return stable_bond_step(c) / stable_bond_step(paper);
  };
  CHECK(scaled([](Case& c) { c.grain.radius /= 100; }) == doctest::Approx(1e-3));  // m ~ R^2, a0 ~ R
  CHECK(scaled([](Case& c) { c.grain.density *= 4; }) == doctest::Approx(2));
  CHECK(scaled([](Case& c) { c.bpm.attraction *= 4; }) == doctest::Approx(0.5));
  CHECK(scaled([](Case& c) { c.bpm.exponent = 28; }) == doctest::Approx(0.5));
  CHECK(scaled([](Case& c) { c.bpm.primaries *= 16; }) == doctest::Approx(1.0 / 8));  // m ~ 1/N, a0 ~ N^-1/2
  CHECK(scaled([](Case& c) { c.loading.wall_velocity = 1000; }) <
        0.01);  // the wall takes no primary by surprise
  CHECK(scaled([](Case& c) { c.loading.hold = 1; }) == 1);
  Case half = packing();
  half.sample.smallest_diameter /= 2;
  CHECK(stable_bond_step(half) / stable_bond_step(packing()) == doctest::Approx(0.5));  // F0 ~ size there
}

TEST_CASE("the period is that of the smallest primaries that a grain really has, within a few per cent") {
  Case c;
  c.bpm.primaries = 400;
  const Simulation grain = test::simulation_of(c);
  const auto& p = test::bonded(grain).particles;
  const auto smallest = std::min_element(p.radius.begin(), p.radius.end()) - p.radius.begin();
  const double m = p.mass[smallest], a0 = 2 * p.radius[smallest];
  const double period = 2 * std::numbers::pi * std::sqrt(m * a0 / (2 * c.bpm.exponent * c.bpm.attraction));
  CHECK(bond_period(c) == doctest::Approx(period).epsilon(0.1));
  CHECK(critical_bond_step(c) == doctest::Approx(bond_period(c) / std::numbers::pi));
}

TEST_CASE("check is told that the stable step is 7 % of the critical one, and how much a given step is") {
  Case c;
  CHECK(advise(c).time_step / advise(c).longest_step == doctest::Approx(std::numbers::pi / 43).epsilon(0.01));
  c.time.step = 0.5e-6;
  CHECK(advise(c).time_step / advise(c).longest_step ==
        doctest::Approx(2 * std::numbers::pi / 43).epsilon(0.01));
}

TEST_CASE("a grain of 50 um and one of weak bonds are computed as well as the paper's, with no step given") {
  Case c;
  c.bpm.primaries = 60;
  c.loading.max_strain = 0.05;
  const Quality paper = quality_of(c);
  Case small = c;
  small.grain.radius = 50e-6;
  Case weak = c;
  weak.bpm.attraction = 1;
  for (const Case& other : {small, weak}) {
    const Quality quality = quality_of(other);
    CHECK(quality.converged > paper.converged - 0.05);
    CHECK(quality.converged > 0.9);
    CHECK(quality.overlap_max < 5e-3);
  }
}

TEST_CASE("time.step = 0 is the stable step, to the bit") {
  Case automatic;
  automatic.bpm.primaries = 30;
  Case given = automatic;
  given.time.step = stable_bond_step(given);
  Simulation a = test::simulation_of(automatic), b = test::simulation_of(given);
  for (int step = 0; step < 20; ++step) a.step(), b.step();
  CHECK(a.time() == 20 * given.time.step);
  CHECK((a.checkpoint().arrays.at("position").values == b.checkpoint().arrays.at("position").values));
  CHECK(estimate(automatic).steps == estimate(given).steps);
}

TEST_CASE(
    "overlaps beyond a twentieth in the mean or a half at one contact break down, whatever ends the run") {
  for (const bool stops_by_overlap : {false, true}) {
    Case c = packing();
    c.bpm.primaries = 19;
    c.bpm.library = 1;
    c.sample.grains = 6;
    c.sample.packing_fraction = 0.6;
    c.loading = {.wall_velocity = 2000, .max_strain = 2.9};  // the top wall closes the box in a few steps
    c.time.step = 0.2e-6;
    if (stops_by_overlap) c.loading.max_overlap = 0.05;
    Simulation simulation = test::simulation_of(c);
    CHECK_THROWS_AS(
        {
          while (!simulation.finished()) simulation.step();
        },
        NumericalError);
  }
}
