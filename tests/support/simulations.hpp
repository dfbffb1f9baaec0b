#pragma once
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "softgrain/experiment/simulation.hpp"

namespace softgrain::test {

inline double value_of(const std::vector<Quantity>& row, std::string_view name) {
  const auto found = std::ranges::find(row, name, &Quantity::name);
  REQUIRE(found != row.end());
  return found->value;
}

inline void advance(Simulation& simulation, std::int64_t steps) {
  while (steps-- > 0 && !simulation.finished()) simulation.step();
}

}  // namespace softgrain::test
