#include "softgrain/math/log_inverse.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softgrain;

TEST_CASE("ln x and 1/x near one and far from it, side by side, to 1e-15") {
  double worst = 0;
  for (double x = 1e-3; x < 1e3; x *= 1.003) {
    const std::array<double, 3> numbers{1 + (x - 1) * 1e-4, x, 1};
    const auto [log_x, inverse] = log_inverse(numbers);
    for (std::size_t k = 0; k < 3; ++k) {
      worst = std::max(worst,
                       std::abs(log_x[k] - std::log(numbers[k])) / std::abs(std::log(numbers[k]) + 1e-300));
      worst = std::max(worst, std::abs(inverse[k] * numbers[k] - 1));
    }
  }
  CHECK(worst < 1e-15);
}

TEST_CASE("ln x and 1/x of a number do not depend on its neighbours") {
  for (const double x : {0.4, 0.75, 1.0, 1.3, 2.0}) {
    Wide lanes(x);
    lanes.set(5, 1e-5);  // far from one
    const auto beside = log_inverse(std::array{lanes, Wide(1.1)});
    const auto alone = log_inverse(std::array{Wide(x)});
    CHECK(beside.log[0][4] == alone.log[0][4]);
    CHECK(beside.inverse[0][4] == alone.inverse[0][4]);
  }
}

TEST_CASE("the logarithm of what is not positive is not a number") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double x : {0.0, -1.0, nan}) {
    Wide lanes(1.0);
    lanes.set(2, x);
    const auto result = log_inverse(std::array{lanes});
    CHECK(std::isnan(result.log[0][2]));
    CHECK(result.log[0][1] == 0);
  }
}
