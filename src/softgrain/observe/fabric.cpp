#include "softgrain/observe/fabric.hpp"

#include <cmath>

namespace softgrain {

Fabric fabric(std::span<const GrainPair> pairs) {
  Fabric result;
  Mat<2>& F = result.tensor;
  for (const GrainPair& pair : pairs)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        F(i, j) += pair.normal[i] * pair.normal[j] / static_cast<double>(pairs.size());
  const double difference = F(0, 0) - F(1, 1), shear = F(0, 1) + F(1, 0);
  result.anisotropy = 2 * std::hypot(difference, shear);
  result.direction = 0.5 * std::atan2(shear, difference);
  return result;
}

ForceDistribution force_distribution(std::span<const GrainPair> pairs, int bins, double largest) {
  ForceDistribution result{.mean = 0, .density = std::vector<double>(bins, 0), .width = largest / bins};
  if (pairs.empty()) return result;
  const auto count = static_cast<double>(pairs.size());
  for (const GrainPair& pair : pairs) result.mean += pair.normal_force / count;
  for (const GrainPair& pair : pairs) {
    const double bin = pair.normal_force / (result.mean * result.width);
    if (bin >= 0 && bin < bins) result.density[static_cast<std::size_t>(bin)] += 1 / (count * result.width);
  }
  return result;
}

}  // namespace softgrain
