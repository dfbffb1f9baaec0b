#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "softgrain/math/random.hpp"

using namespace softgrain;

using Words = std::array<std::uint32_t, 4>;

TEST_CASE("philox gives the known answers of Random123 for philox4x32-10") {
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  constexpr std::uint32_t ones = 0xffffffff;
  CHECK(philox({ones, ones, ones, ones}, {ones, ones}) ==
        Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  // the digits of pi
  CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("a uniform number holds the first 53 bits of philox") {
  // 0x6627e8d5e169c58d >> 11 from the known answer for counter 0 and key 0
  CHECK(random_uniform(0, 0, 0) == 0x6627e8d5e169c58dull / 2048 * std::ldexp(1.0, -53));
}

TEST_CASE("seed, stream and index each lead to other numbers with all their bits") {
  const std::uint64_t high = std::uint64_t{1} << 32;
  const std::array numbers{random_uniform(1, 2, 3),        random_uniform(1 + high, 2, 3),
                           random_uniform(1, 2, 3 + high), random_uniform(1, 3, 3),
                           random_uniform(2, 2, 3),        random_uniform(1, 2, 4)};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK(numbers[i] != numbers[j]);
}

TEST_CASE("uniform numbers lie between 0 and 1 with mean 1/2 and variance 1/12") {
  const int count = 100000;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double u = random_uniform(42, 0, i);
    REQUIRE(u >= 0);
    REQUIRE(u < 1);
    sum += u, squares += u * u;
  }
  const double mean = sum / count, variance = squares / count - mean * mean;
  CHECK(std::abs(mean - 0.5) < 4 * std::sqrt(1.0 / 12 / count));  // four standard errors
  CHECK(std::abs(variance - 1.0 / 12) < 4 * std::sqrt(1.0 / 180 / count));
}
