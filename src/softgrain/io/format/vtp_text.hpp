#pragma once
#include <fmt/core.h>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/state/array.hpp"

namespace softgrain {

/// The XML of a .vtp file and, behind it, its binary blocks.
class VtpText {
 public:
  /// Chunks of a snapshot have so many rows, or a power of two less.
  static constexpr std::size_t rows_at_once = 1 << 17;

  void line(std::string_view text) { xml_ += fmt::format("{}\n", text); }
  /// rows(first, count) gives those of the array, which is never whole in memory.
  void array(const std::string& name, const ArrayShape& shape,
             const std::function<Array(std::size_t first, std::size_t count)>& rows);
  /// One behind the other they are the file.
  std::vector<std::string> finish();

 private:
  std::string xml_;
  std::vector<std::string> arrays_;
  std::size_t offset_ = 0;
};

}  // namespace softgrain
