#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/observe/observation.hpp"

namespace softgrain {

/// Which runs have a column.
enum class ColumnGroup { every_run, boxes, bonded, elastic };

/// A column of series.csv.
struct Column {
  std::string_view name;
  std::string_view unit;  ///< SI, "" for none
  ColumnGroup group;
  /// One sentence of Markdown with formulas, for docs/observables.md; that of the column before where empty.
  std::string_view text;
  std::optional<double> (*value)(const Observation&);  ///< nothing: the run has no such column
};

/// Every column that a run can have, in their order.
std::span<const Column> all_columns();

/// One number of a row of series.csv.
struct Quantity {
  std::string name;
  std::string unit;  ///< SI, "" for none
  double value = 0;
};

/// The row of an observation: the columns that it has.
std::vector<Quantity> row_of(const Observation& observation);

}  // namespace softgrain
