#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "softgrain/math/log_ratio.hpp"
#include "softgrain/math/random.hpp"
#include "softgrain/math/wide.hpp"

using namespace softgrain;

namespace {
/// Relative error of log(Wide) at x, against extended precision.
double log_error(double x) {
  const long double exact = std::log(static_cast<long double>(x));
  return static_cast<double>(std::abs((log(Wide(x))[7] - exact) / exact));
}
Wide one_to_eight() { return {Lanes{1, 2, 3, 4}, Lanes{5, 6, 7, 8}}; }
}  // namespace

TEST_CASE("the wide logarithm is right to the last bit but one from 1e-300 to 1e300") {
  double worst = 0;
  for (int k = 0; k < 200'000; ++k) {
    const double u = random_uniform(1, 0, static_cast<std::uint64_t>(k));
    worst = std::max(worst, log_error(std::pow(10.0, 600 * u - 300)));  // the whole range
    worst = std::max(worst, log_error(0.5 + u));                        // around 1
    worst = std::max(worst, log_error(1 + 1e-7 * (u - 0.5)));           // close to 1
  }
  CHECK(worst < 2.3e-16);
  CHECK(log(Wide(1.0))[0] == 0);
  CHECK(log_error(1 + 0x1p-52) < 2.3e-16);
  CHECK(log_error(1 - 0x1p-53) < 2.3e-16);
  CHECK(log_error(std::numeric_limits<double>::max()) < 2.3e-16);
  CHECK(log_error(std::numeric_limits<double>::min()) < 2.3e-16);
}

TEST_CASE("the wide logarithm of anything but a normal positive number is NaN, in its lane only") {
  Wide x = one_to_eight();
  x.set(0, -1.0);
  x.set(2, 0.0);
  x.set(3, 1e-310);
  x.set(5, std::numeric_limits<double>::infinity());
  x.set(6, std::numeric_limits<double>::quiet_NaN());
  const Wide y = log(x);
  for (const int lane : {0, 2, 3, 5, 6}) CHECK(std::isnan(y[lane]));
  for (const int lane : {1, 4, 7}) CHECK(y[lane] == doctest::Approx(std::log(lane + 1)).epsilon(1e-15));
}

TEST_CASE("wide arithmetic has the bits of scalar arithmetic in each lane") {
  const Wide a = one_to_eight(), b = 3.0 / a;
  Wide c = -a;
  c += b;
  c -= 0.1;
  c *= a + 1.5;
  const Wide root = sqrt(a);
  for (int lane = 0; lane < Wide::size; ++lane) {
    const double x = lane + 1;
    CHECK(b[lane] == 3.0 / x);
    CHECK(c[lane] == (-x + 3.0 / x - 0.1) * (x + 1.5));
    CHECK(root[lane] == std::sqrt(x));
    CHECK(max(a, Wide(4.5))[lane] == std::max(x, 4.5));
    CHECK(min(a, Wide(4.5))[lane] == std::min(x, 4.5));
    CHECK(select(a > b, a, b)[lane] == (x > 3.0 / x ? x : 3.0 / x));
  }
}

TEST_CASE("the exponential is that of the C library to three units of the last place, from end to end") {
  double worst = 0;
  for (int k = 0; k < 100000; ++k) {
    Wide x;
    for (int lane = 0; lane < Wide::size; ++lane) x.set(lane, -700.0 + 0.001753 * (Wide::size * k + lane));
    for (const double scale : {1.0, 1e-3, 1e-9}) {
      const Wide y = exp(scale * x);
      for (int lane = 0; lane < Wide::size; ++lane)
        worst = std::max(worst, std::abs(y[lane] / std::exp(scale * x[lane]) - 1));
    }
  }
  CHECK(worst < 4.5e-16);
  CHECK(exp(Wide(0.0))[3] == 1);
  CHECK(exp(Wide(-1000.0))[0] == 0);
  CHECK(std::isinf(exp(Wide(1000.0))[7]));
  CHECK(std::isnan(exp(Wide(std::numeric_limits<double>::quiet_NaN()))[1]));
}

TEST_CASE("any and all look at every lane") {
  for (int lane = 0; lane < Wide::size; ++lane) {
    Wide x(1.0);
    x.set(lane, -1.0);
    CHECK(any(x < Wide(0.0)));
    CHECK_FALSE(all(x < Wide(0.0)));
    CHECK(any(x >= Wide(1.0)));
    CHECK_FALSE(all(x >= Wide(1.0)));
    CHECK(all((x < Wide(0.0)) | (x > Wide(0.0))));
    CHECK_FALSE(any((x < Wide(0.0)) & (x > Wide(0.0))));
  }
  CHECK(all(Wide(1.0) <= Wide(1.0)));
  CHECK_FALSE(any(Wide(2.0) <= Wide(1.0)));
}

TEST_CASE("eight doubles come from memory in order, wherever they begin") {
  const std::vector<double> memory{-1, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const Wide eight = load_wide(memory.data() + 2);
  for (int lane = 0; lane < 8; ++lane) CHECK(eight[lane] == lane + 2);
}

TEST_CASE("the ratio of a difference of logarithms keeps its digits where both numbers meet") {
  for (double r = 1e-9; r < 0.95; r *= 1.03) {
    const long double z = static_cast<long double>(r * r), root = std::sqrt(z);
    const long double value = std::atanh(root) / root;
    const LogRatio<double> phi = log_ratio(r * r);
    const LogRatio<Wide> wide = log_ratio(Wide(r * r));
    CHECK(static_cast<double>(std::abs(phi.value / value - 1)) < 1e-15);
    CHECK(static_cast<double>(std::abs(wide.value[3] / value - 1)) < 1e-15);
    if (r > 0.1) {  // below, extended precision has too few digits for this form
      const long double slope = (1 / (1 - z) - value) / (2 * z);
      CHECK(static_cast<double>(std::abs(phi.derivative / slope - 1)) < 2e-14);
      CHECK(static_cast<double>(std::abs(wide.derivative[3] / slope - 1)) < 2e-14);
    } else {
      CHECK(phi.derivative ==
            doctest::Approx(1.0 / 3 + 2 * r * r / 5 + 3 * std::pow(r, 4) / 7).epsilon(1e-5));
    }
  }
  CHECK(log_ratio(0.0).value == 1);
  CHECK(log_ratio(0.0).derivative == 1.0 / 3);
}
