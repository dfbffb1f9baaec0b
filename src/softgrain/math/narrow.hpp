#pragma once
#include <cmath>

#include "softgrain/core/processor.hpp"
#include "softgrain/math/precision.hpp"
#include "softgrain/math/wide.hpp"

namespace softgrain {

/// Eight numbers in single precision: half the memory and half the work of Wide, for what is corrected later.
struct Narrow {
  using Floats = EightFloats;
  Floats lanes{};

  Narrow() = default;
  Narrow(const Narrow& b) : lanes(b.lanes) {}  // as Wide
  Narrow& operator=(const Narrow& b) {
    lanes = b.lanes;
    return *this;
  }
  explicit Narrow(const Floats& value) : lanes(value) {}
  explicit Narrow(const Wide& value) {
    using Four = float __attribute__((vector_size(16)));
    lanes = __builtin_shufflevector(__builtin_convertvector(value.low, Four),
                                    __builtin_convertvector(value.high, Four), 0, 1, 2, 3, 4, 5, 6, 7);
  }
  explicit operator Wide() const {
    return {__builtin_convertvector(__builtin_shufflevector(lanes, lanes, 0, 1, 2, 3), Lanes),
            __builtin_convertvector(__builtin_shufflevector(lanes, lanes, 4, 5, 6, 7), Lanes)};
  }

  float operator[](int lane) const { return lanes[lane]; }
  Narrow& operator+=(const Narrow& b) { return lanes += b.lanes, *this; }
  Narrow& operator-=(const Narrow& b) { return lanes -= b.lanes, *this; }
};

inline Narrow::Floats max(Narrow::Floats a, Narrow::Floats b) { return a > b ? a : b; }  // b if one is NaN
inline Narrow::Floats min(Narrow::Floats a, Narrow::Floats b) { return a < b ? a : b; }
inline Narrow::Floats select(decltype(Narrow::Floats{} < Narrow::Floats{}) mask, Narrow::Floats a,
                             Narrow::Floats b) {
  return mask ? a : b;
}

inline Narrow::Floats sqrt(Narrow::Floats x) {
  for (int lane = 0; lane < Wide::size; ++lane) x[lane] = std::sqrt(x[lane]);
  return x;
}

/// How many numbers a T holds, and one of them.
template <class T>
inline constexpr int lanes_of = T::size;
template <>
inline constexpr int lanes_of<double> = 1;
template <>
inline constexpr int lanes_of<Lanes> = lane_count;
template <>
inline constexpr int lanes_of<Narrow::Floats> = Wide::size;
template <class T>
inline double lane_of(const T& numbers, int lane) {
  return numbers[lane];
}
inline double lane_of(double number, int /*lane*/) { return number; }

inline Narrow operator+(const Narrow& a, const Narrow& b) { return Narrow(a.lanes + b.lanes); }
inline Narrow operator-(const Narrow& a, const Narrow& b) { return Narrow(a.lanes - b.lanes); }
inline Narrow operator*(const Narrow& a, const Narrow& b) { return Narrow(a.lanes * b.lanes); }
inline Narrow operator/(const Narrow& a, const Narrow& b) { return Narrow(a.lanes / b.lanes); }

/// c - a b. Of Narrow with one rounding, always: the same bits from every compiler, for half the work.
inline Narrow minus_product(const Narrow& c, const Narrow& a, const Narrow& b) {
  return Narrow(fused_multiply_add(-a.lanes, b.lanes, c.lanes));
}
inline Wide minus_product(const Wide& c, const Wide& a, const Wide& b) { return c - a * b; }

inline Narrow sqrt(Narrow x) {
  for (int lane = 0; lane < Wide::size; ++lane) x.lanes[lane] = std::sqrt(x.lanes[lane]);
  return x;
}

}  // namespace softgrain
