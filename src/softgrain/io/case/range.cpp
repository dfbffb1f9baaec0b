#include <fmt/core.h>

#include <cmath>

#include "softgrain/io/case/schema.hpp"

namespace softgrain {

bool Range::contains(double value) const {
  const bool above = without_low ? value > low : value >= low;
  const bool below = without_high ? value < high : value <= high;
  return above && below;
}

std::string Range::text() const {
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  if (has_low && has_high)
    return fmt::format("in {}{}, {}{}", without_low ? '(' : '[', low, high, without_high ? ')' : ']');
  if (has_low) return fmt::format("{} {}", without_low ? ">" : ">=", low);
  if (has_high) return fmt::format("{} {}", without_high ? "<" : "<=", high);
  return "";
}

}  // namespace softgrain
