#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "softgrain/experiment/simulation.hpp"

namespace softgrain::fuzz {

/// Takes numbers off the front of some bytes; zeros when there are no more.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof value, rest_.size());
    std::memcpy(&value, rest_.data(), size);
    rest_.remove_prefix(size);
    return value;
  }
  /// 0 .. count - 1
  std::size_t below(std::size_t count) { return take<std::uint16_t>() % count; }

 private:
  std::string_view rest_;
};

/// One of the numbers on which programs break, or any.
inline double any_number(Bytes& bytes) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double usual[] = {0, -1, 1, 2, 3, 1e300, -1e300, 1e-300, infinity, -infinity, 2147483648.0, 1e18};
  const std::size_t kind = bytes.below(std::size(usual) + 2);
  if (kind < std::size(usual)) return usual[kind];
  return kind == std::size(usual) ? std::numeric_limits<double>::quiet_NaN() : bytes.take<double>();
}

inline std::int64_t any_integer(Bytes& bytes) {
  constexpr std::int64_t usual[] = {0, -1, 1, 2, 3, -2, -3, 2147483647, -2147483648, 4294967296};
  const std::size_t kind = bytes.below(std::size(usual) + 1);
  return kind < std::size(usual) ? usual[kind] : bytes.take<std::int64_t>();
}

/// Removes one of the arrays, makes it longer or shorter, turns it into the other type, or changes one of its
/// numbers.
inline void change(std::map<std::string, Array>& arrays, Bytes& bytes) {
  const auto at = std::next(arrays.begin(), static_cast<std::ptrdiff_t>(bytes.below(arrays.size())));
  Array& array = at->second;
  switch (bytes.below(8)) {
    case 0:
      arrays.erase(at);
      break;
    case 1:
      std::visit([&](auto& values) { values.resize(bytes.below(300) * array.columns); }, array.values);
      break;
    case 2:
      std::visit(
          [&](auto& values) {
            if (array.values.index() == 0)
              array = {array.columns, std::vector<std::int64_t>(values.size(), 1)};
            else
              array = {array.columns, std::vector<double>(values.size(), 1)};
          },
          array.values);
      break;
    default:
      if (auto* reals = std::get_if<std::vector<double>>(&array.values); reals != nullptr && !reals->empty())
        (*reals)[bytes.below(reals->size())] = any_number(bytes);
      if (auto* whole = std::get_if<std::vector<std::int64_t>>(&array.values);
          whole != nullptr && !whole->empty())
        (*whole)[bytes.below(whole->size())] = any_integer(bytes);
  }
}

}  // namespace softgrain::fuzz
