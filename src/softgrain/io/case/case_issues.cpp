#include "softgrain/io/case/case_issues.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>

namespace softgrain {
namespace {

/// The line of the file with a caret under the column; nothing where the line would flood or harm a terminal.
std::string source_line(std::string_view text, TextPosition at) {
  const std::string_view line = line_of(text, at.line);
  if (line.size() > 200 || !is_printable(line)) return "";
  std::string blank;  // a tab stays a tab, so that the caret stands where the terminal puts the column
  int column = 1;
  for (std::size_t i = 0; i < line.size() && column < at.column; ++i) {
    if ((static_cast<unsigned char>(line[i]) & 0xC0u) == 0x80u) continue;  // inside a UTF-8 character
    blank += line[i] == '\t' ? '\t' : ' ';
    ++column;
  }
  return fmt::format("{:5} | {}\n      | {}^\n", at.line, line, blank);
}

std::string shown(const Issue& issue, std::span<const Source> sources, std::span<const std::string> sets) {
  const auto& [set, at, source] = issue.origin;
  if (set >= 0)
    return fmt::format("--set {}: error: {}\n", sets[static_cast<std::size_t>(set)], issue.message);
  const Source& file = sources[static_cast<std::size_t>(source)];
  if (at.line == 0) return fmt::format("{}: error: {}\n", file.name, issue.message);
  return fmt::format("{}:{}:{}: error: {}\n", file.name, at.line, at.column, issue.message) +
         source_line(file.text, at);
}

}  // namespace

Origin last_origin(const std::vector<std::string>& keys, const std::map<std::string, Origin>& origins) {
  Origin last;
  for (const std::string& key : keys)
    if (const auto found = origins.find(key); found != origins.end()) last = std::max(last, found->second);
  return last;
}

std::size_t place_of_key(const std::string& key, std::string_view message) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789_";
  const auto is_letter = [&](std::size_t i) {
    return i < message.size() && letters.find(message[i]) != std::string_view::npos;
  };
  std::size_t at = message.find(key);
  while (at != std::string_view::npos && (is_letter(at + key.size()) || (at > 0 && is_letter(at - 1))))
    at = message.find(key, at + 1);
  return at;
}

Origin origin_of_fault(std::string_view message, const std::vector<std::string>& keys,
                       const std::map<std::string, Origin>& origins) {
  const auto is_named = [&](const std::string& key) {
    const std::string name = key.substr(key.find('.') + 1);  // alone, where it is no word of English
    const bool is_word = name.find_first_of("_0123456789") == std::string::npos;
    return place_of_key(is_word ? key : name, message) != std::string_view::npos;
  };
  std::vector<std::string> named;
  std::ranges::copy_if(keys, std::back_inserter(named), is_named);
  const Origin of_named = last_origin(named, origins);
  return of_named == Origin{} ? last_origin(keys, origins) : of_named;
}

std::string_view line_of(std::string_view text, int number) {
  if (number == 0) return "";
  for (int line = 1; line < number; ++line) text.remove_prefix(std::min(text.size(), text.find('\n') + 1));
  text = text.substr(0, text.find('\n'));
  return text.substr(0, text.find('\r'));
}

std::string report(std::vector<Issue> issues, std::span<const Source> sources,
                   std::span<const std::string> sets) {
  std::ranges::stable_sort(issues, [](const Issue& a, const Issue& b) { return a.origin < b.origin; });
  std::string text;
  for (const Issue& issue : issues) text += shown(issue, sources, sets);
  return text + fmt::format("{} error{}; nothing was run", issues.size(), issues.size() == 1 ? "" : "s");
}

}  // namespace softgrain
