#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A named array as files and scenes hold it, row-major: shape (rows, columns), columns = 1 for scalars.
struct Array {
  std::size_t columns = 1;
  std::variant<std::vector<double>, std::vector<std::int64_t>> values;
};

using Arrays = std::map<std::string, Array>;

/// What an array is, without its values.
struct ArrayShape {
  std::size_t rows = 0, columns = 1;
  bool integers = false;
};
using ArrayShapes = std::map<std::string, ArrayShape>;

inline ArrayShape shape_of(const Array& array) {
  const auto size = std::visit([](const auto& values) { return values.size(); }, array.values);
  return {.rows = size / array.columns, .columns = array.columns, .integers = array.values.index() == 1};
}

/// The numbers of vectors, row by row.
template <int N>
std::vector<double> flat_rows(const std::vector<Vec<N>>& rows) {
  std::vector<double> values;
  values.reserve(N * rows.size());
  for (const Vec<N>& row : rows) values.insert(values.end(), row.c.begin(), row.c.end());
  return values;
}

/// Vectors as an array of shape (rows, N).
template <int N>
Array to_array(const std::vector<Vec<N>>& rows) {
  return {N, flat_rows(rows)};
}

}  // namespace softgrain
