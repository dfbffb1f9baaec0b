#include "softgrain/io/case/outline_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/csv_cells.hpp"
#include "softgrain/io/case/placement.hpp"
#include "softgrain/io/case/suggest.hpp"
#include "softgrain/io/case/units.hpp"

namespace softgrain {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_issues = 20;
const std::vector<std::string> column_names{"x", "y", "corner"};
enum Column { x, y, corner };

class Reader {
 public:
  OutlineText read(std::string_view text) {
    for_each_csv_line(text, [&](int number, std::string_view line) {
      line_ = number;
      if (!is_printable(line))
        add(1, "not text: the file of an outline is UTF-8 without control characters");
      else if (columns_.empty())
        read_header(line);
      else
        read_point(line);
      return result_.issues.size() < most_issues && !columns_.empty();
    });
    if (result_.issues.empty()) finish();
    return std::move(result_);
  }

 private:
  void add(int column, std::string message) {
    if (result_.issues.size() < most_issues) result_.issues.push_back({{line_, column}, std::move(message)});
  }

  /// "x [mm], y [mm], corner".
  void read_header(std::string_view line) {
    std::vector<Column> columns;
    for (const CsvCell& cell : csv_cells(line)) {
      const std::string name{without_blanks(cell.text.substr(0, cell.text.find('[')))};
      const auto found = std::ranges::find(column_names, name);
      if (found == column_names.end())
        return add(cell.column, fmt::format("unknown column '{}'{}; columns are {}", name,
                                            did_you_mean(name, column_names), fmt::join(column_names, ", ")));
      const auto column = static_cast<Column>(found - column_names.begin());
      if (has(columns, column)) return add(cell.column, fmt::format("column '{}' stands twice", name));
      columns.push_back(column);
    }
    for (const Column needed : {x, y})
      if (!has(columns, needed))
        return add(1,
                   fmt::format("no column '{}': the first line names the columns, as in 'x [mm], y [mm]' or "
                               "'x, y, corner'",
                               column_names[needed]));
    columns_ = columns;
  }

  static bool has(const std::vector<Column>& columns, Column column) {
    return std::ranges::find(columns, column) != columns.end();
  }

  void read_point(std::string_view line) {
    const std::vector<CsvCell> cells = csv_cells(line);
    if (cells.size() != columns_.size()) return add(1, wrong_count(cells.size(), columns_.size()));
    std::array<double, 3> number{};
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const Column column = columns_[k];
      try {
        number[column] = parse_quantity(std::string(cells[k].text), {});
      } catch (const UsageError&) {
        return add(cells[k].column,
                   fmt::format("{} = '{}' is not a number", column_names[column], cells[k].text));
      }
      if (column == corner && number[corner] != 0 && number[corner] != 1)
        return add(cells[k].column,
                   fmt::format("corner = {} must be 1, or 0 where the outline is smooth", cells[k].text));
    }
    if (result_.points.size() == most_outline_points)
      return add(1, fmt::format("not yet: more than {} points in an outline", most_outline_points));
    result_.points.push_back({{number[x], number[y]}, number[corner] == 1});
    result_.lines.push_back(line_);
  }

  void finish() {
    std::vector<OutlinePoint>& points = result_.points;
    if (points.size() > 1 && points.front().x == points.back().x) points.pop_back(), result_.lines.pop_back();
    if (points.size() < 3)
      return add(1,
                 fmt::format("an outline needs at least 3 points, got {}: a line for each, under the line of "
                             "columns 'x, y'",
                             points.size()));
    if (const auto [first, second] = crossing_edges(points); first >= 0) {
      line_ = result_.lines[static_cast<std::size_t>(second)];
      return add(1,
                 fmt::format("the edge from here to the next point crosses or touches that from line {}: the "
                             "points stand in their order along an outline that does not cross itself",
                             result_.lines[static_cast<std::size_t>(first)]));
    }
    if (!has(columns_, corner)) find_corners(points);
  }

  std::vector<Column> columns_;
  int line_ = 1;
  OutlineText result_;
};

}  // namespace

OutlineText read_outline_text(std::string_view text) { return Reader().read(text); }

TomlValue outline_of_file(const std::string& name, Origin origin, CaseDraft& draft) {
  TomlValue list{TomlValue::Array{}, {}};
  OutlineText text;
  fs::path path = name;
  if (origin.set < 0) path = fs::path(draft.sources->front().name).parent_path() / path;
  try {
    std::error_code unknown;
    require(!name.empty() && (!fs::exists(path, unknown) || fs::is_regular_file(path, unknown)),
            "{} is not a file", path.string());
    draft.sources->push_back({path.string(), read_limited(path.string(), "the file of an outline")});
    text = read_outline_text(draft.sources->back().text);
  } catch (const UsageError& error) {
    draft.add(origin, fmt::format("grain.outline: {}", error.what()));
    draft.invalid.insert("grain.outline");
  }
  const int source = static_cast<int>(draft.sources->size()) - 1;
  for (const SampleIssue& issue : text.issues) draft.add({.at = issue.at, .source = source}, issue.message);
  if (!text.issues.empty()) draft.invalid.insert("grain.outline"), text.points.clear();
  draft.outline = {source, text.lines};
  for (const OutlinePoint& point : text.points) {
    TomlValue::Array row{TomlValue{point.x[0], {}}, TomlValue{point.x[1], {}}};
    if (point.corner) row.push_back({std::int64_t{1}, {}});
    std::get<TomlValue::Array>(list.content).push_back({row, {}});
  }
  return list;
}

}  // namespace softgrain
