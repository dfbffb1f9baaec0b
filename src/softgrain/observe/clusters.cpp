#include "softgrain/observe/clusters.hpp"

#include <numeric>
#include <vector>

namespace softgrain {

int count_clusters(int particles, std::span<const std::pair<int, int>> links) {
  std::vector<int> parent(particles);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  int clusters = particles;
  for (const auto& [i, j] : links) {
    const int a = root(i), b = root(j);
    if (a == b) continue;
    parent[a] = b;
    --clusters;
  }
  return clusters;
}

}  // namespace softgrain
