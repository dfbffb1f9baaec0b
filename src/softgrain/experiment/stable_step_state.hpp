#pragma once
#include "softgrain/core/error.hpp"
#include "softgrain/experiment/arrays.hpp"
#include "softgrain/mpm/explicit_step.hpp"

namespace softgrain {

/// To a checkpoint's array "stable_step".
inline void save_stable_step(const StableStep& stable, Checkpoint& state) {
  state.arrays["stable_step"] = {1,
                                 std::vector<double>{stable.longest, static_cast<double>(stable.until_look),
                                                     static_cast<double>(stable.between_looks)}};
}

/// From it; without it, as in snapshots up to 0.1.0, the cells are looked at in the next step. Raises IoError
/// for numbers that cannot be.
inline StableStep restored_stable_step(const Checkpoint& state) {
  if (!state.arrays.contains("stable_step")) return {};
  std::vector<Vec<1>> rows(3);
  from_array<1>(state, "stable_step", rows);
  constexpr double most = 1e6;
  const double longest = rows[0][0], until_look = rows[1][0], between_looks = rows[2][0];
  if (!(longest >= 0 && until_look >= 0 && until_look <= most && between_looks >= 1 && between_looks <= most))
    throw IoError("the checkpoint's array 'stable_step' is not a step and two numbers of sub-steps");
  return {longest, static_cast<int>(until_look), static_cast<int>(between_looks)};
}

}  // namespace softgrain
