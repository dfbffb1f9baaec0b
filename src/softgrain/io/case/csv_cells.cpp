#include "softgrain/io/case/csv_cells.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace softgrain {
namespace {

int characters(std::string_view text) {
  return static_cast<int>(std::ranges::count_if(
      text, [](char letter) { return (static_cast<unsigned char>(letter) & 0xC0u) != 0x80u; }));
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

std::vector<CsvCell> csv_cells(std::string_view line) {
  std::vector<CsvCell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view cell = line.substr(begin, end - begin), text = without_blanks(cell);
    const std::size_t start = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
    cells.push_back({text, 1 + characters(line.substr(0, start))});
    begin = end + 1;
  }
  return cells;
}

std::string wrong_count(std::size_t cells, std::size_t columns) {
  return fmt::format("{} values, but {} columns: numbers have a decimal point, and commas stand between them",
                     cells, columns);
}

int for_each_csv_line(std::string_view text, const std::function<bool(int, std::string_view)>& visit) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  int number = 1;
  for (; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::string_view content = without_blanks(line);
    if (content.empty() || content.front() == '#') continue;
    if (!visit(number, line)) return number + 1;
  }
  return number;
}

}  // namespace softgrain
