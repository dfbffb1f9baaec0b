#include "softgrain/experiment/create.hpp"

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/bpm_compression.hpp"

namespace softgrain {

std::unique_ptr<Simulation> create_simulation(const Case& the_case) {
  const auto& [loading, model] = the_case.experiment;
  require(loading == "diametral", "experiment.loading '{}' is not known; use 'diametral'", loading);
  require(model == "bpm", "experiment.model '{}' is not known; use 'bpm'", model);
  return std::make_unique<BpmCompression>(the_case);
}

}  // namespace softgrain
