#include "softgrain/sample/diameters.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "softgrain/core/error.hpp"
#include "softgrain/math/random.hpp"

using namespace softgrain;

namespace {

/// Simpson's rule.
double integral(const std::function<double(double)>& f, double a, double b, int halves = 2000) {
  const double h = (b - a) / (2 * halves);
  double sum = f(a) + f(b);
  for (int k = 1; k < 2 * halves; ++k) sum += (k % 2 == 1 ? 4 : 2) * f(a + k * h);
  return sum * h / 3;
}

struct Moments {
  double mean, variance;
};

Moments moments_of(const std::vector<double>& numbers) {
  double mean = 0, variance = 0;
  for (const double number : numbers) mean += number / static_cast<double>(numbers.size());
  for (const double number : numbers)
    variance += (number - mean) * (number - mean) / static_cast<double>(numbers.size());
  return {mean, variance};
}

/// Of a lognormal law between two cut-offs, from its density alone.
Moments lognormal_moments(const DiameterLaw& law) {
  const auto density = [&](double d) {
    const double z = std::log(d / law.median) / law.deviation;
    return std::exp(-z * z / 2) / d;
  };
  const double whole = integral(density, law.smallest, law.largest);
  const double mean = integral([&](double d) { return d * density(d); }, law.smallest, law.largest) / whole;
  const auto square = [&](double d) { return (d - mean) * (d - mean) * density(d); };
  return {mean, integral(square, law.smallest, law.largest) / whole};
}

constexpr int many = 100000;

}  // namespace

TEST_CASE("uniform diameters have mean (a + b)/2 and variance (b - a)^2/12, bit for bit as ever") {
  const DiameterLaw law{.smallest = 1e-3, .largest = 4e-3};
  const std::vector<double> d = draw_diameters(law, many, 7, 0, 0);
  const auto [mean, variance] = moments_of(d);
  const double deviation = 3e-3 / std::sqrt(12.0);
  CHECK(std::abs(mean - 2.5e-3) < 4 * deviation / std::sqrt(many));
  CHECK(variance == doctest::Approx(deviation * deviation).epsilon(0.01));
  for (int i = 0; i < 100; ++i) CHECK(d[i] == 1e-3 + (4e-3 - 1e-3) * random_uniform(7, 0, i));
  CHECK(draw_diameters(law, 10, 7, 0, 20)[3] == 1e-3 + (4e-3 - 1e-3) * random_uniform(7, 0, 23));
}

TEST_CASE("lognormal diameters have the mean and variance of their density between the cut-offs") {
  for (const DiameterLaw& law : {DiameterLaw{SizeLaw::lognormal, 1e-3, 4e-3, 2e-3, 0.3},
                                 DiameterLaw{SizeLaw::lognormal, 1.9e-3, 2e-3, 2e-3, 0.5},
                                 DiameterLaw{SizeLaw::lognormal, 1e-6, 1, 2e-3, 0.1}}) {
    CAPTURE(law.deviation);
    const double widest = std::min(law.largest, law.median * std::exp(8 * law.deviation));
    DiameterLaw cut = law;  // the same, but for what no draw reaches
    cut.largest = widest;
    cut.smallest = std::max(law.smallest, law.median * std::exp(-8 * law.deviation));
    const Moments exact = lognormal_moments(cut);
    const std::vector<double> d = draw_diameters(law, many, 3, 0, 0);
    const Moments drawn = moments_of(d);
    CHECK(std::abs(drawn.mean - exact.mean) < 4 * std::sqrt(exact.variance / many));
    CHECK(drawn.variance == doctest::Approx(exact.variance).epsilon(0.03));
    CHECK(mean_diameter(law) == doctest::Approx(exact.mean).epsilon(1e-9));
    CHECK(mean_square_diameter(law) ==
          doctest::Approx(exact.variance + exact.mean * exact.mean).epsilon(1e-9));
    const auto [least, greatest] = std::ranges::minmax_element(d);
    CHECK(*least >= law.smallest);
    CHECK(*greatest <= law.largest);
  }
}

TEST_CASE("half of a lognormal law that is cut off far away lies below its median") {
  const DiameterLaw law{SizeLaw::lognormal, 1e-4, 1e-1, 2e-3, 0.4};
  const std::vector<double> d = draw_diameters(law, many, 1, 0, 0);
  const auto share_below = [&](double x) {
    return static_cast<double>(std::ranges::count_if(d, [&](double one) { return one < x; })) / many;
  };
  CHECK(share_below(2e-3) == doctest::Approx(0.5).epsilon(0.01));
  CHECK(share_below(2e-3 * std::exp(0.4)) == doctest::Approx(0.841345).epsilon(0.005));  // one sigma
  CHECK(share_below(2e-3 * std::exp(-0.8)) == doctest::Approx(0.022750).epsilon(0.05));  // two below
}

TEST_CASE("the same seed gives the same lognormal bits, another seed, stream or draw others") {
  const DiameterLaw law{SizeLaw::lognormal, 1e-3, 4e-3, 2e-3, 0.3};
  const auto draw = [&](std::uint64_t seed, std::uint32_t stream, int number) {
    return draw_diameters(law, 50, seed, stream, number);
  };
  CHECK(draw(1, 0, 0) == draw(1, 0, 0));
  CHECK(draw(1, 0, 0) != draw(2, 0, 0));
  CHECK(draw(1, 0, 0) != draw(1, 1, 0));
  CHECK(draw(1, 0, 0) != draw(1, 0, 1));
}

TEST_CASE("a list gives as many of each diameter as its proportions say, to one grain") {
  const DiameterLaw law{.law = SizeLaw::list, .diameters = {1e-3, 1.4e-3, 3e-3}, .numbers = {2, 1, 1}};
  const auto count = [](const std::vector<double>& d, double size) { return std::ranges::count(d, size); };
  const std::vector<double> d = draw_diameters(law, 400, 1, 0, 0);
  CHECK(count(d, 1e-3) == 200);
  CHECK(count(d, 1.4e-3) == 100);
  CHECK(count(d, 3e-3) == 100);
  const Moments drawn = moments_of(d);
  CHECK(drawn.mean == doctest::Approx((2 * 1.0 + 1.4 + 3) / 4 * 1e-3));
  CHECK(mean_diameter(law) == doctest::Approx(drawn.mean));
  CHECK(mean_square_diameter(law) == doctest::Approx(drawn.variance + drawn.mean * drawn.mean));
  const std::vector<double> five = draw_diameters(law, 5, 1, 0, 0);  // 2.5, 1.25, 1.25
  CHECK(five.size() == 5);
  CHECK(count(five, 1e-3) == 3);
  CHECK(law.least() == 1e-3);
  CHECK(law.greatest() == 3e-3);
}

TEST_CASE("a law of diameters that is none is refused") {
  CHECK_THROWS_AS(check(DiameterLaw{.smallest = 0}), UsageError);
  CHECK_THROWS_AS(check(DiameterLaw{.smallest = 3, .largest = 2}), UsageError);
  CHECK_THROWS_AS(check(DiameterLaw{SizeLaw::lognormal, 1, 2, 3, 0.1}), UsageError);
  CHECK_THROWS_AS(check(DiameterLaw{SizeLaw::lognormal, 1, 2, 1.5, 0}), UsageError);
  CHECK_THROWS_AS(check(DiameterLaw{.law = SizeLaw::list}), UsageError);
  CHECK_THROWS_AS(check(DiameterLaw{.law = SizeLaw::list, .diameters = {1, 2}, .numbers = {1}}), UsageError);
  CHECK_THROWS_AS(check(DiameterLaw{.law = SizeLaw::list, .diameters = {1}, .numbers = {0}}), UsageError);
  CHECK_NOTHROW(check(DiameterLaw{SizeLaw::lognormal, 1, 2, 1.5, 0.1}));
}
