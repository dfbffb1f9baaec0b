#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Vectors as a row-major array of a checkpoint or scene, shape (rows, N).
template <int N>
Array to_array(std::span<const Vec<N>> rows) {
  std::vector<double> values;
  values.reserve(N * rows.size());
  for (const Vec<N>& row : rows) values.insert(values.end(), row.c.begin(), row.c.end());
  return {N, std::move(values)};
}

/// The inverse, into `rows`. Raises IoError, naming the array, unless it has this size and finite numbers.
/// Files of earlier versions may hold fewer rows, but `least`; the others keep their values.
template <int N>
void from_array(const Checkpoint& checkpoint, const std::string& name, std::vector<Vec<N>>& rows,
                std::size_t least = std::numeric_limits<std::size_t>::max()) {
  const auto found = checkpoint.arrays.find(name);
  const auto* values =
      found == checkpoint.arrays.end() ? nullptr : std::get_if<std::vector<double>>(&found->second.values);
  const std::size_t fewest = std::min(least, rows.size());
  if (values == nullptr || values->size() % N != 0 || values->size() < N * fewest ||
      values->size() > N * rows.size())
    throw IoError(fmt::format("the checkpoint has no array '{}' of {} rows: it belongs to another case", name,
                              rows.size()));
  for (const double value : *values)
    if (!std::isfinite(value))
      throw IoError(fmt::format("the checkpoint's array '{}' holds {}", name, value));
  for (std::size_t i = 0; i < values->size() / N; ++i)
    for (int k = 0; k < N; ++k) rows[i][k] = (*values)[N * i + k];
}

}  // namespace softgrain
