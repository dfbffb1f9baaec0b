#pragma once
#include <cstring>
#include <type_traits>

#include "softgrain/math/lanes.hpp"

namespace softgrain {

/// A vector of space in the place of four numbers, the last of them 0: read and written in one go.
struct alignas(sizeof(Lanes)) PaddedVec : Vec<3> {
  double last = 0;

  PaddedVec() = default;
  PaddedVec(const Vec<3>& v) : Vec<3>(v) {}  // NOLINT: they are the same vector
};
static_assert(sizeof(PaddedVec) == sizeof(Lanes));

inline Lanes load_lanes(const PaddedVec& v) {
  Lanes lanes;
  std::memcpy(&lanes, &v, sizeof lanes);
  return lanes;
}
/// The last of the lanes is 0.
inline void store_lanes(Lanes lanes, PaddedVec& v) {
  std::memcpy(static_cast<void*>(&v), &lanes, sizeof lanes);
}

/// x, y, z and 0, of a vector that has no place for the 0.
inline Lanes load_lanes(const Vec<3>& v) { return Lanes{v[0], v[1], v[2], 0}; }
inline Vec<3> first_three(Lanes lanes) { return {lanes[0], lanes[1], lanes[2]}; }

/// A vector where many are read and written in no order.
template <int Dim>
using ScatteredVec = std::conditional_t<Dim == 3, PaddedVec, Vec<Dim>>;

}  // namespace softgrain
