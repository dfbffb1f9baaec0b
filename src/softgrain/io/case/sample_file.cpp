#include "softgrain/io/case/sample_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/suggest.hpp"
#include "softgrain/io/case/units.hpp"

namespace softgrain {
namespace {

constexpr std::size_t most_issues = 20;
const std::vector<std::string> column_names{"x", "y", "radius", "angle", "kind", "z"};
enum Column { x, y, radius, angle, kind, z };

struct Cell {
  std::string_view text;  // without blanks around it
  int column = 1;         // where it begins in its line, in characters
};

int characters(std::string_view text) {
  return static_cast<int>(std::ranges::count_if(
      text, [](char letter) { return (static_cast<unsigned char>(letter) & 0xC0u) != 0x80u; }));
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

std::vector<Cell> cells_of(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view cell = line.substr(begin, end - begin), text = without_blanks(cell);
    const std::size_t start = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
    cells.push_back({text, 1 + characters(line.substr(0, start))});
    begin = end + 1;
  }
  return cells;
}

/// One column of the file: which it is, and the unit of its numbers.
struct ColumnOfFile {
  Column column;
  std::string unit;

  Dimension dimension() const { return {.length = column == angle || column == kind ? 0 : 1}; }
};

class Reader {
 public:
  Reader(const std::vector<std::string>& kinds, int dimension) : kinds_(kinds), is_solid_(dimension == 3) {}

  SampleText read(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // with which spreadsheets begin
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    for (; !text.empty() && result_.issues.size() < most_issues; ++line_) {
      std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(text.size(), line.size() + 1));
      if (line.ends_with('\r')) line.remove_suffix(1);
      const std::string_view content = without_blanks(line);
      if (content.empty() || content.front() == '#') continue;
      if (!is_printable(line))
        add(1, "not text: a sample's file is UTF-8 without control characters");
      else if (columns_.empty())
        read_header(line);
      else if (!has_header_issue_)
        read_grain(line);
    }
    if (result_.grains.empty() && result_.issues.empty())
      add(1, fmt::format("no grains: a line for each, under the line of columns {}", example()));
    return std::move(result_);
  }

 private:
  std::string example() const {
    return is_solid_ ? "'x [mm], y [mm], z [mm], radius [mm]'" : "'x [mm], y [mm], radius [mm]'";
  }

  void add(int column, std::string message) {
    if (result_.issues.size() < most_issues) result_.issues.push_back({{line_, column}, std::move(message)});
  }

  void read_header(std::string_view line) {
    const std::size_t before = result_.issues.size();
    for (const Cell& cell : cells_of(line)) read_column(cell);
    for (const Column needed : {x, y, z, radius})
      if ((needed != z || is_solid_) &&
          std::ranges::find(columns_, needed, &ColumnOfFile::column) == columns_.end() &&
          result_.issues.size() == before)
        add(1, fmt::format("no column '{}': the first line names the columns, as in {}", column_names[needed],
                           example()));
    if (kinds_.size() > 1 && std::ranges::find(columns_, kind, &ColumnOfFile::column) == columns_.end() &&
        result_.issues.size() == before)
      add(1, fmt::format("no column 'kind', but the case has several [[kind]]: '{}'",
                         fmt::join(kinds_, "', '")));
    has_header_issue_ = result_.issues.size() > before;
    if (columns_.empty()) columns_.push_back({kind, ""});  // the header is read
  }

  /// "radius [mm]".
  void read_column(const Cell& cell) {
    const std::size_t bracket = cell.text.find('[');
    const std::string name{without_blanks(cell.text.substr(0, bracket))};
    const auto found = std::ranges::find(column_names, name);
    if (found == column_names.end())
      return add(cell.column, fmt::format("unknown column '{}'{}; columns are {}", name,
                                          did_you_mean(name, column_names), fmt::join(column_names, ", ")));
    const auto column = static_cast<Column>(found - column_names.begin());
    if (column == z && !is_solid_)
      return add(cell.column, "column 'z' belongs to experiment.dimension = 3: leave it out");
    if (column == angle && is_solid_)
      return add(cell.column,
                 "not yet: column 'angle' in space, where sample.seed turns each sphere: leave it out");
    if (std::ranges::find(columns_, column, &ColumnOfFile::column) != columns_.end())
      return add(cell.column, fmt::format("column '{}' stands twice", name));
    ColumnOfFile read{column, column == angle || column == kind ? "" : "m"};
    if (bracket != std::string_view::npos) {
      const std::string_view unit = cell.text.substr(bracket + 1, cell.text.find(']') - bracket - 1);
      try {
        require(cell.text.ends_with(']') && parse_unit(unit).dimension == read.dimension(),
                "its unit is none of {}", column == angle ? "an angle: rad or deg" : "a length");
      } catch (const UsageError& error) {
        return add(cell.column, fmt::format("column '{}': {}", cell.text, error.what()));
      }
      read.unit = unit;
    }
    columns_.push_back(read);
  }

  void read_grain(std::string_view line) {
    const std::vector<Cell> cells = cells_of(line);
    if (cells.size() != columns_.size())
      return add(1, fmt::format("{} values, but {} columns: numbers have a decimal point, and commas stand "
                                "between them",
                                cells.size(), columns_.size()));
    PlacedGrain grain;
    double height = 0;
    bool valid = true;
    for (std::size_t k = 0; k < cells.size(); ++k)
      valid = read_cell(cells[k], columns_[k], grain, height) && valid;
    if (!valid) return;
    if (result_.grains.size() == most_placed_grains)
      return add(1, fmt::format("not yet: more than {} grains in a file", most_placed_grains));
    result_.grains.push_back(grain);
    if (is_solid_) result_.z.push_back(height);
    result_.lines.push_back(line_);
  }

  bool read_cell(const Cell& cell, const ColumnOfFile& column, PlacedGrain& grain, double& height) {
    const std::string& name = column_names[column.column];
    if (column.column == kind) return read_kind(cell, grain);
    double value = 0;
    try {
      value = parse_quantity(fmt::format("{} {}", cell.text, column.unit), column.dimension());
    } catch (const UsageError&) {
      add(cell.column, fmt::format("{} = '{}' is not a number; its unit stands in the first line, as in {}",
                                   name, cell.text, example()));
      return false;
    }
    if (column.column == radius && !(value > 0)) {
      add(cell.column, fmt::format("radius = {} must be > 0", cell.text));
      return false;
    }
    (column.column == x       ? grain.centre[0]
     : column.column == y     ? grain.centre[1]
     : column.column == z     ? height
     : column.column == angle ? grain.angle
                              : grain.radius) = value;
    return true;
  }

  bool read_kind(const Cell& cell, PlacedGrain& grain) {
    if (kinds_.size() == 1 && kinds_.front().empty()) kinds_.front() = cell.text;
    const auto found = std::ranges::find(kinds_, cell.text);
    grain.kind = static_cast<int>(found - kinds_.begin());
    if (found != kinds_.end()) return true;
    add(cell.column, fmt::format("kind = '{}' is the name of no [[kind]]: the case has '{}'", cell.text,
                                 fmt::join(kinds_, "', '")));
    return false;
  }

  std::vector<std::string> kinds_;
  bool is_solid_;
  std::vector<ColumnOfFile> columns_;
  bool has_header_issue_ = false;
  int line_ = 1;
  SampleText result_;
};

}  // namespace

SampleText read_sample_text(std::string_view text, const std::vector<std::string>& kinds, int dimension) {
  return Reader(kinds, dimension).read(text);
}

}  // namespace softgrain
