#pragma once
#include <unistd.h>

#include <cmath>
#include <memory>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/simulation.hpp"

namespace softgrain::test {

/// A ball that bounces on a floor, with everything that makes resuming hard: a mean since the last look, a
/// force that depends on the step before, and irrational numbers. Its checkpoint is exact.
class BouncingBall : public Simulation {
 public:
  int last_step = 400;
  double progress_at_end = 1;  ///< what round-off or an early end makes of it
  int turns_at = -1;           ///< step after which the load turns
  int breaks_at = -1;          ///< step that raises NumericalError
  useconds_t pause = 0;        ///< a step takes at least this long [us]

  bool finished() const override { return step_ >= last_step; }
  double progress() const override { return progress_at_end * static_cast<double>(step_) / last_step; }
  double time() const override { return 0.005 * static_cast<double>(step_); }
  double strain() const override { return 0; }
  std::int64_t steps_done() const override { return step_; }
  std::int64_t steps_planned() const override { return last_step; }
  bool at_turning_point() const override { return step_ == turns_at; }

  void follow(PlateMotion) override {}
  StepReport step() override {
    if (step_ == breaks_at) throw NumericalError("position of particle 0 is not finite");
    if (pause > 0) usleep(pause);
    ++step_;
    velocity_ -= 0.005 * 9.81;
    height_ += 0.005 * velocity_;
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

  std::vector<Quantity> observe() override {
    const double mean = height_count_ > 0 ? height_sum_ / static_cast<double>(height_count_) : height_;
    height_sum_ = 0;
    height_count_ = 0;
    return {{"step", "", static_cast<double>(step_)}, {"time", "s", time()}, {"mean_height", "m", mean}};
  }

  std::vector<GrainView> grains() const override { return {}; }
  Scene scene() const override {
    Scene scene;
    scene.particles["position"] = {2, std::vector<double>{0, height_ + 0.1}};
    scene.particles["radius"] = {1, std::vector<double>{0.1}};
    scene.contacts["pair"] = {2, std::vector<std::int64_t>{}};
    scene.contacts["force"] = {1, std::vector<double>{}};
    scene.wall_segments = {-1, 0, 1, 0};
    return scene;
  }

  Checkpoint checkpoint() const override {
    Checkpoint state{.step = step_, .time = time(), .arrays = {}};
    state.arrays["ball"] = {2, std::vector<double>{height_, velocity_}};
    state.arrays["height_sum"] = {1, std::vector<double>{height_sum_}};
    state.arrays["height_count"] = {1, std::vector<std::int64_t>{height_count_}};
    return state;
  }

  void restore(const Checkpoint& state) override {
    step_ = state.step;
    const auto& ball = std::get<std::vector<double>>(state.arrays.at("ball").values);
    height_ = ball.at(0);
    velocity_ = ball.at(1);
    height_sum_ = std::get<std::vector<double>>(state.arrays.at("height_sum").values).at(0);
    height_count_ = std::get<std::vector<std::int64_t>>(state.arrays.at("height_count").values).at(0);
  }

 private:
  std::int64_t step_ = 0;
  double height_ = 1, velocity_ = 0, height_sum_ = 0;
  std::int64_t height_count_ = 0;
};

}  // namespace softgrain::test
