#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "softgrain/core/processor.hpp"

using namespace softgrain;

namespace {

/// Both ways of the library against the C library's, bit for bit.
int differences(const EightFloats& a, const EightFloats& b, const EightFloats& c) {
  int different = 0;
  for (const EightFloats& result : {fused_by_doubles(a, b, c), fused_multiply_add(a, b, c)})
    for (int k = 0; k < 8; ++k) {
      const float expected = std::fma(a[k], b[k], c[k]);
      if (std::bit_cast<std::uint32_t>(float{result[k]}) != std::bit_cast<std::uint32_t>(expected))
        ++different;
    }
  return different;
}

}  // namespace

TEST_CASE("a product and a sum are rounded once, with and without the instruction") {
  std::mt19937 random(1);
  const auto any_float = [&](unsigned exponents) {
    const auto bits = static_cast<std::uint32_t>(random());
    const std::uint32_t exponent = 127 - exponents + (bits >> 8 & 0xff) % (2 * exponents + 1);
    return std::bit_cast<float>((static_cast<std::uint32_t>(random()) & 0x807fffffU) | exponent << 23);
  };
  int different = 0;
  for (int n = 0; n < 60000; ++n) {
    EightFloats a, b, c;
    for (int k = 0; k < 8; ++k) {
      const unsigned exponents = n % 3 == 0   ? 3
                                 : n % 3 == 1 ? 30
                                              : 62;  // up to those below the normal floats
      a[k] = any_float(exponents), b[k] = any_float(exponents), c[k] = any_float(exponents);
      if (n % 7 == 0) c[k] = -a[k] * b[k];  // what is left of a difference
    }
    different += differences(a, b, c);
  }
  CHECK(different == 0);
}

// c + 2^-24 - 2^-70 lies just below the middle of c and the next float; as a double it lies in it
TEST_CASE("a sum that two roundings would take to the wrong float goes to the right one") {
  const float tiny = 0x1p-23f;
  EightFloats a, b, c;
  for (int k = 0; k < 8; ++k) {
    a[k] = 1 + tiny;
    b[k] = (1 - tiny) * 0x1p-24f;
    c[k] = 1 + static_cast<float>(2 * k + 1) * tiny;
    CHECK(static_cast<float>(double{a[k]} * b[k] + c[k]) != std::fma(a[k], b[k], c[k]));
  }
  CHECK(differences(a, b, c) == 0);
  // below the normal floats the middle lies elsewhere
  for (int k = 0; k < 8; ++k)
    c[k] = static_cast<float>(2 * k + 1) * 0x1p-149f, a[k] = 0x1.8p-75f, b[k] = 0x1p-75f;
  CHECK(differences(a, b, c) == 0);
}
