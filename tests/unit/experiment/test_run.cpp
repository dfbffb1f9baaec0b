#include <doctest/doctest.h>

#include <string>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/run.hpp"
#include "support/fake_simulation.hpp"

using namespace softgrain;

namespace {

/// Step k takes k sweeps, has the residual 1/k and the overlap 0.1 k; every third one converges.
class Countdown final : public test::FakeModel {
 public:
  explicit Countdown(int breaks_at = 0) : breaks_at_(breaks_at) {}
  std::unique_ptr<Model> copy() const override { return std::make_unique<Countdown>(*this); }
  StepReport step(Box<2>&, double) override {
    const int k = ++done_;
    if (k == breaks_at_) throw NumericalError("too fast");
    return {.sweeps = k, .residual_max = 1.0 / k, .overlap_max = 0.1 * k, .converged = k % 3 == 0};
  }

 private:
  int breaks_at_, done_ = 0;
};

Simulation countdown(int breaks_at = 0) {
  return test::at_rest(std::make_unique<Countdown>(breaks_at), 10, 1);
}

/// Stops the run after a step.
struct StopAfter final : Recorder {
  explicit StopAfter(std::int64_t last_step) : last(last_step) {}
  bool after_step(AnySimulation& simulation, const StepReport& step, RunReport& run) override {
    CHECK(step.sweeps == simulation.steps_done());
    seen = run;
    return simulation.steps_done() < last;
  }
  std::int64_t last;
  RunReport seen;
};

}  // namespace

TEST_CASE("a run goes on until the simulation is finished and sums up its steps") {
  Simulation simulation = countdown();
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
  Simulation simulation = countdown(7);
  StopAfter recorder(100);
  CHECK_THROWS_WITH_AS(run(simulation, recorder), "step 7: too fast", NumericalError);
}

TEST_CASE("the recorder stops a run, which goes on later where it stopped") {
  Simulation simulation = countdown();
  StopAfter first(4), second(100);
  const RunReport half = run(simulation, first);
  CHECK(half.steps == 4);
  const RunReport whole = run(simulation, second, half);
  CHECK(whole.steps == 10);
  CHECK(whole.sweeps == 55);
}

TEST_CASE("a finished simulation makes no step") {
  Simulation simulation = countdown();
  StopAfter recorder(100);
  run(simulation, recorder);
  CHECK(run(simulation, recorder).steps == 0);
}
