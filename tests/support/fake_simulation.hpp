#pragma once
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <memory>
#include <utility>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/simulation.hpp"

namespace softgrain::test {

/// A model without grains, to derive from.
class FakeModel : public Model {
 public:
  void visit(StateVisitor&) override {}
  double density() const override { return 1; }
  std::vector<double> radii() const override { return {}; }
  std::vector<Vec<2>> centres() const override { return {}; }
  Bodies bodies() const override { return {}; }
  std::vector<ContactPoint> contacts() const override { return {}; }
  Outlines outlines() const override { return {}; }
  std::pair<double, double> extent(int /*axis*/) const override { return {0, 1}; }
  Energies energies() const override { return {}; }
  Numbers numbers(const Box<2>&, const Energies&) const override { return {}; }
  Scene scene(const Box<2>&) const override { return {}; }
  std::pair<double, double> reach() const override { return {-1, 1}; }
  std::vector<GrainView> grains() const override { return {}; }
};

/// Between two walls that rest for so many steps of dt [s]; after `turn` of them, if any, the load turns.
inline Simulation at_rest(std::unique_ptr<Model> model, int steps, double dt, int turn = 0) {
  const Box<2> box({{.point = {0, 0}, .normal = {0, 1}, .velocity = {}},
                    {.point = {0, 1}, .normal = {0, -1}, .velocity = {}}});
  std::vector<Stage> stages;
  if (turn > 0) stages.push_back({.until = {.time = turn * dt}});
  stages.push_back({.until = {.time = (steps - turn) * dt}});
  return {std::move(model), box, Loading(stages, {}, box), dt};
}

/// A ball that bounces on a floor, with everything that makes resuming hard: a mean since the last row, in
/// the column width, a force that depends on the step before, and irrational numbers. Its state is exact.
struct BouncingBall {
  int last_step = 400;
  int turns_at = 0;                 ///< step after which the load turns; 0: none
  int breaks_at = -1;               ///< step that raises NumericalError
  int signals_at = -1, signal = 0;  ///< before this step the process signals itself
  useconds_t pause = 0;             ///< a step takes at least this long [us]

  Simulation simulation() const;
};

class BouncingBallModel final : public FakeModel {
 public:
  explicit BouncingBallModel(const BouncingBall& ball) : ball_(ball) {}
  std::unique_ptr<Model> copy() const override { return std::make_unique<BouncingBallModel>(*this); }

  StepReport step(Box<2>&, double dt) override {
    if (step_ == ball_.breaks_at) throw NumericalError("position of particle 0 is not finite");
    if (step_ == ball_.signals_at) std::raise(ball_.signal);
    if (ball_.pause > 0) usleep(ball_.pause);
    ++step_;
    velocity_ -= dt * 9.81;
    height_ += dt * velocity_;
    const bool hits = height_ < 0 && velocity_ < 0;
    if (hits) velocity_ *= -0.9;
    height_sum_ += height_;
    ++height_count_;
    const int sweeps = 1 + static_cast<int>(step_ % 7);
    const double residual = 1e-6 / 3 * static_cast<double>(1 + step_ % 11);
    return {.contacts = hits ? 1 : 0,
            .sweeps = sweeps,
            .residual_mean = residual,
            .residual_max = 2 * residual,
            .overlap_mean = 1e-3 * std::fabs(height_) / 7,
            .overlap_max = 1e-3 * std::fabs(height_),
            .converged = step_ % 50 != 0};
  }
  std::pair<double, double> extent(int /*axis*/) const override {
    return {0, height_count_ > 0 ? height_sum_ / static_cast<double>(height_count_) : height_};
  }
  void begin_row() override {
    height_sum_ = 0;
    height_count_ = 0;
  }
  Scene scene(const Box<2>&) const override {
    Scene scene;
    scene.particles["position"] = {2, std::vector<double>{0, height_ + 0.1}};
    scene.particles["radius"] = {1, std::vector<double>{0.1}};
    scene.contacts["pair"] = {2, std::vector<std::int64_t>{}};
    scene.contacts["force"] = {1, std::vector<double>{}};
    return scene;
  }
  void visit(StateVisitor& visit) override {
    visit({"ball_height", "m", Owner::body, Role::state, ""}, height_);
    visit({"ball_velocity", "m/s", Owner::body, Role::state, ""}, velocity_);
    visit({"ball_height_sum", "m", Owner::body, Role::sum, ""}, height_sum_);
    visit({"ball_height_count", "", Owner::body, Role::sum, ""}, height_count_);
    visit({"ball_step", "", Owner::body, Role::state, ""}, step_);
  }

 private:
  BouncingBall ball_;
  std::int64_t step_ = 0;
  double height_ = 1, velocity_ = 0, height_sum_ = 0;
  std::int64_t height_count_ = 0;
};

inline Simulation BouncingBall::simulation() const {
  return at_rest(std::make_unique<BouncingBallModel>(*this), last_step, 0.005, turns_at);
}

}  // namespace softgrain::test
