#pragma once
#include <vector>

#include "softgrain/model/model.hpp"

namespace softgrain {

/// A contact that carries force, for force chains.
struct Chain {
  int a = 0, b = 0;
  double force = 0;  ///< magnitude [N/m]
};

/// Forces between soft grains in snapshots of versions that stored no contacts, from the forces on the
/// vertices of their outlines: each vertex is pushed by the other grain or the wall that is nearest to it.
/// Bodies count as grains, then walls; a < b. From both sides of a contact the mean: f = |F_ab - F_ba| / 2.
std::vector<Chain> chains_between_outlines(const Scene& scene);

}  // namespace softgrain
