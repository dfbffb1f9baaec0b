#pragma once
#include <memory>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/simulation.hpp"

namespace softgrain {

/// Builds the experiment that a case describes; one word in the case picks the model. Raises UsageError.
std::unique_ptr<Simulation> create_simulation(const Case& the_case);

/// The longest time step [s] with which an explicit run of the case is stable from its start on, with grains
/// of the smallest radius that it allows; infinite where the integrator or the model has no such limit. While
/// it runs, cells that become stiffer are followed by sub-steps.
double longest_time_step(const Case& the_case);

/// Raises UsageError if the case gives a longer one.
void check_time_step(const Case& the_case);

}  // namespace softgrain
