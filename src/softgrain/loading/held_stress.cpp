#include "softgrain/loading/held_stress.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace softgrain {

double HeldStress::deviation() const {
  return windows > 0 ? std::sqrt(std::max(0.0, squares / windows - mean() * mean())) : 0;
}

std::string HeldStress::text() const {
  return fmt::format("{:.3f} of it in the mean, {:.2g} of standard deviation, {:.3g} at most", mean(),
                     deviation(), largest);
}

void HeldStress::add(double stress, std::int64_t step, std::int64_t steps) {
  if (step < steps / 2) return;
  const std::int64_t of_window = std::max<std::int64_t>(1, (steps - steps / 2) / 200);
  window += stress / static_cast<double>(of_window);
  if ((step - steps / 2 + 1) % of_window != 0) return;
  ++windows;
  sum += window;
  squares += window * window;
  largest = std::max(largest, window);
  window = 0;
}

}  // namespace softgrain
