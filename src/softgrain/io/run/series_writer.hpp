#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softgrain/io/format/file.hpp"
#include "softgrain/observe/columns.hpp"

namespace softgrain {

/// series.csv: a header `name[unit],name,...`, then one row per sample, each by one write(), every number
/// with the digits that give it back exactly. The first column is the step.
class SeriesWriter {
 public:
  /// Opens for appending; the header comes with the first row.
  explicit SeriesWriter(const std::filesystem::path& path);

  /// Raises UsageError when the columns are not those of the file.
  void write_row(const std::vector<Quantity>& row);
  void sync() { file_.sync(); }

 private:
  std::string header_;  ///< of the file; "" when it is empty
  AppendFile file_;
};

/// Makes a series that was cut off fit for going on after `last_step`: drops a torn last line and later rows.
void rewind_series(const std::filesystem::path& path, std::int64_t last_step);

/// The last complete row; none when there is no row or no file.
std::optional<std::vector<Quantity>> read_last_row(const std::filesystem::path& path);

}  // namespace softgrain
