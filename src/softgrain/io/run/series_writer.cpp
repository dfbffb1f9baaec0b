#include "softgrain/io/run/series_writer.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "softgrain/core/error.hpp"

namespace softgrain {

namespace fs = std::filesystem;

namespace {

std::string header_of(const std::vector<Quantity>& row) {
  std::string header;
  for (const Quantity& quantity : row) {
    if (!header.empty()) header += ',';
    header += quantity.unit.empty() ? quantity.name : fmt::format("{}[{}]", quantity.name, quantity.unit);
  }
  return header;
}

/// The lines that have their newline, without it; the file's torn rest is left out.
std::vector<std::string_view> complete_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  return lines;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const auto end = line.find(',', begin);
    fields.push_back(line.substr(begin, end - begin));
    if (end == std::string_view::npos) return fields;
    begin = end + 1;
  }
}

/// The numbers of a row; nothing when the line is not one of `columns` numbers.
std::optional<std::vector<double>> numbers_of(std::string_view line, std::size_t columns) {
  std::vector<double> numbers;
  for (const std::string_view field : fields_of(line)) {
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size()) return std::nullopt;
    numbers.push_back(value);
  }
  if (numbers.size() != columns) return std::nullopt;
  return numbers;
}

Quantity parse_heading(std::string_view heading) {
  const auto bracket = heading.find('[');
  if (bracket == std::string_view::npos) return {std::string(heading), "", 0};
  return {std::string(heading.substr(0, bracket)),
          std::string(heading.substr(bracket + 1, heading.size() - bracket - 2)), 0};
}

}  // namespace

SeriesWriter::SeriesWriter(const fs::path& path) : file_(path) {
  const std::string text = read_file(path);
  const auto lines = complete_lines(text);
  if (!lines.empty()) header_ = lines.front();
}

void SeriesWriter::write_row(const std::vector<Quantity>& row) {
  const std::string header = header_of(row);
  if (header_.empty()) file_.append(header + "\n");
  require(header_.empty() || header == header_,
          "the columns of series.csv differ from those that this version writes; resume with the version "
          "that began the run\n"
          "  series:  {}\n  program: {}",
          header_, header);
  header_ = header;
  std::string line;
  for (const Quantity& quantity : row) line += fmt::format("{}{}", line.empty() ? "" : ",", quantity.value);
  file_.append(line + "\n");
}

void rewind_series(const fs::path& path, std::int64_t last_step) {
  if (!fs::exists(path)) return;
  const std::string text = read_file(path);
  std::size_t kept = 0, columns = 0;
  for (const std::string_view line : complete_lines(text)) {
    if (columns == 0) {
      columns = fields_of(line).size();
    } else {
      const auto row = numbers_of(line, columns);
      if (!row || row->front() > static_cast<double>(last_step)) break;
    }
    kept += line.size() + 1;
  }
  fs::resize_file(path, kept);
}

std::optional<std::vector<Quantity>> read_last_row(const fs::path& path) {
  if (!fs::exists(path)) return std::nullopt;
  const std::string text = read_file(path);
  const auto lines = complete_lines(text);
  if (lines.size() < 2) return std::nullopt;
  std::vector<Quantity> row;
  for (const std::string_view heading : fields_of(lines.front())) row.push_back(parse_heading(heading));
  const auto numbers = numbers_of(lines.back(), row.size());
  if (!numbers) return std::nullopt;
  for (std::size_t k = 0; k < row.size(); ++k) row[k].value = (*numbers)[k];
  return row;
}

}  // namespace softgrain
