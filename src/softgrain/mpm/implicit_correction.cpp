#include <algorithm>
#include <array>
#include <cmath>

#include "softgrain/core/parallel.hpp"
#include "softgrain/mpm/implicit_step.hpp"

namespace softgrain {
namespace {

/// The secant may take a grain at most this many corrections further, and back no further than it came.
constexpr double furthest = 4;

/// df . df and df . f of each lane, df = f - f_before.
std::array<Wide, 2> change_of(const WideVectors& f, const WideVectors& f_before) {
  Wide squares = 0.0, products = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const Vec<2, Wide> df = f[i] - f_before[i];
    squares += dot(df, df);
    products += dot(df, f[i]);
  }
  return {squares, products};
}

/// The gamma for which |f - gamma df| is least, lane by lane.
Wide secant(const WideVectors& f, const WideVectors& f_before) {
  const auto [squares, products] = change_of(f, f_before);
  Wide gamma = 0.0;
  for (int lane = 0; lane < Wide::size; ++lane)
    if (squares[lane] > 0) gamma.set(lane, std::clamp(products[lane] / squares[lane], -furthest, 1.0));
  return gamma;
}

}  // namespace

/// With f = A^-1 (r + H p/dt), for each grain by itself and dx its last move:
///   x += f - gamma (dx + df),
/// Anderson's method with one step back: A is stiffer than the tangent by the proximal term, so that f alone
/// goes the same share of the way in every iteration. The last iteration goes by f, as does the first one of
/// a matrix. Returns the largest f [m].
double ImplicitDynamics::correct(bool same_matrix) {
  const std::vector<Vec<2>> force = contact_forces(grains, contacts, impulse, outline_.dt);
  std::vector<std::pair<double, int>> largest(batches());  // |f|^2 and the grain where it is
  parallel_for(batches(), [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    WideVectors& f = force_[b];
    f.assign(f.size(), {});
    grains.scatter_outline(force, batch, f);
    kept_[b].assign(f.begin() + batch.topology->grid.outline_begin, f.end());
    matrix_[b].finish_solve(numbers(half_solved_[b]), numbers(kept_[b]), numbers(f));
    Wide most = 0.0;
    for (const Vec<2, Wide>& of_node : f) {
      const Wide square = dot(of_node, of_node);
      most = select(square <= most, most, square);  // NaN in one node is NaN in all
    }
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      if (!(most[lane] <= largest[b].first)) largest[b] = {most[lane], batch.grain[lane]};
  });
  double most = 0;
  for (const auto& [square, grain] : largest)
    if (!(square <= most)) most = square, failed_grain_ = grain;
  const bool accelerated = same_matrix && std::sqrt(most) >= options.tolerance * mean_radius_;
  parallel_for(batches(), [&](int b) {
    const WideVectors& f = force_[b];
    correction_[b].resize(f.size());
    moved_[b].resize(f.size());
    const Wide gamma = accelerated ? secant(f, correction_[b]) : 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      moved_[b][i] = accelerated ? f[i] - gamma * (moved_[b][i] + f[i] - correction_[b][i]) : f[i];
      grains.batches[b].position[i] += moved_[b][i];
    }
    correction_[b] = f;
  });
  return std::sqrt(most);
}

}  // namespace softgrain
