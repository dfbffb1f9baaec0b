#include <doctest/doctest.h>

#include <string>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/run.hpp"

using namespace softgrain;

namespace {

/// Ten steps; step k takes k sweeps, has the residual 1/k and the overlap 0.1 k; every third one converges.
class Countdown : public Simulation {
 public:
  bool finished() const override { return done_ == 10; }
  double progress() const override { return static_cast<double>(done_) / 10; }
  double time() const override { return static_cast<double>(done_); }
  double strain() const override { return 0; }
  std::int64_t steps_done() const override { return done_; }
  std::int64_t steps_planned() const override { return 10; }
  bool at_turning_point() const override { return false; }
  void follow(PlateMotion) override {}
  StepReport step() override {
    const int k = static_cast<int>(++done_);
    return {.sweeps = k, .residual_max = 1.0 / k, .overlap_max = 0.1 * k, .converged = k % 3 == 0};
  }
  std::vector<Quantity> observe() override { return {}; }
  Scene scene() const override { return {}; }
  std::vector<GrainView> grains() const override { return {}; }
  Checkpoint checkpoint() const override { return {}; }
  void restore(const Checkpoint&) override {}

 private:
  std::int64_t done_ = 0;
};

/// Stops the run after a step.
struct StopAfter final : Recorder {
  explicit StopAfter(std::int64_t last_step) : last(last_step) {}
  bool after_step(Simulation& simulation, const StepReport& step, RunReport& run) override {
    CHECK(step.sweeps == simulation.steps_done());
    seen = run;
    return simulation.steps_done() < last;
  }
  std::int64_t last;
  RunReport seen;
};

}  // namespace

TEST_CASE("a run goes on until the simulation is finished and sums up its steps") {
  Countdown simulation;
  StopAfter recorder(100);
  const RunReport report = run(simulation, recorder);
  CHECK(report.steps == 10);
  CHECK(report.steps_converged == 3);
  CHECK(report.sweeps == 55);
  CHECK(report.residual_max == 1);
  CHECK(report.overlap_max == 1);
  CHECK(recorder.seen.sweeps == 55);
}

TEST_CASE("an error of the numbers tells the step in which they broke down") {
  struct Broken : Countdown {
    StepReport step() override {
      if (steps_done() == 6) throw NumericalError("too fast");
      return Countdown::step();
    }
  } simulation;
  StopAfter recorder(100);
  CHECK_THROWS_WITH_AS(run(simulation, recorder), "step 7: too fast", NumericalError);
}

TEST_CASE("the recorder stops a run, which goes on later where it stopped") {
  Countdown simulation;
  StopAfter first(4), second(100);
  const RunReport half = run(simulation, first);
  CHECK(half.steps == 4);
  const RunReport whole = run(simulation, second, half);
  CHECK(whole.steps == 10);
  CHECK(whole.sweeps == 55);
}

TEST_CASE("a finished simulation makes no step") {
  Countdown simulation;
  StopAfter recorder(100);
  run(simulation, recorder);
  CHECK(run(simulation, recorder).steps == 0);
}
