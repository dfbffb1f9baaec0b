#include "softgrain/io/case/case_issues.hpp"

#include <fmt/core.h>

#include <algorithm>

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
