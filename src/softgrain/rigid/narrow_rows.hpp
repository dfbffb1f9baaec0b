#pragma once
#include <cstring>

#include "softgrain/math/narrow.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

// Rows of two numbers, eight at once, as columns.

using FloatPairs = double __attribute__((vector_size(32)));  // of floats, moved as one

struct FloatColumns {
  Narrow::Floats x, y;
};

struct WideColumns {
  Wide x, y;
};
[[gnu::always_inline]] inline WideColumns load_wide_columns(const Vec<2>* rows) {
  const LaneColumns low = load_columns(rows), high = load_columns(rows + lane_count);
  return {{low.x, high.x}, {low.y, high.y}};
}

template <class Row>
[[gnu::always_inline]] inline double pair_at(const Row& row) {
  double pair;
  static_assert(sizeof row == sizeof pair);
  std::memcpy(&pair, &row, sizeof pair);
  return pair;
}

/// Rows index[0..7], as columns.
template <class Row>
[[gnu::always_inline]] inline FloatColumns gather_columns(const Row* rows, const int* index) {
  const auto four = [&](int k, int l, int m, int n) {
    return reinterpret_cast<Narrow::Floats>(FloatPairs{pair_at(rows[index[k]]), pair_at(rows[index[l]]),
                                                       pair_at(rows[index[m]]), pair_at(rows[index[n]])});
  };
  const Narrow::Floats rows0145 = four(0, 1, 4, 5), rows2367 = four(2, 3, 6, 7);
  return {__builtin_shufflevector(rows0145, rows2367, 0, 2, 8, 10, 4, 6, 12, 14),
          __builtin_shufflevector(rows0145, rows2367, 1, 3, 9, 11, 5, 7, 13, 15)};
}

/// The inverse of gather_columns: all indices must differ, or hold the same row.
template <class Row>
[[gnu::always_inline]] inline void scatter_columns(const FloatColumns& columns, Row* rows, const int* index) {
  const auto store = [&](int lane, double pair) { std::memcpy(&rows[index[lane]], &pair, sizeof pair); };
  const auto rows0145 =
      reinterpret_cast<FloatPairs>(__builtin_shufflevector(columns.x, columns.y, 0, 8, 1, 9, 4, 12, 5, 13));
  const auto rows2367 =
      reinterpret_cast<FloatPairs>(__builtin_shufflevector(columns.x, columns.y, 2, 10, 3, 11, 6, 14, 7, 15));
  store(0, rows0145[0]), store(1, rows0145[1]), store(2, rows2367[0]), store(3, rows2367[1]);
  store(4, rows0145[2]), store(5, rows0145[3]), store(6, rows2367[2]), store(7, rows2367[3]);
}

[[gnu::always_inline]] inline Narrow::Floats gather(const float* numbers, const int* index) {
  Narrow::Floats lanes;
  for (int lane = 0; lane < Wide::size; ++lane) lanes[lane] = numbers[index[lane]];
  return lanes;
}
[[gnu::always_inline]] inline void scatter(Narrow::Floats lanes, float* numbers, const int* index) {
  for (int lane = 0; lane < Wide::size; ++lane) numbers[index[lane]] = lanes[lane];
}

}  // namespace softgrain
