#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/io/run/progress.hpp"

using namespace softgrain;

TEST_CASE("the progress line names what tells most about the run, in units that people read") {
  const std::vector<Quantity> row{
      {"step", "", 12}, {"strain", "", 0.12345}, {"stress_top", "Pa", 83123}, {"sweeps", "", 23.4}};
  CHECK(progress_text(0.439, row, 3720) ==
        " 43 %  strain 0.123  stress_top 83.1 kPa  sweeps 23.4  ETA 1 h 02 min");
  CHECK(progress_text(0, {}, std::nan("")) == "  0 %  ETA -");
}

TEST_CASE("durations, counts and values are short") {
  CHECK(duration_text(4.6) == "5 s");
  CHECK(duration_text(200) == "3 min 20 s");
  CHECK(grouped(30012) == "30 012");
  CHECK(grouped(-1234567) == "-1 234 567");
  CHECK(grouped(-123456) == "-123 456");
  CHECK(grouped(999) == "999");
  CHECK(short_value({"t", "s", -2.5e-7}) == "-250 ns");
  CHECK(short_value({"s", "Pa", 0}) == "0 Pa");
  CHECK(short_value({"s", "Pa", 1e12}) == "1e+03 GPa");
}
