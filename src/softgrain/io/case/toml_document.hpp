#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "softgrain/core/error.hpp"

namespace softgrain {

/// Line and column of a text, both from 1; columns count characters, not bytes. Line 0 means nowhere.
struct TextPosition {
  int line = 0;
  int column = 0;

  friend auto operator<=>(const TextPosition&, const TextPosition&) = default;
};

struct TomlMember;

/// One value of a document. Dates and times, which no key takes, are std::monostate.
struct TomlValue {
  using Array = std::vector<TomlValue>;
  using Table = std::vector<TomlMember>;

  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table> content;
  TextPosition at;
};

struct TomlMember {
  std::string key;
  TextPosition at;  ///< of the key
  TomlValue value;
};

/// The first place where a text stops being TOML.
struct TomlError : UsageError {
  TomlError(TextPosition position, const std::string& message) : UsageError(message), at(position) {}
  TextPosition at;
};

/// Whether a line is UTF-8 without control characters (tabs are fine), so that it can be shown on a terminal.
bool is_printable(std::string_view line);

/// Reads TOML 1.0. Safe on any bytes: raises TomlError on text that is not UTF-8, on control characters, on
/// more than 1 MB, lines of more than 1000 bytes and arrays nested more than 8 deep.
TomlValue::Table parse_toml(std::string_view text);

}  // namespace softgrain
