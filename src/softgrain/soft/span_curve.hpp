#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// The curve of a span as a polynomial, c(xi) = a + xi (b + xi (c + xi d)).
class SpanCurve {
 public:
  SpanCurve(std::span<const Vec<2>> position, const std::array<int, 4>& vertices)
      : start_(position[vertices[1]]), end_(position[vertices[2]]) {
    const Vec<2>&x_0 = position[vertices[0]], &x_3 = position[vertices[3]];
    b_ = 0.5 * (end_ - x_0);
    d_ = 0.5 * (x_3 - x_0) + 1.5 * (start_ - end_);
    c_ = end_ - start_ - b_ - d_;
  }
  Vec<2> place(double xi) const { return start_ + xi * (b_ + xi * (c_ + xi * d_)); }
  Vec<2> tangent(double xi) const { return b_ + xi * (2.0 * c_ + 3 * xi * d_); }

  /// Where in [0, 1] it is closest to x: the root of (x - c) . c', by Newton's method inside a bracket.
  [[gnu::always_inline]] double closest_to(const Vec<2>& x) const {
    const Vec<2> chord = end_ - start_;
    double low = 0, high = 1;
    double xi = std::clamp(dot(x - start_, chord) / dot(chord, chord), 0.0, 1.0);
    for (int pass = 0; pass < 50; ++pass) {
      const Vec<2> d = x - place(xi), t = tangent(xi);
      const double descent = dot(d, t), slope = dot(t, t) - dot(d, 2.0 * c_ + 6 * xi * d_);
      (descent > 0 ? low : high) = xi;
      const double newton = xi + descent / slope;
      const bool trusted = slope > 0 && newton >= low && newton <= high;
      const double step = (trusted ? newton : (low + high) / 2) - xi;
      xi += step;
      if (std::abs(step) < (trusted ? 1e-7 : 1e-13)) break;  // Newton's error is the square of its step
    }
    return xi;
  }

 private:
  Vec<2> start_, end_, b_, c_, d_;
};

}  // namespace softgrain
