#pragma once
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A force between two bodies: the force of a on b [N/m], and the branches from the centres to the point
/// where it acts [m].
struct BranchForce {
  int a = 0, b = 0;  ///< indices of particles; -1 for a body whose stress is not asked for (a wall)
  Vec<2> force;      ///< on b; -force acts on a
  Vec<2> branch_a, branch_b;
};

/// Pressure of each particle from the virial of its forces (Love-Weber), compression positive:
///   p_i = -(1/2 A_i) sum_c f_c . l_c  [Pa], with f_c the force on i and l_c from its centre to where the
///   force acts.
std::vector<double> virial_pressure(std::span<const BranchForce> forces, std::span<const double> area);

}  // namespace softgrain
