#pragma once
#include <memory>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/simulation.hpp"

namespace softgrain {

/// Builds the experiment that a case describes; one word in the case picks the model. Raises UsageError.
std::unique_ptr<Simulation> create_simulation(const Case& the_case);

}  // namespace softgrain
