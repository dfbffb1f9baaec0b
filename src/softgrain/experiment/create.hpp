#pragma once
#include <memory>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/simulation.hpp"

namespace softgrain {

/// Builds the experiment that a case describes; one word in the case picks the model. Raises UsageError.
std::unique_ptr<AnySimulation> create_any_simulation(const Case& the_case);

/// The same of an experiment in the plane. Raises UsageError for one in space.
std::unique_ptr<Simulation> create_simulation(const Case& the_case);

}  // namespace softgrain
