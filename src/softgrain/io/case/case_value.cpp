#include "softgrain/io/case/case_value.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/list_text.hpp"
#include "softgrain/io/case/suggest.hpp"
#include "softgrain/io/case/units.hpp"

namespace softgrain {
namespace {

/// A value as the user gave it, for messages.
std::string shown(const TomlValue& value) {
  const auto show = [](const auto& content) -> std::string {
    using T = std::decay_t<decltype(content)>;
    if constexpr (std::is_same_v<T, std::monostate>)
      return "a date or time";
    else if constexpr (std::is_same_v<T, std::string>)
      return fmt::format("\"{}\"", content);
    else if constexpr (std::is_same_v<T, TomlValue::Array>)
      return "a list";
    else if constexpr (std::is_same_v<T, TomlValue::Table>)
      return "a table";
    else if constexpr (std::is_same_v<T, double>)
      return std::floor(content) == content && std::fabs(content) < 1e15 ? fmt::format("{:.1f}", content)
                                                                         : fmt::format("{}", content);
    else
      return fmt::format("{}", content);
  };
  return std::visit(show, value.content);
}

[[noreturn]] void wrong_type(const Key& key, const TomlValue& value) {
  throw UsageError(fmt::format("{} takes {}, as in {}; got {}", key.name, kind_in_words(key),
                               written_value(Case{}, key), shown(value)));
}

void check_range(const Key& key, double number, const TomlValue& value) {
  const Range& range = key.range;
  if (range.contains(number)) return;
  throw UsageError(fmt::format("{} = {} is out of range: it must be {}{}; the default is {}", key.name,
                               shown(value),
                               range.text().front() == '[' || range.text().front() == '(' ? "in " : "",
                               range.text(), written_value(Case{}, key)));
}

double read_number(const Key& key, const TomlValue& value) {
  double number = 0;
  const auto* word = std::get_if<std::string>(&value.content);
  if (word != nullptr && !key.zero_word.empty() && *word == key.zero_word) return 0;
  if (const auto* i = std::get_if<std::int64_t>(&value.content)) {
    number = static_cast<double>(*i);
  } else if (const auto* x = std::get_if<double>(&value.content)) {
    number = *x;
  } else if (const auto* text = std::get_if<std::string>(&value.content)) {
    try {
      number = parse_quantity(*text, parse_unit(key.unit).dimension);
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", key.name, error.what()));
    }
  } else {
    wrong_type(key, value);
  }
  require(std::isfinite(number), "{} must be finite, got {}", key.name, number);
  check_range(key, number, value);
  return number;
}

template <class Integer>
Integer read_integer(const Key& key, const TomlValue& value) {
  const auto* i = std::get_if<std::int64_t>(&value.content);
  const auto* text = std::get_if<std::string>(&value.content);
  const bool is_long = text != nullptr && text->size() > 18 &&  // beyond the whole numbers of TOML
                       text->find_first_not_of("0123456789") == std::string::npos;
  require(!is_long, "{} = {} is out of range: it must be at most {}", key.name, text->c_str(),
          std::numeric_limits<Integer>::max());
  if (i == nullptr) wrong_type(key, value);
  check_range(key, static_cast<double>(*i), value);
  require(*i >= std::numeric_limits<Integer>::min() && *i <= std::numeric_limits<Integer>::max(),
          "{} = {} is out of range: it must be at most {}", key.name, *i,
          std::numeric_limits<Integer>::max());
  return static_cast<Integer>(*i);
}

/// A list of numbers; empty if it is none.
std::vector<double> read_row(const Key& key, const TomlValue& value) {
  std::vector<double> numbers;
  if (const auto* items = std::get_if<TomlValue::Array>(&value.content))
    for (const TomlValue& item : *items) numbers.push_back(read_number(key, item));
  return numbers;
}

std::string shown_row(const TomlValue& value, const std::vector<double>& numbers) {
  return std::holds_alternative<TomlValue::Array>(value.content)
             ? fmt::format("[{}]", fmt::join(numbers, ", "))
             : shown(value);
}

/// [x, y, radius, angle] in SI, or with the number of its kind.
PlacedGrain read_grain(const Key& key, const TomlValue& value) {
  std::vector<double> numbers = read_row(key, value);
  if (numbers.size() == 4) numbers.push_back(0);
  constexpr double most_kinds = 1000;
  require(numbers.size() == 5 && numbers[2] > 0 && numbers[4] >= 0 && numbers[4] < most_kinds &&
              numbers[4] == std::floor(numbers[4]),
          "{} takes four numbers for each grain, [x, y, radius, angle] in m and rad, with radius > 0, or a "
          "fifth for "
          "its kind, from 0 on; got {}",
          key.name, shown_row(value, numbers));
  return {.centre = {numbers[0], numbers[1]},
          .radius = numbers[2],
          .angle = numbers[3],
          .kind = static_cast<int>(numbers[4])};
}

/// [x, y], or with a 1 at a corner.
OutlinePoint read_outline_point(const Key& key, const TomlValue& value) {
  std::vector<double> numbers = read_row(key, value);
  if (numbers.size() == 2) numbers.push_back(0);
  require(numbers.size() == 3 && (numbers[2] == 0 || numbers[2] == 1),
          "{} takes two numbers for each point, [x, y], and a third at a corner, 1; got {}", key.name,
          shown_row(value, numbers));
  return {{numbers[0], numbers[1]}, numbers[2] == 1};
}

/// [[[x, y, z], ...], [[i, j, k], ...]], or [] for none.
TriangleMesh read_mesh_lists(const Key& key, const TomlValue& value) {
  const auto* lists = std::get_if<TomlValue::Array>(&value.content);
  if (lists == nullptr) wrong_type(key, value);
  TriangleMesh mesh;
  if (lists->empty()) return mesh;
  const auto rows = [&](std::size_t k) {
    const auto* items = lists->size() == 2 ? std::get_if<TomlValue::Array>(&(*lists)[k].content) : nullptr;
    if (items == nullptr) wrong_type(key, value);
    std::vector<std::array<double, 3>> all;
    for (const TomlValue& item : *items) {
      const std::vector<double> row = read_row(key, item);
      require(row.size() == 3, "{} takes three numbers for each vertex and each triangle; got {}", key.name,
              shown_row(item, row));
      all.push_back({row[0], row[1], row[2]});
    }
    return all;
  };
  for (const auto& x : rows(0)) mesh.vertex.push_back({x[0], x[1], x[2]});
  const auto most = static_cast<double>(mesh.vertex.size());
  for (const auto& t : rows(1)) {
    for (const double v : t)
      require(v >= 0 && v < most && v == std::floor(v),
              "{}: a triangle names vertex {}, but there are {}, from 0 on", key.name, v, mesh.vertex.size());
    mesh.triangle.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
  }
  return mesh;
}

struct Assign {
  Case& the_case;
  const Key& key;
  const TomlValue& value;

  void operator()(MemberOf<bool> member) const {
    const bool* truth = std::get_if<bool>(&value.content);
    if (truth == nullptr) wrong_type(key, value);
    member(the_case) = *truth;
  }
  void operator()(MemberOf<int> member) const { member(the_case) = read_integer<int>(key, value); }
  void operator()(MemberOf<std::int64_t> member) const {
    member(the_case) = read_integer<std::int64_t>(key, value);
  }
  void operator()(MemberOf<double> member) const { member(the_case) = read_number(key, value); }
  void operator()(const WordMember& member) const {
    const auto* word = std::get_if<std::string>(&value.content);
    if (word == nullptr) wrong_type(key, value);
    if (!member.assign(the_case, *word))
      throw UsageError(fmt::format("{} takes {}, got '{}'{}", key.name, kind_in_words(key), *word,
                                   did_you_mean(*word, member.words())));
  }
  void operator()(MemberOf<std::vector<PlacedGrain>> member) const {
    const auto* items = std::get_if<TomlValue::Array>(&value.content);
    if (items == nullptr) wrong_type(key, value);
    std::vector<PlacedGrain> grains;
    for (const TomlValue& item : *items) grains.push_back(read_grain(key, item));
    member(the_case) = std::move(grains);
  }
  void operator()(MemberOf<std::vector<OutlinePoint>> member) const {
    const auto* items = std::get_if<TomlValue::Array>(&value.content);
    if (items == nullptr) wrong_type(key, value);
    std::vector<OutlinePoint> points;
    for (const TomlValue& item : *items) points.push_back(read_outline_point(key, item));
    if (!points.empty()) OutlineCurve{points};  // raises what is wrong with it
    member(the_case) = std::move(points);
  }
  void operator()(MemberOf<TriangleMesh> member) const {
    TriangleMesh mesh = read_mesh_lists(key, value);
    if (!mesh.triangle.empty()) StarSurface{mesh};  // raises what is wrong with it
    member(the_case) = std::move(mesh);
  }
  void operator()(MemberOf<std::vector<double>> member) const {
    if (!std::holds_alternative<TomlValue::Array>(value.content)) wrong_type(key, value);
    member(the_case) = read_row(key, value);
  }
};

/// Shortest digits that read back bit for bit; 1e-5, not 1e-05.
std::string shortest(double number) {
  std::string text = fmt::format("{}", number);
  if (text == "-0") return "-0.0";  // TOML's integers have no negative zero
  const auto exponent = text.find('e');
  if (exponent != std::string::npos && text[exponent + 2] == '0') text.erase(exponent + 2, 1);
  return text;
}

/// Shortest digits; always with a point or an exponent, so that TOML reads it as a float (-0.0 stays -0.0).
std::string float_text(double number) {
  const std::string text = shortest(number);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// `"5 mm"` where that reads back as exactly this number, otherwise the number in SI.
std::string quantity_text(double number, std::string_view unit) {
  if (unit.empty()) return shortest(number);
  const Unit parsed = parse_unit(unit);
  const std::string text = fmt::format("{:.15g} {}", in_unit(number, parsed), unit);
  return parse_quantity(text, parsed.dimension) == number ? fmt::format("\"{}\"", text)
                                                          : fmt::format("{}", number);
}

/// Writes any value, floats by `write_number`.
template <class WriteNumber>
std::string text_of(const Case& the_case, const Key& key, const WriteNumber& write_number) {
  Case copy = the_case;
  const auto write = [&](const auto& member) -> std::string {
    const auto& value = member(copy);
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, double>) {
      return value == 0 && !std::signbit(value) && !key.zero_word.empty()
                 ? fmt::format("\"{}\"", key.zero_word)
                 : write_number(value);
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      std::vector<std::string> items;
      for (const double item : value) items.push_back(write_number(item));
      return fmt::format("[{}]", fmt::join(items, ", "));
    } else if constexpr (std::is_same_v<T, std::vector<PlacedGrain>> ||
                         std::is_same_v<T, std::vector<OutlinePoint>> || std::is_same_v<T, TriangleMesh>) {
      return list_text(value, write_number);
    } else if constexpr (std::is_same_v<T, std::string_view>) {
      return fmt::format("\"{}\"", value);
    } else {
      return fmt::format("{}", value);
    }
  };
  return std::visit(write, key.member);
}

}  // namespace

void assign(Case& the_case, const Key& key, const TomlValue& value) {
  std::visit(Assign{the_case, key, value}, key.member);
}

std::string kind_in_words(const Key& key) {
  if (std::holds_alternative<MemberOf<bool>>(key.member)) return "true or false";
  if (const auto* enumerated = std::get_if<WordMember>(&key.member))
    return fmt::format("one of \"{}\"", fmt::join(enumerated->words(), "\", \""));
  if (std::holds_alternative<MemberOf<double>>(key.member))
    return (key.zero_word.empty() ? "" : fmt::format("\"{}\" or ", key.zero_word)) +
           in_words(parse_unit(key.unit).dimension);
  if (std::holds_alternative<MemberOf<std::vector<PlacedGrain>>>(key.member)) return "a list of grains";
  if (std::holds_alternative<MemberOf<std::vector<OutlinePoint>>>(key.member))
    return "the name of a file or a list of points";
  if (std::holds_alternative<MemberOf<TriangleMesh>>(key.member))
    return "the name of a file, or lists of vertices and triangles";
  if (!std::holds_alternative<MemberOf<std::vector<double>>>(key.member)) return "a whole number";
  return key.unit.empty() ? "a list of plain numbers"
                          : fmt::format("a list, each {}", in_words(parse_unit(key.unit).dimension));
}

std::string si_unit_of(const Key& key) { return si_unit(parse_unit(key.unit).dimension); }

std::string accepted(const Key& key) {
  const std::string range = key.range.text();
  return kind_in_words(key) + (range.empty() ? "" : ", " + range) +
         (range.empty() || key.unit.empty() ? "" : " " + si_unit_of(key));
}

std::string written_value(const Case& the_case, const Key& key) {
  return text_of(the_case, key, [&](double number) { return quantity_text(number, key.unit); });
}

std::string value_in_si(const Case& the_case, const Key& key) { return text_of(the_case, key, float_text); }

}  // namespace softgrain
