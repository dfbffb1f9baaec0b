#pragma once
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"
#include "softgrain/observe/contact_network.hpp"

namespace softgrain {

/// How the contacts between grains are oriented (theory (64)).
struct Fabric {
  Mat<2> tensor;         ///< 1/N_pairs sum n (x) n, trace 1; zero without pairs
  double anisotropy = 0; /**< a = 2 (F_1 - F_2) of its eigenvalues: the density of normals is about
                              (1 + a cos 2(theta - theta_c))/(2 pi) */
  double direction = 0;  ///< theta_c, of most normals, in (-pi/2, pi/2] from x [rad]
};
Fabric fabric(std::span<const GrainPair> pairs);

/// Normal forces between grains.
struct ForceDistribution {
  double mean = 0;              ///< <f> [N/m]
  std::vector<double> density;  ///< of f/<f> over bins of equal width from 0 to `largest`; integral <= 1
  double width = 0;             ///< of a bin, in <f>
};

/// Forces above `largest` <f>, and those that pull, count in the mean and in the norm, but have no bin.
ForceDistribution force_distribution(std::span<const GrainPair> pairs, int bins = 20, double largest = 5);

}  // namespace softgrain
