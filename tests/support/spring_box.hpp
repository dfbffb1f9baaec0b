#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "softgrain/experiment/stages_of_case.hpp"
#include "softgrain/loading/loading.hpp"
#include "support/fake_simulation.hpp"

namespace softgrain::test {

/// A box 20 mm wide and high.
inline Box<2> square_box(double side = 20e-3) {
  return Box<2>(
      {{{0, 0}, {0, 1}, {}}, {{0, side}, {0, -1}, {}}, {{0, 0}, {1, 0}, {}}, {{side, 0}, {-1, 0}, {}}});
}

/// A spring along each axis of a box, sigma_k = K_k eps_k; presses obey their equation, with the force at the
/// end of the step, by bisection.
class SpringModel final : public FakeModel {
 public:
  explicit SpringModel(double stiffness) : stiffness_{stiffness, stiffness} {}
  std::unique_ptr<Model> copy() const override { return std::make_unique<SpringModel>(*this); }

  std::array<double, 2> stiffness_;  ///< x, y [Pa]
  std::array<double, 2> loss{};      ///< of the stress, x, y [Pa]
  PressBody body{.mass = 5, .damper = 1e5};
  Energies energy{};

  PressBody press_body(const Box<2>&, int, double) const override { return body; }
  Energies energies() const override { return energy; }

  StepReport step(Box<2>& box, double dt) override {
    if (start_[0] == 0) start_ = {box.width(), box.height()};
    for (Press& press : box.presses) solve(press, box, dt);
    for (Wall<2>& wall : box.walls) wall.point += dt * wall.velocity;
    const std::array<double, 2> length{box.width(), box.height()};
    for (std::size_t w = 0; w < box.walls.size(); ++w)
      box.impulse[w] = -force(length, w <= top_wall ? 1 : 0) * dt * box.walls[w].normal;
    return {};
  }
  void visit(StateVisitor& visit) override {
    visit({"spring_x", "m", Owner::run, Role::state, ""}, start_[0]);
    visit({"spring_y", "m", Owner::run, Role::state, ""}, start_[1]);
  }

 private:
  /// On a wall across an axis, outwards [N/m].
  double force(const std::array<double, 2>& length, std::size_t axis) const {
    return length[1 - axis] * (stiffness_[axis] * std::log(start_[axis] / length[axis]) - loss[axis]);
  }
  /// sum_w share_w f_w of a press in a box whose walls have moved for dt.
  double felt(const Press& press, const std::array<double, 2>& length) const {
    return (press.share[2] + press.share[3]) * force(length, 0) +
           (press.share[0] + press.share[1]) * force(length, 1);
  }
  void solve(Press& press, Box<2>& box, double dt) const {
    const auto after = [&](double v) {
      const double x = press.share[2] + press.share[3], y = press.share[0] + press.share[1];
      return std::array<double, 2>{box.width() - dt * x * v, box.height() - dt * y * v};
    };
    double high = std::min(press.most, 1e3), low = -high;
    for (int k = 0; k < 50; ++k) {
      const double v = (low + high) / 2;
      const double free = press.free_speed(dt) - dt * felt(press, after(v)) * press.mobility(dt);
      (free > v ? low : high) = v;
    }
    const double v = (low + high) / 2;
    for (std::size_t w = 0; w < 4; ++w)
      if (press.share[w] != 0) box.walls[w].velocity = press.share[w] * v * box.walls[w].normal;
    press.end_step(v, dt * felt(press, after(v)), dt);
  }

  std::array<double, 2> start_{};
};

/// A loading that a spring follows.
struct SpringRun {
  Loading loading;
  SpringModel model;
  double dt;
  Box<2> box = square_box();
  std::int64_t steps = 0;
  StepFelt felt{};

  double time() const { return static_cast<double>(steps) * dt; }
  void step() {
    loading.drive(box, model, time(), dt);
    model.step(box, dt);
    ++steps;
    loading.after_step(box, time(), dt, felt);
  }
  void finish() {
    while (!loading.finished() && steps < 10'000'000) step();
  }
  /// Steps to the end of the present stage.
  void finish_stage() {
    do step();
    while (!loading.finished() && !loading.at_turning_point());
  }
  /// Of the pair along an axis, in the last step [Pa].
  double stress(int axis) const {
    const std::size_t wall = axis == 1 ? 0 : 2;
    return (box.outward_impulse(wall) + box.outward_impulse(wall + 1)) /
           (2 * dt * box.volume() / box.length(axis));
  }
};

constexpr double v = 2, dt = 1e-6, target = 1e6;  // of walls, steps and stresses

inline SpringRun run_of(const std::vector<Stage>& stages, double stiffness = 10 * target) {
  const Box<2> box = square_box();
  const LoadingFrame frame{.measure = {}, .wall_velocity = v, .packing_fraction = 0.6};
  return {.loading = Loading(stages, frame, box), .model = SpringModel(stiffness), .dt = dt};
}

inline SpringRun run_of(const Case::Loading& keys, LoadingPath path = LoadingPath::compaction,
                        double stiffness = 10 * target) {
  Case c;
  c.experiment.loading = path;
  c.loading = keys;
  c.sample.packing_fraction = 0.6;
  check_loading(c);
  return {
      .loading = Loading(stages_of(c), frame_of(c), square_box()), .model = SpringModel(stiffness), .dt = dt};
}

inline Drive moves(Part part, double velocity) {
  return {.part = part, .control = Control::velocity, .value = velocity};
}
inline Drive keeps(Part part, double stress) {
  return {.part = part, .control = Control::stress, .value = stress};
}

inline Until until_strain(double strain) {
  Until until;
  until.strain[0] = strain;
  return until;
}
inline Until until_stress(Part part, double stress) {
  Until until;
  until.stress[static_cast<std::size_t>(part)] = stress;
  return until;
}

inline double strain_xx(const Box<2>& box) { return std::log(square_box().width() / box.width()); }

}  // namespace softgrain::test
