#pragma once
#include <span>
#include <utility>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// True deformed area of grains [m^2]: sum over outline polygons; grain g has the vertices begin[g] ..
/// begin[g + 1] - 1.
double total_area(std::span<const Vec<2>> outline, std::span<const int> begin);

/// Coordination number Z = 2 pairs / grains, over pairs of distinct grains that carry force; a pair counts
/// once however many contact points it has.
double coordination_number(std::vector<std::pair<int, int>> pairs, int grains);

}  // namespace softgrain
