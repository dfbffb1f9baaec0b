#pragma once
#include <cmath>
#include <cstring>
#include <limits>

#include "softgrain/math/lanes.hpp"

namespace softgrain {

/// Eight doubles worked on at once, such as one number of each of eight grains; Wide(2.0) is eight times 2.
/// A pair of four-lane vectors, since g++ keeps those in registers and spills eight-lane ones. Arithmetic is
/// element by element, so each lane has the very bits of scalar code. The functions below exist for double
/// too: a formula is written once, for `class T`.
struct Wide {
  static constexpr int size = 8;
  Lanes low{}, high{};

  Wide() = default;
  // Copied half by half: the compiler's own copy goes through memory in g++ (measured: up to 5 times slower).
  Wide(const Wide& b) : low(b.low), high(b.high) {}
  Wide& operator=(const Wide& b) {
    low = b.low;
    high = b.high;
    return *this;
  }
  Wide(Lanes first_four, Lanes last_four) : low(first_four), high(last_four) {}
  Wide(double value) : low(splat(value)), high(splat(value)) {}  // NOLINT: a number is a Wide of equal lanes

  double operator[](int lane) const { return lane < lane_count ? low[lane] : high[lane % lane_count]; }
  void set(int lane, double value) {
    Lanes& half = lane < lane_count ? low : high;
    half[lane % lane_count] = value;
  }

  Wide& operator+=(const Wide& b) { return *this = {low + b.low, high + b.high}; }
  Wide& operator-=(const Wide& b) { return *this = {low - b.low, high - b.high}; }
  Wide& operator*=(const Wide& b) { return *this = {low * b.low, high * b.high}; }
};

inline Wide operator+(const Wide& a, const Wide& b) { return {a.low + b.low, a.high + b.high}; }
inline Wide operator-(const Wide& a, const Wide& b) { return {a.low - b.low, a.high - b.high}; }
inline Wide operator*(const Wide& a, const Wide& b) { return {a.low * b.low, a.high * b.high}; }
inline Wide operator/(const Wide& a, const Wide& b) { return {a.low / b.low, a.high / b.high}; }
inline Wide operator-(const Wide& a) { return {-a.low, -a.high}; }

/// Eight consecutive doubles from memory, without alignment.
inline Wide load_wide(const double* from) { return {load_lanes(from), load_lanes(from + lane_count)}; }

/// What a comparison says of each lane. For double it is a bool.
struct WideMask {
  decltype(Lanes{} < Lanes{}) low, high;  // all bits set where true
};
inline WideMask operator<(const Wide& a, const Wide& b) { return {a.low < b.low, a.high < b.high}; }
inline WideMask operator<=(const Wide& a, const Wide& b) { return {a.low <= b.low, a.high <= b.high}; }
inline WideMask operator>(const Wide& a, const Wide& b) { return b < a; }
inline WideMask operator>=(const Wide& a, const Wide& b) { return b <= a; }
inline WideMask operator&(const WideMask& a, const WideMask& b) { return {a.low & b.low, a.high & b.high}; }
inline WideMask operator|(const WideMask& a, const WideMask& b) { return {a.low | b.low, a.high | b.high}; }

inline bool any(const WideMask& mask) {
  const auto both = mask.low | mask.high;
  return ((both[0] | both[1]) | (both[2] | both[3])) != 0;
}
inline bool all(const WideMask& mask) {
  const auto both = mask.low & mask.high;
  return ((both[0] & both[1]) & (both[2] & both[3])) != 0;
}
inline bool any(bool mask) { return mask; }
inline bool all(bool mask) { return mask; }

/// `a` where the mask is true, else `b`; both are computed.
inline Wide select(const WideMask& mask, const Wide& a, const Wide& b) {
  return {mask.low ? a.low : b.low, mask.high ? a.high : b.high};
}
inline double select(bool mask, double a, double b) { return mask ? a : b; }
inline Lanes select(decltype(Lanes{} < Lanes{}) mask, Lanes a, Lanes b) { return mask ? a : b; }

inline Wide max(const Wide& a, const Wide& b) { return {max(a.low, b.low), max(a.high, b.high)}; }
inline Wide min(const Wide& a, const Wide& b) { return {min(a.low, b.low), min(a.high, b.high)}; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double min(double a, double b) { return a < b ? a : b; }

inline Lanes sqrt(Lanes x) {
  for (int lane = 0; lane < lane_count; ++lane) x[lane] = std::sqrt(x[lane]);
  return x;
}
inline Wide sqrt(const Wide& x) { return {sqrt(x.low), sqrt(x.high)}; }
inline double sqrt(double x) { return std::sqrt(x); }

/// exp(x), relative error below 2.3e-16 where the result is a normal number; 0 below and infinity above. The
/// same bits on every machine, as those of log.
inline Lanes exp(Lanes x) {
  using Bits = unsigned long long __attribute__((vector_size(sizeof(Lanes))));
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  constexpr double lowest = -708.0, highest = 709.0;
  // exp(x) = 2^k exp(r) with |r| < ln(2)/2; an integer in the low bits of 3/2 2^52 reads as 3/2 2^52 +
  // integer
  constexpr double magic = 0x1.8p52, inverse_ln2 = 1.44269504088896338700;
  const Lanes inside = min(max(x, splat(lowest)), splat(highest));
  const Lanes shifted = inside * inverse_ln2 + magic, k = shifted - magic;
  const Lanes r = (inside - k * ln2_high) - k * ln2_low;
  Lanes sum = splat(1.0 / 6227020800.0);
  for (const double inverse_factorial :
       {1 / 479001600.0, 1 / 39916800.0, 1 / 3628800.0, 1 / 362880.0, 1 / 40320.0, 1 / 5040.0, 1 / 720.0,
        1 / 120.0, 1 / 24.0, 1 / 6.0, 0.5})
    sum = inverse_factorial + r * sum;
  const Bits power = (reinterpret_cast<Bits>(shifted) << 52) + 0x3ff0000000000000;
  const Lanes result = (1.0 + (r + r * r * sum)) * reinterpret_cast<Lanes>(power);
  const Lanes beyond = x > highest ? splat(std::numeric_limits<double>::infinity()) : x;  // or NaN
  return x < lowest ? splat(0.0) : x <= highest ? result : beyond;
}
inline Wide exp(const Wide& x) { return {exp(x.low), exp(x.high)}; }
inline double exp(double x) { return std::exp(x); }

/// R in 2 artanh s = s (2 + R), R = 2/3 s^2 + 2/5 s^4 + ... fitted for |s| < 0.172; z = s^2. After fdlibm's
/// e_log.c (Sun Microsystems 1993).
template <class T>
[[gnu::always_inline]] inline T artanh_series(const T& z) {
  const T w = z * z;
  const T odd =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const T even =
      w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  return odd + even;
}

/// Natural logarithm, relative error below 2.3e-16 wherever x is a normal, positive and finite number; NaN
/// elsewhere, so also at 0 and infinity. After fdlibm's e_log.c (Sun Microsystems 1993), without branches.
inline Lanes log(Lanes x) {
  using Bits = unsigned long long __attribute__((vector_size(sizeof(Lanes))));
  constexpr unsigned long long one = 0x3ff0000000000000, sqrt_half = 0x3fe6a09e00000000;
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  // x = 2^k m with m in [sqrt(1/2), sqrt(2)).
  const Bits bits = reinterpret_cast<Bits>(x);
  const Bits shifted = bits + (one - sqrt_half);
  const Lanes m = reinterpret_cast<Lanes>(bits - (shifted & 0xfff0000000000000) + one);
  constexpr double two_52 = 0x1p52;  // an integer in the low bits of 2^52 reads as 2^52 + integer
  const Lanes k = reinterpret_cast<Lanes>((shifted >> 52) | 0x4330000000000000) - (two_52 + 1023.0);
  // ln(1 + f) = f - f^2/2 + s (f^2/2 + R(s^2)), s = f / (2 + f)
  const Lanes f = m - 1.0, s = f / (2.0 + f);
  const Lanes half_f2 = 0.5 * f * f;
  const Lanes result = k * ln2_high - ((half_f2 - (s * (half_f2 + artanh_series(s * s)) + k * ln2_low)) - f);
  const auto good = (x >= std::numeric_limits<double>::min()) & (x <= std::numeric_limits<double>::max());
  return good ? result : splat(std::numeric_limits<double>::quiet_NaN());
}
inline Wide log(const Wide& x) { return {log(x.low), log(x.high)}; }
inline double log(double x) { return std::log(x); }

}  // namespace softgrain
