#pragma once
#include "softgrain/math/wide.hpp"

namespace softgrain {

/// cosh(a x) as a function of s = cosh x = 1 + y, Chebyshev's T_a(s), and two derivatives by s, for y >= 0:
/// smooth at x = 0.
template <class T>
struct CoshMultiple {
  T value, first, second;
};

template <class T>
CoshMultiple<T> cosh_multiple(double a, const T& y) {
  // Below 0.04 the series, to round-off: term k + 1 is (a^2 - k^2)/((2 k + 1)(k + 1)) y times term k.
  constexpr int last = 13;
  T value(1.0), first(0.0), second(0.0);
  for (int k = last; k >= 0; --k) {
    const double ratio = (a * a - k * k) * (1.0 / ((2 * k + 1) * (k + 1)));
    second = ratio * (2.0 * first + y * second);
    first = ratio * (value + y * first);
    value = 1.0 + ratio * y * value;
  }
  const auto small = y < T(0.04);
  if (all(small)) return {value, first, second};
  const T s = 1.0 + y, square = y * (2.0 + y), root = sqrt(square);  // sinh x
  const T up = exp(a * log(s + root)), down = 1.0 / up;
  const T closed = 0.5 * (up + down), closed_first = (0.5 * a) * (up - down) / root;
  const T closed_second = (a * a * closed - s * closed_first) / square;  // Chebyshev's equation
  return {select(small, value, closed), select(small, first, closed_first),
          select(small, second, closed_second)};
}

/// sinh(z)/z, smooth at 0.
template <class T>
T sinh_ratio(const T& z) {
  const T square = z * z;
  T series(1.0);
  for (int k = 7; k > 0; --k) series = 1.0 + (1.0 / ((2 * k) * (2 * k + 1))) * square * series;
  const auto small = square < T(0.25);
  if (all(small)) return series;
  const T up = exp(z);
  return select(small, series, 0.5 * (up - 1.0 / up) / z);
}

}  // namespace softgrain
