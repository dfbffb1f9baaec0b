#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/solid_equilibrium.hpp"

namespace softgrain {
namespace {

/// Of Lanczos' method.
constexpr int lanczos_steps = 14;

/// By how much the force is asked for beside a place, over the radius.
constexpr double small_move = 1e-6;

/// sum a . b over the nodes
Wide product(const WidePlaces<3>& a, const WidePlaces<3>& b) {
  Wide sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

/// A symmetric tridiagonal matrix.
struct Tridiagonal {
  std::vector<double> diagonal, beside;  // beside[k] between k and k + 1; the last leads out of the matrix

  /// Does it have an eigenvalue above x? By the signs of the pivots of T - x.
  bool has_above(double x) const {
    double pivot = 1;
    for (std::size_t k = 0; k < diagonal.size(); ++k) {
      const double before = k == 0 ? 0 : beside[k - 1] * beside[k - 1] / pivot;
      pivot = diagonal[k] - x - before;
      if (pivot > 0) return true;
      if (pivot == 0) pivot = -std::numeric_limits<double>::min();
    }
    return false;
  }

  double largest_eigenvalue() const {
    double low = 0, high = 0;
    for (std::size_t k = 0; k < diagonal.size(); ++k)
      high = std::max(high, diagonal[k] + std::abs(beside[k]) + (k == 0 ? 0 : std::abs(beside[k - 1])));
    for (int pass = 0; pass < 60; ++pass) {
      const double middle = (low + high) / 2;
      (has_above(middle) ? low : high) = middle;
    }
    return high;
  }

  /// beside.back() |s|, s the last component of the unit eigenvector of x: some eigenvalue of the whole is
  /// that near.
  double error_of(double x) const {
    double s = 1, before = 0, sum = 1;  // from the last row backwards
    for (std::size_t k = diagonal.size() - 1; k > 0; --k) {
      const double after = k + 1 < diagonal.size() ? beside[k] * before : 0;
      const double next = ((x - diagonal[k]) * s - after) / beside[k - 1];
      before = s, s = next;
      sum += s * s;
    }
    return beside.back() / std::sqrt(sum);
  }
};

/// The largest eigenvalue of M^-1 K of each grain of a batch [1/s^2].
class Lanczos {
 public:
  Lanczos(const SolidGrains& grains, const SolidBatch& batch)
      : grains_(grains), moved_(batch), x_(batch.position) {
    const std::size_t n = x_.size();
    for (std::size_t i = 0; i < n; ++i)
      root_.push_back(1.0 / sqrt(grains.node_mass(batch, static_cast<int>(i))));
    internal_force(grains, batch, at_rest_);
  }

  double largest(int lanes) {
    start();
    std::array<Tridiagonal, Wide::size> T;
    Wide beta = 0.0;
    for (int k = 0; k < lanczos_steps; ++k) {
      apply();
      const Wide alpha = product(v_, w_);
      for (std::size_t i = 0; i < v_.size(); ++i) w_[i] -= alpha * v_[i] + beta * last_[i];
      beta = sqrt(product(w_, w_));
      for (int lane = 0; lane < lanes; ++lane) {
        T[static_cast<std::size_t>(lane)].diagonal.push_back(alpha[lane]);
        T[static_cast<std::size_t>(lane)].beside.push_back(beta[lane]);
      }
      std::swap(last_, v_);
      const Wide inverse = 1.0 / beta;
      for (std::size_t i = 0; i < v_.size(); ++i) v_[i] = inverse * w_[i];
    }
    double most = 0;
    for (int lane = 0; lane < lanes; ++lane) {
      const Tridiagonal& t = T[static_cast<std::size_t>(lane)];
      const double value = t.largest_eigenvalue();
      most = std::max(most, value + t.error_of(value));
    }
    return most;
  }

 private:
  /// Unit, the same for all grains, without a pattern.
  void start() {
    v_.resize(x_.size()), w_.resize(x_.size());
    last_.assign(x_.size(), {});
    double place = 0;
    for (Vec<3, Wide>& v : v_)
      for (int d = 0; d < 3; ++d) {
        place += std::numbers::phi;
        v[d] = place - std::floor(place) - 0.5;
      }
    const Wide inverse = 1.0 / sqrt(product(v_, v_));
    for (Vec<3, Wide>& v : v_) v *= inverse;
  }

  /// w = M^-1/2 K M^-1/2 v, with K by a difference of forces
  void apply() {
    Wide largest = 0.0;
    for (std::size_t i = 0; i < v_.size(); ++i) {
      w_[i] = root_[i] * v_[i];
      largest = max(largest, dot(w_[i], w_[i]));
    }
    const Wide move = small_move * grains_.radius(0) / sqrt(largest), inverse = 1.0 / move;
    for (std::size_t i = 0; i < v_.size(); ++i) moved_.position[i] = x_[i] + move * w_[i];
    internal_force(grains_, moved_, force_);
    for (std::size_t i = 0; i < v_.size(); ++i) w_[i] = (root_[i] * inverse) * (force_[i] - at_rest_[i]);
  }

  const SolidGrains& grains_;
  SolidBatch moved_;
  WidePlaces<3> x_, at_rest_, force_, v_, w_, last_;
  std::vector<Wide> root_;  // of 1/m [kg^-1/2]
};

}  // namespace

double longest_stable_step(const SolidGrains& grains, double damping_share) {
  std::vector<double> largest(grains.batches.size());
  const auto look = [&](int b) {
    const SolidBatch& batch = grains.batches[static_cast<std::size_t>(b)];
    if (batch.topology->rigid()) return;
    int lanes = 0;
    while (lanes < Wide::size && batch.grain[static_cast<std::size_t>(lanes)] >= 0) ++lanes;
    largest[static_cast<std::size_t>(b)] = Lanczos(grains, batch).largest(lanes);
  };
  shared_for(grains.shares, static_cast<int>(largest.size()), look,
             [&](int b, Message& message) { message(largest[static_cast<std::size_t>(b)]); });
  return 2 / std::sqrt((1 + 2 * damping_share) * *std::max_element(largest.begin(), largest.end()));
}

}  // namespace softgrain
