#include "softgrain/state/archive.hpp"

#include <cmath>

#include "softgrain/core/error.hpp"

namespace softgrain {

void StateWriter::reals(const Field& field, std::vector<double>& values, std::size_t columns, Length) {
  arrays[std::string(field.name)] = {columns, values};
}

void StateWriter::integers(const Field& field, std::vector<std::int64_t>& values, std::size_t columns,
                           Length) {
  arrays[std::string(field.name)] = {columns, values};
}

template <class T>
void StateReader::read(const Field& field, std::vector<T>& values, std::size_t columns, Length length) const {
  const auto found = arrays_.find(std::string(field.name));
  const auto* stored = found == arrays_.end() ? nullptr : std::get_if<std::vector<T>>(&found->second.values);
  if (stored == nullptr || found->second.columns != columns ||
      (length == Length::fixed ? stored->size() != values.size() : stored->size() % columns != 0))
    throw IoError(
        fmt::format("the snapshot has no array '{}' of {} numbers a row{}: it belongs to another case, or to "
                    "another version "
                    "of softgrain; begin the run anew with --force",
                    field.name, columns,
                    length == Length::fixed ? fmt::format(" and {} rows", values.size() / columns) : ""));
  for (const T value : *stored)
    if (!std::isfinite(static_cast<double>(value)))
      throw IoError(fmt::format("the snapshot's array '{}' holds {}", field.name, value));
  values = *stored;
}

void StateReader::reals(const Field& field, std::vector<double>& values, std::size_t columns, Length length) {
  read(field, values, columns, length);
}

void StateReader::integers(const Field& field, std::vector<std::int64_t>& values, std::size_t columns,
                           Length length) {
  read(field, values, columns, length);
}

void StateLister::reals(const Field& field, std::vector<double>&, std::size_t columns, Length) {
  fields.push_back({field, columns, false});
}

void StateLister::integers(const Field& field, std::vector<std::int64_t>&, std::size_t columns, Length) {
  fields.push_back({field, columns, true});
}

}  // namespace softgrain
