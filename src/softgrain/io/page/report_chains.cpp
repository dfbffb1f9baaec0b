#include "softgrain/io/page/report_chains.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "softgrain/math/vec.hpp"

namespace softgrain {

namespace {

double distance_to_segment(const Vec<2>& x, const Vec<2>& p, const Vec<2>& q) {
  const Vec<2> along = q - p;
  const double length2 = dot(along, along);
  const double s = length2 > 0 ? std::clamp(dot(x - p, along) / length2, 0.0, 1.0) : 0;
  return norm(x - (p + s * along));
}

/// Vertices of all outlines in square cells, to find the nearest outline.
class OutlinePoints {
 public:
  explicit OutlinePoints(const Scene& scene)
      : position_(std::get<std::vector<double>>(scene.outlines.at("position").values)),
        force_(std::get<std::vector<double>>(scene.outlines.at("force").values)),
        grain_(std::get<std::vector<std::int64_t>>(scene.outlines.at("grain").values)),
        walls_(scene.wall_segments) {
    for (int v = 0, begin = 0; v < size(); ++v) {
      if (grain_[v] != grain_[begin]) begin = v;
      const bool last = v + 1 == size() || grain_[v + 1] != grain_[v];
      next_.push_back(last ? begin : v + 1);
      cell_size_ = std::max(cell_size_, norm(x(next_[v]) - x(v)));
    }
    for (int v = 0; v < size(); ++v) cells_[key(cell(x(v)[0]), cell(x(v)[1]))].push_back(v);
  }

  int size() const { return static_cast<int>(grain_.size()); }
  int grain(int v) const { return static_cast<int>(grain_[v]); }
  Vec<2> force(int v) const { return {force_[2 * v], force_[2 * v + 1]}; }

  /// The nearest other grain or wall; -1 when none is within a segment's length.
  int partner(int v) const {
    int nearest = -1;
    double least = cell_size_;
    const auto offer = [&](int body, double distance) {
      if (distance < least) least = distance, nearest = body;
    };
    const int i0 = cell(x(v)[0]), j0 = cell(x(v)[1]);
    for (int i = i0 - 2; i <= i0 + 2; ++i)
      for (int j = j0 - 2; j <= j0 + 2; ++j) {
        const auto at = cells_.find(key(i, j));
        if (at == cells_.end()) continue;
        for (const int u : at->second)
          if (grain_[u] != grain_[v]) offer(grain(u), distance_to_segment(x(v), x(u), x(next_[u])));
      }
    const int grains = 1 + static_cast<int>(*std::max_element(grain_.begin(), grain_.end()));
    for (int w = 0; 4 * w + 3 < static_cast<int>(walls_.size()); ++w) {
      const double* wall = &walls_[4 * w];
      offer(grains + w, distance_to_segment(x(v), {wall[0], wall[1]}, {wall[2], wall[3]}));
    }
    return nearest;
  }

 private:
  Vec<2> x(int v) const { return {position_[2 * v], position_[2 * v + 1]}; }
  int cell(double coordinate) const { return static_cast<int>(std::floor(coordinate / cell_size_)); }
  static std::int64_t key(int i, int j) { return std::int64_t{i} << 32 | static_cast<std::uint32_t>(j); }

  const std::vector<double>&position_, &force_;
  const std::vector<std::int64_t>& grain_;
  const std::vector<double>& walls_;
  std::vector<int> next_;  ///< along the outline
  double cell_size_ = std::numeric_limits<double>::min();
  std::unordered_map<std::int64_t, std::vector<int>> cells_;
};

}  // namespace

std::vector<Chain> chains_between_outlines(const Scene& scene) {
  for (const char* name : {"position", "force", "grain"})
    if (!scene.outlines.contains(name)) return {};
  const OutlinePoints outlines(scene);
  // F_ab - F_ba, with F_ab the force of b on a, a < b
  std::map<std::pair<int, int>, Vec<2>> difference;
  std::map<std::pair<int, int>, int> sides;
  for (int v = 0; v < outlines.size(); ++v) {
    const Vec<2> F = outlines.force(v);
    const int a = outlines.grain(v), b = F[0] != 0 || F[1] != 0 ? outlines.partner(v) : -1;
    if (b < 0) continue;
    const auto pair = std::minmax(a, b);
    difference[pair] += a < b ? F : -1.0 * F;
    sides[pair] |= a < b ? 1 : 2;
  }
  std::vector<Chain> chains;
  for (const auto& [pair, F] : difference)
    chains.push_back({pair.first, pair.second, norm(F) / (sides[pair] == 3 ? 2 : 1)});
  return chains;
}

}  // namespace softgrain
