#include "softgrain/geometry/press.hpp"

#include <cmath>

namespace softgrain {
namespace {

/// Times tau before it gets there, at the rate of the step, a press brakes.
constexpr double braking = 5;

}  // namespace

double Press::mobility(double dt) const { return 1 / (mass + dt * damper / (1 + waiting / time())); }

void Press::end_step(double v, double impulse, double dt) {
  const double lack_before = force - mean_force;
  speed = v;
  mean_force += dt / (dt + time()) * (impulse / dt - mean_force);
  const double lack = force - mean_force, gain = (lack_before - lack) / dt * std::copysign(1.0, lack);
  const bool waits = lack_before * lack > 0 && std::abs(lack) > braking * time() * gain;
  waiting = waits ? waiting + dt : waiting / 2;
}

}  // namespace softgrain
