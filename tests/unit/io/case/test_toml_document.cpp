#include <doctest/doctest.h>

#include <string>
#include <variant>

#include "softgrain/io/case/toml_document.hpp"

using namespace softgrain;

namespace {

/// Reads bytes that may be anything; false when they are refused in the orderly way.
bool is_toml(std::string_view text) {
  try {
    parse_toml(text);
    return true;
  } catch (const TomlError&) {
    return false;
  }
}

}  // namespace

TEST_CASE("every key and value knows its line and column") {
  const auto document = parse_toml("# comment\n[grain]\n  radius = \"5 mm\"\nlist = [1, 2.5]\n");
  REQUIRE(document.size() == 1);
  CHECK(document[0].key == "grain");
  const auto& members = std::get<TomlValue::Table>(document[0].value.content);
  REQUIRE(members.size() == 2);
  const TomlMember& list = members[0].key == "list" ? members[0] : members[1];
  const TomlMember& radius = members[0].key == "list" ? members[1] : members[0];
  CHECK(radius.at == TextPosition{3, 3});
  CHECK(radius.value.at == TextPosition{3, 12});
  CHECK(std::get<std::string>(radius.value.content) == "5 mm");
  const auto& items = std::get<TomlValue::Array>(list.value.content);
  REQUIRE(items.size() == 2);
  CHECK(std::get<std::int64_t>(items[0].content) == 1);
  CHECK(std::get<double>(items[1].content) == 2.5);
  CHECK(items[1].at == TextPosition{4, 12});
}

TEST_CASE("hostile bytes are refused, never a crash") {
  const std::string deep(100000, '[');
  std::string deep_lines;
  for (int i = 0; i < 100000; ++i) deep_lines += "[\n";
  std::string dotted = "a";
  for (int i = 0; i < 100000; ++i) dotted += ".a";
  CHECK_FALSE(is_toml(std::string_view("[\0", 2)));
  CHECK_FALSE(is_toml(std::string_view("a = \"\0\"", 7)));
  CHECK_FALSE(is_toml("\u03bc = 0.5"));
  CHECK_FALSE(is_toml("\u2000 = 1"));
  CHECK_FALSE(is_toml("[\uffff]"));
  CHECK_FALSE(is_toml("a = " + deep));
  CHECK_FALSE(is_toml("a = " + deep_lines));
  CHECK_FALSE(is_toml(dotted + " = 1"));
  CHECK_FALSE(is_toml("a = '\x1b[31m'"));      // escape sequence of a terminal
  CHECK_FALSE(is_toml("a = '\xc2\x9b[31m'"));  // the same in one character
  CHECK_FALSE(is_toml("a = '\xff\xfe'"));
  CHECK_FALSE(is_toml("a = '\xc0\xaf'"));      // overlong
  CHECK_FALSE(is_toml("a = '\xed\xa0\x80'"));  // half of a surrogate pair
  CHECK_FALSE(is_toml("a = '\xf4\x90\x80\x80'"));
  CHECK_FALSE(is_toml("a = '\xe2\x82"));
  CHECK_FALSE(is_toml("a = 1\rb = 2"));
  CHECK_FALSE(is_toml(std::string(1'000'001, '\n')));
  CHECK_FALSE(is_toml("a = 1\na = 2"));
  CHECK(is_toml(""));
  CHECK(is_toml("\xef\xbb\xbf# with a byte order mark\na = 1\r\n"));
  CHECK(is_toml("a = '\u00b5 \u20ac \U0001f600'"));
}

TEST_CASE("an error tells where the text stops being TOML") {
  try {
    parse_toml("a = 1\nb = = 2\n");
    FAIL("taken");
  } catch (const TomlError& error) {
    CHECK(error.at.line == 2);
  }
}
