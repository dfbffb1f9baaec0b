#pragma once
#include <array>
#include <cstddef>

#include "softgrain/math/lanes.hpp"
#include "softgrain/soft/surface_patch.hpp"

namespace softgrain {

/// sum_k w_k value(at_k) of the first `count` vertices, an even number.
template <class Weights, class Value>
[[gnu::always_inline]] inline Lanes weighted_sum(int count, const std::array<int, 16>& at, const Weights& w,
                                                 int first, const Value& value) {
  Lanes even{}, odd{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); k += 2) {
    even += static_cast<double>(w[k]) * value(first + at[k]);
    odd += static_cast<double>(w[k + 1]) * value(first + at[k + 1]);
  }
  return even + odd;
}

/// What a value that vertices have is at a point, which is the vertex `begin` or the middle `own` of the
/// grain that begins there, less what it is at the place of the patch that it faces; without that at a wall.
/// value(vertex): Lanes.
template <class Value>
[[gnu::always_inline]] inline Lanes point_less_patch(const SurfacePoint* own, int begin,
                                                     const PatchNet* patch, int facing_begin,
                                                     const PatchWeights& weight, const Value& value) {
  Lanes sum =
      own == nullptr ? value(begin) : weighted_sum(own->count, own->vertex, own->weight, begin, value);
  if (patch != nullptr) sum -= weighted_sum(16, patch->vertex, weight, facing_begin, value);
  return sum;
}

}  // namespace softgrain
