#include "softgrain/experiment/held_stress.hpp"

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

void HeldStress::visit(StateVisitor& visit) {
  const auto declare = [&](std::string_view name, std::string_view text, double& value) {
    visit({name, "", Owner::run, Role::sum, text}, value);
  };
  declare("held_windows", "equal times of the second half of a hold that are over", windows);
  declare("held_sum", "of their mean stresses over the stress asked for", sum);
  declare("held_squares", "of the squares of these", squares);
  declare("held_largest", "the largest of these", largest);
  declare("held_window", "of the present time so far", window);
}

}  // namespace softgrain
