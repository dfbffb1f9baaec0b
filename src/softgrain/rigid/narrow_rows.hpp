#pragma once
#include <cstring>

#include "softgrain/math/narrow.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

// Rows of one, two or three numbers, eight at once, as columns.

/// Three are padded to four, which are moved as one.
template <int N>
struct NarrowRow {
  float c[N == 3 ? 4 : N];
};

using FloatPairs = double __attribute__((vector_size(32)));  // of floats, moved as one
using FourFloats = float __attribute__((vector_size(16)));

struct WideColumns {
  Wide x, y;
};
[[gnu::always_inline]] inline WideColumns load_wide_columns(const Vec<2>* rows) {
  const LaneColumns low = load_columns(rows), high = load_columns(rows + lane_count);
  return {{low.x, high.x}, {low.y, high.y}};
}

/// Eight consecutive rows, rounded to floats.
[[gnu::always_inline]] inline Vec<2, Narrow::Floats> load_narrow(const Vec<2>* rows) {
  const WideColumns wide = load_wide_columns(rows);
  return {Narrow(wide.x).lanes, Narrow(wide.y).lanes};
}
[[gnu::always_inline]] inline Vec<3, Narrow::Floats> load_narrow(const Vec<3>* rows) {
  Vec<3, Narrow::Floats> columns;
  for (int k = 0; k < 3; ++k)
    for (int lane = 0; lane < Wide::size; ++lane) columns[k][lane] = static_cast<float>(rows[lane][k]);
  return columns;
}

template <class Row>
[[gnu::always_inline]] inline double pair_at(const Row& row) {
  double pair;
  static_assert(sizeof row == sizeof pair);
  std::memcpy(&pair, &row, sizeof pair);
  return pair;
}
[[gnu::always_inline]] inline FourFloats four_at(const NarrowRow<3>& row) {
  FourFloats four;
  std::memcpy(&four, row.c, sizeof four);
  return four;
}

/// Rows index[0..7], as columns.
[[gnu::always_inline]] inline Vec<2, Narrow::Floats> gather_columns(const NarrowRow<2>* rows,
                                                                    const int* index) {
  const auto four = [&](int k, int l, int m, int n) {
    return reinterpret_cast<Narrow::Floats>(FloatPairs{pair_at(rows[index[k]]), pair_at(rows[index[l]]),
                                                       pair_at(rows[index[m]]), pair_at(rows[index[n]])});
  };
  const Narrow::Floats rows0145 = four(0, 1, 4, 5), rows2367 = four(2, 3, 6, 7);
  return {__builtin_shufflevector(rows0145, rows2367, 0, 2, 8, 10, 4, 6, 12, 14),
          __builtin_shufflevector(rows0145, rows2367, 1, 3, 9, 11, 5, 7, 13, 15)};
}

/// The inverse of gather_columns: all indices must differ, or hold the same row.
[[gnu::always_inline]] inline void scatter_columns(const Vec<2, Narrow::Floats>& columns, NarrowRow<2>* rows,
                                                   const int* index) {
  const auto store = [&](int lane, double pair) { std::memcpy(&rows[index[lane]], &pair, sizeof pair); };
  const auto rows0145 =
      reinterpret_cast<FloatPairs>(__builtin_shufflevector(columns[0], columns[1], 0, 8, 1, 9, 4, 12, 5, 13));
  const auto rows2367 = reinterpret_cast<FloatPairs>(
      __builtin_shufflevector(columns[0], columns[1], 2, 10, 3, 11, 6, 14, 7, 15));
  store(0, rows0145[0]), store(1, rows0145[1]), store(2, rows2367[0]), store(3, rows2367[1]);
  store(4, rows0145[2]), store(5, rows0145[3]), store(6, rows2367[2]), store(7, rows2367[3]);
}

/// In space: eight rows of four, transposed in the halves of four vectors.
[[gnu::always_inline]] inline Vec<3, Narrow::Floats> gather_columns(const NarrowRow<3>* rows,
                                                                    const int* index) {
  const auto two = [&](int k) {  // rows k and k + 4
    return __builtin_shufflevector(four_at(rows[index[k]]), four_at(rows[index[k + 4]]), 0, 1, 2, 3, 4, 5, 6,
                                   7);
  };
  const Narrow::Floats r0 = two(0), r1 = two(1), r2 = two(2), r3 = two(3);
  const Narrow::Floats xy01 = __builtin_shufflevector(r0, r1, 0, 8, 1, 9, 4, 12, 5, 13),
                       xy23 = __builtin_shufflevector(r2, r3, 0, 8, 1, 9, 4, 12, 5, 13),
                       z01 = __builtin_shufflevector(r0, r1, 2, 10, 3, 11, 6, 14, 7, 15),
                       z23 = __builtin_shufflevector(r2, r3, 2, 10, 3, 11, 6, 14, 7, 15);
  return {__builtin_shufflevector(xy01, xy23, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(xy01, xy23, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(z01, z23, 0, 1, 8, 9, 4, 5, 12, 13)};
}
[[gnu::always_inline]] inline void scatter_columns(const Vec<3, Narrow::Floats>& columns, NarrowRow<3>* rows,
                                                   const int* index) {
  const Narrow::Floats zero{};
  const Narrow::Floats xy01 = __builtin_shufflevector(columns[0], columns[1], 0, 8, 1, 9, 4, 12, 5, 13),
                       xy23 = __builtin_shufflevector(columns[0], columns[1], 2, 10, 3, 11, 6, 14, 7, 15),
                       z01 = __builtin_shufflevector(columns[2], zero, 0, 8, 1, 9, 4, 12, 5, 13),
                       z23 = __builtin_shufflevector(columns[2], zero, 2, 10, 3, 11, 6, 14, 7, 15);
  const auto store = [&](int k, Narrow::Floats two) {
    const FourFloats first = __builtin_shufflevector(two, two, 0, 1, 2, 3),
                     second = __builtin_shufflevector(two, two, 4, 5, 6, 7);
    std::memcpy(rows[index[k]].c, &first, sizeof first);
    std::memcpy(rows[index[k + 4]].c, &second, sizeof second);
  };
  store(0, __builtin_shufflevector(xy01, z01, 0, 1, 8, 9, 4, 5, 12, 13));
  store(1, __builtin_shufflevector(xy01, z01, 2, 3, 10, 11, 6, 7, 14, 15));
  store(2, __builtin_shufflevector(xy23, z23, 0, 1, 8, 9, 4, 5, 12, 13));
  store(3, __builtin_shufflevector(xy23, z23, 2, 3, 10, 11, 6, 7, 14, 15));
}

[[gnu::always_inline]] inline Vec<1, Narrow::Floats> gather_columns(const NarrowRow<1>* rows,
                                                                    const int* index) {
  Narrow::Floats lanes;
  for (int lane = 0; lane < Wide::size; ++lane) lanes[lane] = rows[index[lane]].c[0];
  return {lanes};
}
[[gnu::always_inline]] inline void scatter_columns(const Vec<1, Narrow::Floats>& columns, NarrowRow<1>* rows,
                                                   const int* index) {
  for (int lane = 0; lane < Wide::size; ++lane) rows[index[lane]].c[0] = columns[0][lane];
}

}  // namespace softgrain
