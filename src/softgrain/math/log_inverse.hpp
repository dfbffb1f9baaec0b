#pragma once
#include <array>
#include <cstddef>

#include "softgrain/math/wide.hpp"

namespace softgrain {

/// ln x and 1/x of N numbers.
template <class T, std::size_t N>
struct LogInverse {
  std::array<T, N> log, inverse;
};

namespace detail {

/// For x in [1/sqrt 2, sqrt 2], relative error below 1e-15: ln x = 2 artanh s, s = (x - 1)/(x + 1). One
/// division serves both.
template <class T>
[[gnu::always_inline]] inline void log_inverse_near_one(const T& x, T& log_x, T& inverse) {
  const T sum = x + 1.0, both = 1.0 / (sum * x);
  const T s = (x - 1.0) * (both * x);
  log_x = s * (2.0 + artanh_series(s * s));
  inverse = both * sum;
}

template <class T>
inline auto near_one(const T& x) {
  return (x > 0.7072) & (x < 1.4142);
}

/// Where some x is far from one; each number is as it would be alone.
template <class T, std::size_t N>
[[gnu::noinline]] LogInverse<T, N> log_inverse_anywhere(const std::array<T, N>& x) {
  LogInverse<T, N> result;
  for (std::size_t k = 0; k < N; ++k) {
    log_inverse_near_one(x[k], result.log[k], result.inverse[k]);
    const auto near = near_one(x[k]);
    result.log[k] = select(near, result.log[k], log(x[k]));
    result.inverse[k] = select(near, result.inverse[k], 1.0 / x[k]);
  }
  return result;
}

}  // namespace detail

/// ln x and 1/x of several numbers side by side (each alone is a chain that the processor waits for), fast
/// where all are near one.
template <class T, std::size_t N>
[[gnu::always_inline]] inline LogInverse<T, N> log_inverse(const std::array<T, N>& x) {
  auto near = detail::near_one(x[0]);
  for (std::size_t k = 1; k < N; ++k) near = near & detail::near_one(x[k]);
  if (!all(near)) return detail::log_inverse_anywhere(x);
  LogInverse<T, N> result;
  for (std::size_t k = 0; k < N; ++k) detail::log_inverse_near_one(x[k], result.log[k], result.inverse[k]);
  return result;
}

}  // namespace softgrain
