#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace softgrain {

/// A value between commas.
struct CsvCell {
  std::string_view text;  ///< without blanks around it
  int column = 1;         ///< where it begins in its line, in characters
};

std::string_view without_blanks(std::string_view text);

std::vector<CsvCell> csv_cells(std::string_view line);

/// What is said of a line with more or fewer cells than there are columns.
std::string wrong_count(std::size_t cells, std::size_t columns);

/// visit(number from 1, line) of all lines that are not blank and do not begin with #, until it says false. A
/// byte order mark, with which spreadsheets begin, and line ends of any kind are left out. Returns the number
/// of the line behind the last.
int for_each_csv_line(std::string_view text, const std::function<bool(int, std::string_view)>& visit);

}  // namespace softgrain
