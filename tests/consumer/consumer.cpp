// A block of 2 kg meets the floor at 1 m/s while it slides at 3 m/s; with mu = 0.5 friction takes 0.5 m/s of
// that.
#include <cstdio>
#include <vector>

#include "softgrain/contact/delassus_system.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/version.hpp"

using namespace softgrain;

int main() {
  const double mass = 2;
  const std::vector<MatrixEntry> W{{0, 0, 1 / mass}, {1, 1, 1 / mass}};
  const std::vector<Vec<2>> free_velocity{{-1, 3}};
  DelassusSystem<2> system(W, free_velocity);
  std::vector<Vec<2>> impulse(1);
  const std::vector<double> friction{0.5};
  const SolverReport report = solve_nlgs<2>(system, impulse, friction, {});
  const Vec<2> u = system.relative_velocity(0);
  std::printf("softgrain %s: p = (%g, %g) N s, u = (%g, %g) m/s\n", build_info().version, impulse[0][0],
              impulse[0][1], u[0], u[1]);
  return report.converged ? 0 : 1;
}
