#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/units.hpp"

using namespace softgrain;

namespace {

constexpr Dimension plain{}, length{1, 0, 0}, duration{0, 0, 1}, velocity{1, 0, -1}, density{-3, 1, 0},
    force_per_length{0, 1, -2}, stress{-1, 1, -2};

/// The message with which a quantity is refused, or "" when it is taken.
std::string refusal(const std::string& text, const Dimension& expected) {
  try {
    parse_quantity(text, expected);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

bool mentions(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

}  // namespace

TEST_CASE("a quantity is read in SI, whatever the unit it is written in") {
  CHECK(parse_quantity("10 MPa", stress) == 10e6);
  CHECK(parse_quantity("10 N/mm^2", stress) == 10e6);
  CHECK(parse_quantity("1.5 kg m^-1 s^-2", stress) == 1.5);
  CHECK(parse_quantity("2 bar", stress) == 2e5);
  CHECK(parse_quantity("0.2 m/s", velocity) == 0.2);
  CHECK(parse_quantity("3.6 km/h", velocity) == doctest::Approx(1).epsilon(1e-15));
  CHECK(parse_quantity("5 mm", length) == 5e-3);
  CHECK(parse_quantity("-5mm", length) == -5e-3);
  CHECK(parse_quantity("+5e2 um", length) == 5e-4);
  CHECK(parse_quantity("1e+3 nm", length) == 1e-6);
  CHECK(parse_quantity(" .5 us ", duration) == 0.5e-6);
  CHECK(parse_quantity("2 min", duration) == 120);
  CHECK(parse_quantity("100 N/m", force_per_length) == 100);
  CHECK(parse_quantity("100 J/m^2", force_per_length) == 100);
  CHECK(parse_quantity("990 kg/m^3", density) == 990);
  CHECK(parse_quantity("990 kg/m3", density) == 990);
  CHECK(parse_quantity("990 kg/(m^2 m)", density) == 990);
  CHECK(parse_quantity("1 g/cm**3", density) == 1000);
  CHECK(parse_quantity("990 kg/m\u00b3", density) == 990);
  CHECK(parse_quantity("90 deg", plain) == std::numbers::pi / 2);
  CHECK(parse_quantity("10 %", plain) == 0.1);
  CHECK(parse_quantity("0.3", plain) == 0.3);
}

TEST_CASE("micro is u, the micro sign or the Greek letter") {
  CHECK(parse_quantity("3 us", duration) == 3e-6);
  CHECK(parse_quantity("3 \u00b5s", duration) == 3e-6);
  CHECK(parse_quantity("3 \u03bcs", duration) == 3e-6);
}

TEST_CASE("a prefix costs no digit: 0.9 mm is the number nearest to 0.0009") {
  CHECK(0.9 * 1e-3 != 0.9e-3);  // why a product is not good enough
  CHECK(parse_quantity("0.9 mm", length) == 0.9e-3);
  CHECK(parse_quantity("1.7 us", duration) == 1.7e-6);
  CHECK(parse_quantity("1.1e-3 kPa", stress) == 1.1);
}

TEST_CASE("a wrong dimension is refused with the expected one in words") {
  CHECK(mentions(refusal("0.2 m", velocity), "unit 'm' has the wrong dimension for a velocity [m/s]"));
  CHECK(mentions(refusal("100 N", force_per_length), "a force per length [N/m]"));
  CHECK(mentions(refusal("1 m", plain), "a plain number"));
  CHECK(mentions(refusal("1 kg m/s", density), "a mass density"));
}

TEST_CASE("a blank may be one that does not break, as word processors write it") {
  for (const char* blank : {" ", "\u00a0", "\u202f", "\u2009"}) {
    CHECK(parse_quantity(std::string("5") + blank + "mm", length) == 0.005);
    CHECK(parse_quantity(std::string("5") + blank + "N" + blank + "m" + blank, {2, 1, -2}) == 5);
  }
}

TEST_CASE("an unknown unit gets the one with other capitals, or the list, and a decimal comma a word") {
  constexpr Dimension stress{-1, 1, -2};
  CHECK(mentions(refusal("10 Mpa", stress), "unknown unit 'Mpa'; did you mean 'MPa'?"));
  CHECK(mentions(refusal("10 mpa", stress), "did you mean 'mPa'?"));
  CHECK(mentions(refusal("10 MM", length), "unknown unit 'MM'"));
  CHECK(mentions(refusal("1000 psi", stress), "units are m, g, s, Hz, N, Pa, J, W, bar (and with prefixes"));
  CHECK(mentions(refusal("0,5 mm", length),
                 "'0,5 mm' has a decimal comma; decimals stand behind a point, as in 0.5"));
}

TEST_CASE("what is no number or no unit is refused") {
  CHECK(mentions(refusal("1 parsec", length), "unknown unit 'parsec'"));
  CHECK(mentions(refusal("1 kmin", duration), "unknown unit 'kmin'"));
  CHECK(mentions(refusal("5", length), "has no unit"));
  CHECK(mentions(refusal("5 m^99", length), "the power is out of range"));
  CHECK(mentions(refusal("5 (((m^9)^9)^9)^9", length), "the power is out of range"));
  CHECK(mentions(refusal("5 1/m^-2147483648", length), "the power is out of range"));
  for (const char* text : {"",
                           " ",
                           "mm",
                           "inf m",
                           "nan m",
                           "--5 m",
                           "+-5 m",
                           ".",
                           "1.2.3 m",
                           "0x10 m",
                           "1e999 m",
                           "1e-999 m",
                           "1e99999999999 m",
                           "1e300 Tm^9/m^8",
                           "5 m^",
                           "5 m^99",
                           "5 (m",
                           "5 m)",
                           "5 m//s",
                           "5 /",
                           "5 m*",
                           "5 10 m",
                           "5 m^1.5",
                           "1 \xff",
                           "5 ((((((((((m^9)^9)^9)^9)^9)^9)^9)^9)^9)^9"})
    CHECK_MESSAGE(!refusal(text, length).empty(), text);
}

TEST_CASE("in_unit undoes reading") {
  CHECK(in_unit(5e-3, parse_unit("mm")) == 5);
  CHECK(in_unit(12e6, parse_unit("MPa")) == 12);
  CHECK(in_unit(7200, parse_unit("h")) == 2);
  CHECK(in_unit(3, parse_unit("")) == 3);
}

TEST_CASE("the SI unit of every named dimension reads back as that dimension") {
  for (const Dimension& dimension : {plain, length, duration, velocity, density, force_per_length, stress,
                                     Dimension{2, 1, -2}, Dimension{1, 0, -2}, Dimension{5, 3, -7}}) {
    const Unit unit = parse_unit(si_unit(dimension));
    CHECK(unit.dimension == dimension);
    CHECK(unit.exponent == 0);
  }
}
