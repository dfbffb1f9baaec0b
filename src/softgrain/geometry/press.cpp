#include "softgrain/geometry/press.hpp"

namespace softgrain {
namespace {

/// Times tau before it has its stress, at the rate of the step, a press brakes.
constexpr double braking = 5;
/// Times tau over which its speed is averaged.
constexpr double averaging = 10;

}  // namespace

double Press::mobility(double dt) const { return 1 / (mass + dt * faded_damper()); }

void Press::end_step(double v, double impulse, double dt) {
  const double lack_before = force - mean_force;
  speed = v;
  mean_force += dt / (dt + time()) * (impulse / dt - mean_force);
  const double lack = force - mean_force;
  const bool arrives = lack > 0 && lack < braking * time() * (lack_before - lack) / dt;
  waiting = lack_before * lack > 0 && !arrives ? waiting + dt : waiting / 2;
  mean_speed = arrives ? 0 : mean_speed + dt / (dt + averaging * time()) * (v - mean_speed);
}

}  // namespace softgrain
