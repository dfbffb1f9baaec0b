#pragma once
#include <array>

#include "softgrain/math/lanes.hpp"

namespace softgrain {

/// Rows of four numbers as columns, and back.
inline std::array<Lanes, 4> transpose_rows(Lanes row0, Lanes row1, Lanes row2, Lanes row3) {
  const Lanes xz01 = __builtin_shufflevector(row0, row1, 0, 4, 2, 6),
              yw01 = __builtin_shufflevector(row0, row1, 1, 5, 3, 7),
              xz23 = __builtin_shufflevector(row2, row3, 0, 4, 2, 6),
              yw23 = __builtin_shufflevector(row2, row3, 1, 5, 3, 7);
  return {__builtin_shufflevector(xz01, xz23, 0, 1, 4, 5), __builtin_shufflevector(yw01, yw23, 0, 1, 4, 5),
          __builtin_shufflevector(xz01, xz23, 2, 3, 6, 7), __builtin_shufflevector(yw01, yw23, 2, 3, 6, 7)};
}

}  // namespace softgrain
