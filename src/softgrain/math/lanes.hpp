#pragma once
#include <cstring>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Four doubles worked on at once (compiler vectors, both g++ and clang; no instruction set is named).
/// Arithmetic is element by element, so that each lane has the very bits of scalar code.
using Lanes = double __attribute__((vector_size(32)));
inline constexpr int lane_count = 4;

inline Lanes splat(double value) { return Lanes{value, value, value, value}; }

/// Four consecutive doubles from memory, without alignment.
inline Lanes load_lanes(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

/// Two columns of four rows: x and y of four vectors.
struct LaneColumns {
  Lanes x, y;
};

namespace detail {
using Pair = double __attribute__((vector_size(16)));

inline Pair load_pair(const Vec<2>& from) {
  Pair pair;
  std::memcpy(&pair, from.c.data(), sizeof pair);
  return pair;
}
inline LaneColumns transpose(Lanes rows02, Lanes rows13) {
  return {__builtin_shufflevector(rows02, rows13, 0, 4, 2, 6),
          __builtin_shufflevector(rows02, rows13, 1, 5, 3, 7)};
}
}  // namespace detail

/// Rows index[0..3] of an array of vectors, as columns.
inline LaneColumns gather_columns(const Vec<2>* rows, const int* index) {
  const auto row = [&](int lane) { return detail::load_pair(rows[index[lane]]); };
  return detail::transpose(__builtin_shufflevector(row(0), row(2), 0, 1, 2, 3),
                           __builtin_shufflevector(row(1), row(3), 0, 1, 2, 3));
}

/// The inverse of gather_columns: all four indices must differ, or hold the same row.
inline void scatter_columns(const LaneColumns& columns, Vec<2>* rows, const int* index) {
  const Lanes rows02 = __builtin_shufflevector(columns.x, columns.y, 0, 4, 2, 6);
  const Lanes rows13 = __builtin_shufflevector(columns.x, columns.y, 1, 5, 3, 7);
  const auto store = [&](int lane, detail::Pair pair) {
    std::memcpy(rows[index[lane]].c.data(), &pair, sizeof pair);
  };
  store(0, __builtin_shufflevector(rows02, rows02, 0, 1));
  store(1, __builtin_shufflevector(rows13, rows13, 0, 1));
  store(2, __builtin_shufflevector(rows02, rows02, 2, 3));
  store(3, __builtin_shufflevector(rows13, rows13, 2, 3));
}

/// Four consecutive rows as columns, and back.
inline LaneColumns load_columns(const Vec<2>* rows) {
  const Lanes rows01 = load_lanes(rows[0].c.data());
  const Lanes rows23 = load_lanes(rows[2].c.data());
  return detail::transpose(__builtin_shufflevector(rows01, rows23, 0, 1, 4, 5),
                           __builtin_shufflevector(rows01, rows23, 2, 3, 6, 7));
}
inline void store_columns(const LaneColumns& columns, Vec<2>* rows) {
  const int index[] = {0, 1, 2, 3};
  scatter_columns(columns, rows, index);
}

inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }

inline double horizontal_sum(Lanes a) { return (a[0] + a[1]) + (a[2] + a[3]); }
inline double horizontal_max(Lanes a) {
  const double low = a[0] > a[1] ? a[0] : a[1], high = a[2] > a[3] ? a[2] : a[3];
  return low > high ? low : high;
}

}  // namespace softgrain
