#pragma once
#include "softgrain/math/wide.hpp"

namespace softgrain {

/// phi(z) = artanh(sqrt z) / sqrt z = 1 + z/3 + z^2/5 + ... and its derivative, for 0 <= z < 1: what is left
/// of ln(a / b) / (a - b) = 2 phi(z) / (a + b), z = ((a - b) / (a + b))^2, when a and b come together.
template <class T>
struct LogRatio {
  T value, derivative;
};

template <class T>
LogRatio<T> log_ratio(const T& z) {
  // Below 0.04 the series, to round-off: term k is z^k / (2 k + 1).
  constexpr int last = 11;
  T value(1.0 / (2 * last + 1)), derivative(double(last) / (2 * last + 1));
  for (int k = last - 1; k > 0; --k) {
    value = 1.0 / (2 * k + 1) + z * value;
    derivative = double(k) / (2 * k + 1) + z * derivative;
  }
  value = 1.0 + z * value;
  const auto small = z < T(0.04);
  if (all(small)) return {value, derivative};
  const T r = sqrt(z);
  const T closed = log((1.0 + r) / (1.0 - r)) / (2.0 * r);
  const T closed_derivative = (1.0 / (1.0 - z) - closed) / (2.0 * z);
  return {select(small, value, closed), select(small, derivative, closed_derivative)};
}

}  // namespace softgrain
