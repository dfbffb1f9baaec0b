#pragma once
#include <span>
#include <utility>

namespace softgrain {

/// Number of connected clusters of `particles` nodes under the links given. A grain that has not broken is
/// one.
int count_clusters(int particles, std::span<const std::pair<int, int>> links);

}  // namespace softgrain
