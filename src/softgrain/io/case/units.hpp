#pragma once
#include <string>
#include <string_view>

namespace softgrain {

/// Powers of metre, kilogram and second. All zero: a plain number.
struct Dimension {
  int length = 0;
  int mass = 0;
  int time = 0;

  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// One unit = factor * 10^exponent in SI. The power of ten is kept apart so that "0.9 mm" reads as exactly
/// the number 0.9e-3, correctly rounded.
struct Unit {
  Dimension dimension;
  int exponent = 0;
  double factor = 1;
};

/// Reads "m/s", "kg/m^3", "MPa", "N m^-1", "J/(kg K)": names with SI prefixes (micro: u or its letter),
/// products (space, *), quotients (each / takes the next factor), whole powers (^3, **3, 3). "" is a plain
/// number. Raises UsageError.
Unit parse_unit(std::string_view text);

/// Reads a number and its unit, "0.2 m/s", and returns it in SI. The unit is required unless `expected` is a
/// plain number. Raises UsageError: not a number, not finite, unknown unit, wrong dimension.
double parse_quantity(std::string_view text, const Dimension& expected);

/// `value` [SI] in `unit`: the inverse of reading it.
double in_unit(double value, const Unit& unit);

/// "a velocity", "a force per length", or the powers themselves where the dimension has no name.
std::string in_words(const Dimension& dimension);

/// The coherent SI unit: "m/s", "Pa", "" for a plain number.
std::string si_unit(const Dimension& dimension);

}  // namespace softgrain
