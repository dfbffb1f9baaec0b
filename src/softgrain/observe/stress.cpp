#include "softgrain/observe/stress.hpp"

namespace softgrain {

std::vector<double> virial_pressure(std::span<const BranchForce> forces, std::span<const double> area) {
  std::vector<double> pressure(area.size(), 0);
  for (const BranchForce& f : forces) {
    if (f.a >= 0) pressure[f.a] += dot(f.force, f.branch_a) / (2 * area[f.a]);  // the force on a is -f
    if (f.b >= 0) pressure[f.b] -= dot(f.force, f.branch_b) / (2 * area[f.b]);
  }
  return pressure;
}

}  // namespace softgrain
