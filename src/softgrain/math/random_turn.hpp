#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "softgrain/math/random.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A rotation of which all are as likely, the i-th under a seed in a stream (Shoemake 1992).
inline Mat<3> random_turn(std::uint64_t seed, std::uint32_t stream, std::uint64_t i) {
  const auto random = [&](std::uint64_t k) { return random_uniform(seed, stream, 3 * i + k); };
  const double u = random(0), a = 2 * std::numbers::pi * random(1), b = 2 * std::numbers::pi * random(2);
  const double x = std::sqrt(1 - u) * std::sin(a), y = std::sqrt(1 - u) * std::cos(a),
               z = std::sqrt(u) * std::sin(b), w = std::sqrt(u) * std::cos(b);
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),  //
           2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),  //
           2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
}

}  // namespace softgrain
