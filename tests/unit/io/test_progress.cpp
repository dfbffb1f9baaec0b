#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/io/progress.hpp"
#include "softgrain/io/run_json.hpp"

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

TEST_CASE("the verdict says 100 % only when every step converged") {
  RunReport report{
      .steps = 30012, .steps_converged = 30011, .sweeps = 1, .residual_max = 3e-4, .overlap_max = 2e-5};
  CHECK(verdict(report, 2e-5) ==
        "converged 99.9 % of 30 012 steps, worst residual 3e-04 (tolerance 2e-05), worst overlap 2e-05 of a "
        "radius");
  report.steps_converged = report.steps;
  CHECK(verdict(report, 2e-5).starts_with("converged 100.0 %"));
}
