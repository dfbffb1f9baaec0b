#include "softgrain/io/case/units.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

struct NamedUnit {
  std::string_view name;
  Unit unit;
  bool takes_prefix;
};

constexpr std::array named_units{
    NamedUnit{"m", {{1, 0, 0}}, true},
    NamedUnit{"g", {{0, 1, 0}, -3}, true},
    NamedUnit{"s", {{0, 0, 1}}, true},
    NamedUnit{"Hz", {{0, 0, -1}}, true},
    NamedUnit{"N", {{1, 1, -2}}, true},
    NamedUnit{"Pa", {{-1, 1, -2}}, true},
    NamedUnit{"J", {{2, 1, -2}}, true},
    NamedUnit{"W", {{2, 1, -3}}, true},
    NamedUnit{"bar", {{-1, 1, -2}, 5}, true},
    NamedUnit{"min", {{0, 0, 1}, 0, 60}, false},
    NamedUnit{"h", {{0, 0, 1}, 0, 3600}, false},
    NamedUnit{"%", {{}, -2}, false},
    NamedUnit{"rad", {}, false},
    NamedUnit{"deg", {{}, 0, std::numbers::pi / 180}, false},
};

struct Prefix {
  std::string_view name;
  int exponent;
};

// no-break, narrow no-break and thin space: what word processors and typists put between number and unit
constexpr std::array<std::string_view, 4> blanks{" ", "\u00a0", "\u202f", "\u2009"};

constexpr std::string_view micro_sign = "\u00b5", greek_mu = "\u03bc";
constexpr std::array prefixes{Prefix{"n", -9}, Prefix{"u", -6}, Prefix{micro_sign, -6}, Prefix{greek_mu, -6},
                              Prefix{"m", -3}, Prefix{"c", -2}, Prefix{"d", -1},        Prefix{"da", 1},
                              Prefix{"h", 2},  Prefix{"k", 3},  Prefix{"M", 6},         Prefix{"G", 9},
                              Prefix{"T", 12}, Prefix{"p", -12}};

struct NamedDimension {
  Dimension dimension;
  std::string_view words;
  std::string_view unit;  // the coherent one of SI
};

constexpr std::array named_dimensions{
    NamedDimension{{0, 0, 0}, "a plain number", ""},
    NamedDimension{{1, 0, 0}, "a length", "m"},
    NamedDimension{{2, 0, 0}, "an area", "m^2"},
    NamedDimension{{0, 1, 0}, "a mass", "kg"},
    NamedDimension{{0, 0, 1}, "a time", "s"},
    NamedDimension{{0, 0, -1}, "a frequency", "Hz"},
    NamedDimension{{1, 0, -1}, "a velocity", "m/s"},
    NamedDimension{{1, 0, -2}, "an acceleration", "m/s^2"},
    NamedDimension{{-3, 1, 0}, "a mass density", "kg/m^3"},
    NamedDimension{{-1, 1, 0}, "a mass per length", "kg/m"},
    NamedDimension{{1, 1, -2}, "a force", "N"},
    NamedDimension{{0, 1, -2}, "a force per length", "N/m"},
    NamedDimension{{-1, 1, -2}, "a stress", "Pa"},
    NamedDimension{{2, 1, -2}, "an energy", "J"},
    NamedDimension{{-1, 1, -1}, "a viscosity", "Pa s"},
};

/// a b^power.
Unit times_power(const Unit& a, const Unit& b, int power) {
  const Dimension& d = b.dimension;
  return {{a.dimension.length + power * d.length, a.dimension.mass + power * d.mass,
           a.dimension.time + power * d.time},
          a.exponent + power * b.exponent,
          a.factor * std::pow(b.factor, power)};
}

/// product = factor { ("/" | "*" | " ") factor };  factor = "1" | ( name | "(" product ")" ) [ power ].
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text), rest_(text) {}

  Unit parse() {
    require(text_.size() <= 60, "the unit is too long");
    const Unit unit = product();
    require(rest_.empty(), "cannot read the unit '{}'", text_);
    return unit;
  }

 private:
  Unit product() {
    Unit result = factor();
    for (skip_spaces(); !rest_.empty() && rest_.front() != ')'; skip_spaces()) {
      const int sign = take("/") ? -1 : 1;
      if (sign > 0 && !take("*")) take("\u00b7");
      skip_spaces();
      result = times_power(result, factor(), sign);
    }
    return result;
  }

  Unit factor() {
    if (take("1")) return {};
    const Unit unit = base();
    const Unit raised = times_power({}, unit, power());
    const Dimension& d = raised.dimension;
    const int largest =
        std::max({std::abs(d.length), std::abs(d.mass), std::abs(d.time), std::abs(raised.exponent)});
    require(largest <= 100, "cannot read the unit '{}': the power is out of range", text_);
    return raised;
  }

  Unit base() {
    if (!take("(")) return named(name());
    skip_spaces();
    const Unit inner = product();
    require(take(")"), "cannot read the unit '{}': ')' is missing", text_);
    return inner;
  }

  int power() {
    if (take("\u00b2")) return 2;
    if (take("\u00b3")) return 3;
    const bool marked = take("^") || take("**");
    int value = 1;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    require(!marked || error == std::errc(), "cannot read the unit '{}': a whole power is missing", text_);
    require(-9 <= value && value <= 9, "cannot read the unit '{}': the power is out of range", text_);
    if (error == std::errc()) rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  std::string_view name() {
    const std::string_view start = rest_;
    const auto is_letter = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%';
    };
    while (take(micro_sign) || take(greek_mu) || (!rest_.empty() && is_letter(rest_.front()) && skip(1))) {
    }
    require(start.size() > rest_.size(), "cannot read the unit '{}'", text_);
    return start.substr(0, start.size() - rest_.size());
  }

  static Unit named(std::string_view name) {
    for (const NamedUnit& unit : named_units)
      if (name == unit.name) return unit.unit;
    for (const Prefix& prefix : prefixes)
      for (const NamedUnit& unit : named_units)
        if (unit.takes_prefix && name.starts_with(prefix.name) &&
            name.substr(prefix.name.size()) == unit.name)
          return {unit.unit.dimension, unit.unit.exponent + prefix.exponent, unit.unit.factor};
    throw UsageError(fmt::format("unknown unit '{}'; {}", name, advice(name)));
  }

  /// The unit that differs in capitals alone, or all there are.
  static std::string advice(std::string_view name) {
    const auto same = [&](const std::string& candidate) {
      return std::equal(name.begin(), name.end(), candidate.begin(), candidate.end(), [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
      });
    };
    std::string with_prefix, without;
    for (const NamedUnit& unit : named_units) {
      std::string& list = unit.takes_prefix ? with_prefix : without;
      list += fmt::format("{}{}", list.empty() ? "" : ", ", unit.name);
      if (same(std::string(unit.name))) return fmt::format("did you mean '{}'?", unit.name);
    }
    for (const Prefix& prefix : prefixes)
      for (const NamedUnit& unit : named_units)
        if (const auto candidate = fmt::format("{}{}", prefix.name, unit.name);
            unit.takes_prefix && name.front() == prefix.name.front() && same(candidate))
          return fmt::format("did you mean '{}'?", candidate);
    return fmt::format("units are {} (and with prefixes, as in mm or kPa), {}", with_prefix, without);
  }

  bool skip(std::size_t n) {
    rest_.remove_prefix(n);
    return true;
  }
  bool take(std::string_view token) { return rest_.starts_with(token) && skip(token.size()); }
  void skip_spaces() {
    while (std::any_of(blanks.begin(), blanks.end(), [&](std::string_view blank) { return take(blank); })) {
    }
  }

  std::string_view text_;
  std::string_view rest_;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t count_digits(std::string_view text) {
  return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) - text.begin());
}

std::string_view trimmed(std::string_view text) {
  for (bool found = true; found;) {
    found = false;
    for (const std::string_view blank : blanks) {
      if (text.starts_with(blank)) text.remove_prefix(blank.size()), found = true;
      if (text.ends_with(blank)) text.remove_suffix(blank.size()), found = true;
    }
  }
  return text;
}

/// A quantity's text taken apart: mantissa * 10^exponent, unit.
struct QuantityText {
  std::string_view mantissa;
  int exponent = 0;
  std::string_view unit;
};

QuantityText take_apart(std::string_view text) {
  const std::string_view all = text = trimmed(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  std::size_t n = text.starts_with('-') ? 1 : 0;
  std::size_t digits = count_digits(text.substr(n));
  n += digits;
  if (text.substr(n).starts_with('.')) {
    const std::size_t decimals = count_digits(text.substr(n + 1));
    n += 1 + decimals;
    digits += decimals;
  }
  require(digits > 0, "'{}' is not a number with a unit", all);
  if (text.substr(n).starts_with(','))
    if (const std::size_t decimals = count_digits(text.substr(n + 1)); decimals > 0)
      throw UsageError(fmt::format("'{}' has a decimal comma; decimals stand behind a point, as in {}.{}",
                                   all, text.substr(0, n), text.substr(n + 1, decimals)));
  QuantityText result;
  result.mantissa = text.substr(0, n);
  text.remove_prefix(n);
  if (text.starts_with('e') || text.starts_with('E')) {
    const bool plus = text.substr(1).starts_with('+');
    const char* begin = text.data() + (plus ? 2 : 1);
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), result.exponent);
    require(error != std::errc::result_out_of_range, "'{}' is out of range", all);
    if (error == std::errc()) text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  result.unit = trimmed(text);
  return result;
}

/// mantissa * 10^exponent, correctly rounded.
double decimal(std::string_view mantissa, long exponent) {
  const std::string text = fmt::format("{}e{}", mantissa, exponent);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc() && end == text.data() + text.size(), "'{}' is out of range", text);
  return value;
}

}  // namespace

Unit parse_unit(std::string_view text) {
  text = trimmed(text);
  return text.empty() ? Unit{} : UnitParser(text).parse();
}

double parse_quantity(std::string_view text, const Dimension& expected) {
  const QuantityText parts = take_apart(text);
  const Unit unit = parse_unit(parts.unit);
  require(!parts.unit.empty() || expected == Dimension{},
          "'{}' has no unit; {} is written with its unit, as in \"{} {}\"", text, in_words(expected),
          parts.mantissa, si_unit(expected));
  require(unit.dimension == expected, "unit '{}' has the wrong dimension for {}{}", parts.unit,
          in_words(expected), expected == Dimension{} ? "" : fmt::format(" [{}]", si_unit(expected)));
  const double value =
      decimal(parts.mantissa, static_cast<long>(parts.exponent) + unit.exponent) * unit.factor;
  require(std::isfinite(value), "'{}' is out of range", text);
  return value;
}

double in_unit(double value, const Unit& unit) {
  const double power = std::pow(10.0, std::abs(unit.exponent));
  return (unit.exponent < 0 ? value * power : value / power) / unit.factor;
}

std::string in_words(const Dimension& dimension) {
  for (const NamedDimension& named : named_dimensions)
    if (named.dimension == dimension) return std::string(named.words);
  return "a quantity in " + si_unit(dimension);
}

std::string si_unit(const Dimension& dimension) {
  for (const NamedDimension& named : named_dimensions)
    if (named.dimension == dimension) return std::string(named.unit);
  return fmt::format("kg^{} m^{} s^{}", dimension.mass, dimension.length, dimension.time);
}

}  // namespace softgrain
