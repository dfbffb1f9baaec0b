#include "softgrain/geometry/press.hpp"

namespace softgrain {

double Press::mobility(double dt) const { return 1 / (mass + dt * damper / (1 + waiting / time())); }

void Press::end_step(double v, double impulse, double dt) {
  const double lack = force - mean_force;
  speed = v;
  mean_force += dt / (dt + time()) * (impulse / dt - mean_force);
  waiting = lack * (force - mean_force) > 0 ? waiting + dt : waiting / 2;
}

}  // namespace softgrain
