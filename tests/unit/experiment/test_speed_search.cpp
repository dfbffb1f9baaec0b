#include "softgrain/experiment/speed_search.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

using namespace softgrain;

namespace {

struct Result {
  double v;
  int tries;
};

Result search(const std::function<double(double)>& excess, double v, double slope = 0) {
  SpeedSearch search(1, 1e-3, slope);
  int tries = 1;
  while (!search.found(v, excess(v))) v = search.next(), ++tries;
  return {v, tries};
}

}  // namespace

TEST_CASE("the speed is found at which a contact that closes late and is stiff bears what it is asked to") {
  for (const double stiffness : {1.0, 1e2, 1e4})
    for (const double closes : {-0.3, 0.0, 0.02, 0.9}) {
      const auto excess = [&](double v) { return stiffness * std::max(0.0, v - closes) - 1; };
      const double expected = std::min(1.0, closes + 1 / stiffness);
      for (const double start : {-1.0, 0.0, 1.0}) {
        const Result result = search(excess, start);
        CHECK(result.v == doctest::Approx(expected).epsilon(2e-3));
        CHECK(result.tries < 24);
      }
    }
}

TEST_CASE("a slope that is known gives the speed at the second or third try") {
  const auto excess = [](double v) { return 50 * v - 1; };
  CHECK(search(excess, 0, 50).tries <= 3);
  CHECK(search(excess, 0.02, 50).tries == 1);
}

TEST_CASE("where no speed within the bounds will do, the bound is taken, and over a jump the better side") {
  CHECK(search([](double) { return -1.0; }, 0).v == 1);
  CHECK(search([](double) { return 1.0; }, 0).v == -1);
  const Result jump = search([](double v) { return v < 0.1 ? -0.5 : 2.0; }, 0);
  CHECK(jump.v == doctest::Approx(0.1).epsilon(0.05));
  CHECK(jump.v < 0.1);
}
