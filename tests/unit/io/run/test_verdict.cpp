#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/io/run/verdict.hpp"

using namespace softgrain;

namespace {

/// A good run of 30 012 steps.
RunReport good() {
  RunReport report{.steps = 30012,
                   .steps_converged = 30012,
                   .sweeps = 1,
                   .residual_max = 3e-5,
                   .residual_limit = 1.6e-4,
                   .overlap_max = 2e-5};
  report.energy = {.error = 6e-6, .scale = 1};
  return report;
}

}  // namespace

TEST_CASE("the verdict says 100 % only when every step converged") {
  RunReport report = good();
  CHECK(verdict_of(report).words ==
        "converged 100.0 % of 30 012 steps, worst residual 3e-05 (limit 2e-04), worst overlap 2e-05 of a "
        "radius, "
        "energy balanced to 6e-06");
  report.steps_converged = 30011;
  CHECK(verdict_of(report).words.starts_with("converged 99.9 % of 30 012 steps"));
  CHECK(verdict_of(report).doubts.empty());
}

TEST_CASE("the verdict gives no number that was not measured") {
  RunReport report = good();
  report.residual_limit = 0;
  report.energy = {};
  CHECK(verdict_of(report).words == "converged 100.0 % of 30 012 steps, worst overlap 2e-05 of a radius");
  CHECK(verdict_of({}).words == "no step was made");
}

TEST_CASE("each number beyond its limit is a doubt of its own, in the words too") {
  const auto doubt = [](const auto& spoil) {
    RunReport report = good();
    spoil(report);
    const Verdict verdict = verdict_of(report);
    REQUIRE(verdict.doubts.size() == 1);
    CHECK(verdict.words.ends_with("; DO NOT TRUST IT: " + verdict.doubts.front()));
    return verdict.doubts.front();
  };
  CHECK(doubt([](RunReport& r) { r.steps_converged = 15000; }) ==
        "only 49.9 % of the steps converged (least 50 %)");
  CHECK(doubt([](RunReport& r) { r.overlap_max = 0.51; }) == "an overlap of 0.51 of a radius (largest 0.05)");
  CHECK(doubt([](RunReport& r) { r.residual_max = 0.3; }) == "a residual of 0.3 (largest 0.05)");
  CHECK(doubt([](RunReport& r) { r.energy.error = 0.2; }) ==
        "energy out of balance by 0.2 of its largest (largest 0.02)");
  for (const double nan = std::nan("");
       double RunReport::*number : {&RunReport::overlap_max, &RunReport::residual_max})
    doubt([&](RunReport& r) { r.*number = nan; });
  doubt([](RunReport& r) { r.energy.error = std::nan(""); });
}

TEST_CASE(
    "a path that was not completed is a doubt, whatever the numbers are; a completed one may have a "
    "shortfall") {
  const std::string why = "loading.hold_stress of 1e+08 Pa was not reached";
  const Verdict held = verdict_of(good(), {.completed = false, .shortfall = why});
  CHECK(held.words.ends_with("; NOT REACHED: " + why));
  CHECK(held.doubts == std::vector<std::string>{"not reached: " + why});
  const Verdict pressed = verdict_of(good(), {.completed = true, .shortfall = why});
  CHECK(pressed.words.ends_with("; NOT REACHED: " + why));
  CHECK(pressed.doubts.empty());
}

TEST_CASE("energy that comes from nothing is an error of the balance, also where the budget closes") {
  EnergyBalance energy;
  energy.add({.kinetic = 0.3, .stored = -1.2, .dissipation = -0.28, .error = 1e-9});
  CHECK(energy.imbalance() == doctest::Approx(0.28 / 1.2));
  energy.add({.wall_work = 5, .dissipation = 3, .error = -0.5});
  CHECK(energy.imbalance() == doctest::Approx(0.1));
}

TEST_CASE("what may help names the key that acts on the number beyond its limit, and what it is now") {
  Case elastic, bonded;
  elastic.experiment.model = GrainModel::mpm;
  elastic.mpm.tolerance = 3e-4;
  bonded.experiment.model = GrainModel::bpm;
  bonded.solver.max_sweeps = 70;
  CHECK(remedies_of(good(), elastic).empty());
  RunReport report = good();
  report.energy.error = 0.2;
  CHECK(remedies_of(report, elastic) ==
        std::vector<std::string>{"energy: a smaller mpm.tolerance (0.0003 now)"});
  CHECK(remedies_of(report, bonded) == std::vector<std::string>{"energy: a smaller time.step"});
  elastic.mpm.integrator = Integrator::symplectic_euler;
  CHECK(remedies_of(report, elastic) == std::vector<std::string>{"energy: a smaller time.step"});
  report = good();
  report.steps_converged = 15000, report.overlap_max = 0.51, report.residual_max = 0.3;
  CHECK(remedies_of(report, bonded) ==
        std::vector<std::string>{
            "steps that do not converge: a larger solver.max_sweeps (70 now) or a smaller time.step",
            "overlaps: slower walls or a smaller time.step"});
}
