#pragma once
#include "softgrain/math/wide.hpp"

namespace softgrain {

/// g(q) = arsinh(sqrt q) / sqrt q = 1 - q/6 + 3 q^2/40 - ... and two derivatives, for q >= 0: x = g sinh x
/// with q = sinh^2 x, smooth at x = 0.
template <class T>
struct ArsinhRatio {
  T value, first, second;
};

template <class T>
ArsinhRatio<T> arsinh_ratio(const T& q) {
  // Below 0.04 the series, to round-off: term k + 1 is -(2 k + 1)^2/((2 k + 2)(2 k + 3)) q times term k.
  constexpr int last = 13;
  T value(1.0), first(0.0), second(0.0);
  for (int k = last; k >= 0; --k) {
    const double ratio = -double((2 * k + 1) * (2 * k + 1)) / ((2 * k + 2) * (2 * k + 3));
    second = ratio * (2.0 * first + q * second);
    first = ratio * (value + q * first);
    value = 1.0 + ratio * q * value;
  }
  const auto small = q < T(0.04);
  if (all(small)) return {value, first, second};
  const T root = sqrt(q), hypotenuse = sqrt(1.0 + q), inverse = 1.0 / hypotenuse, half = 0.5 / q;
  const T closed = log(root + hypotenuse) / root, closed_first = (inverse - closed) * half;
  const T closed_second = -(0.5 * inverse * inverse * inverse + 3.0 * closed_first) * half;
  return {select(small, value, closed), select(small, first, closed_first),
          select(small, second, closed_second)};
}

}  // namespace softgrain
