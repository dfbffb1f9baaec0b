#include "softgrain/lattice/lattice.hpp"

#include <cmath>

namespace softgrain {

void Lattice::reset(std::span<const PointGrain> grains) {
  window_.clear();
  int begin = 0;
  constexpr int margin = 3;  // nodes that a point or vertex may reach
  for (const PointGrain& grain : grains) {
    Vec<2> low = grain.outline.front(), high = low;
    const auto include = [&](const Vec<2>& x) {
      for (int d = 0; d < 2; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
    };
    std::for_each(grain.outline.begin(), grain.outline.end(), include);
    std::for_each(grain.position.begin(), grain.position.end(), include);
    const auto first = [&](int d) { return static_cast<int>(std::floor(low[d] / cell_)) - margin; };
    const auto count = [&](int d) {
      return static_cast<int>(std::ceil(high[d] / cell_)) + margin + 1 - first(d);
    };
    window_.push_back({begin, first(0), first(1), count(0), count(1)});
    begin += window_.back().columns * window_.back().rows;
  }
  mass.assign(begin, 0);
  velocity.assign(begin, {});
  inward.assign(begin, {});
}

void Lattice::vertex_weights(int grain, const Vec<2>& x, double least_mass,
                             std::vector<NodeWeight>& weights) const {
  weights.clear();
  // a vertex has no size: uGIMP's hat functions are not averaged
  const ShapeFunction shape = shape_ == ShapeFunction::gimp ? ShapeFunction::bilinear : shape_;
  double sum = 0;
  Stencil(shape, x, cell_).for_each_node([&](int column, int row, double N, const Vec<2>&) {
    if (N <= 0) return;
    const int i = node(grain, column, row);
    if (mass[i] <= least_mass) return;
    weights.push_back({i, N});
    sum += N;
  });
  for (NodeWeight& w : weights) w.weight /= sum;
}

}  // namespace softgrain
