#include "softgrain/io/case/sample_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/csv_cells.hpp"
#include "softgrain/io/case/suggest.hpp"
#include "softgrain/io/case/units.hpp"

namespace softgrain {
namespace {

constexpr std::size_t most_issues = 20;
const std::vector<std::string> column_names{"x", "y", "radius", "angle", "kind", "z"};
enum Column { x, y, radius, angle, kind, z };

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
    const int behind = for_each_csv_line(text, [&](int number, std::string_view line) {
      line_ = number;
      if (!is_printable(line))
        add(1, "not text: a sample's file is UTF-8 without control characters");
      else if (columns_.empty())
        read_header(line);
      else if (!has_header_issue_)
        read_grain(line);
      return result_.issues.size() < most_issues;
    });
    line_ = behind;
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
    for (const CsvCell& cell : csv_cells(line)) read_column(cell);
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
  void read_column(const CsvCell& cell) {
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
    const std::vector<CsvCell> cells = csv_cells(line);
    if (cells.size() != columns_.size()) return add(1, wrong_count(cells.size(), columns_.size()));
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

  bool read_cell(const CsvCell& cell, const ColumnOfFile& column, PlacedGrain& grain, double& height) {
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

  bool read_kind(const CsvCell& cell, PlacedGrain& grain) {
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
