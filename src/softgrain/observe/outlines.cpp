#include "softgrain/observe/outlines.hpp"

#include <algorithm>

#include "softgrain/geometry/polygon.hpp"

namespace softgrain {

double total_area(std::span<const Vec<2>> outline, std::span<const int> begin) {
  double area = 0;
  for (std::size_t g = 0; g + 1 < begin.size(); ++g)
    area += polygon_area(outline.subspan(begin[g], begin[g + 1] - begin[g]));
  return area;
}

double coordination_number(std::vector<std::pair<int, int>> pairs, int grains) {
  for (auto& [a, b] : pairs)
    if (a > b) std::swap(a, b);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return 2.0 * static_cast<double>(pairs.size()) / grains;
}

}  // namespace softgrain
