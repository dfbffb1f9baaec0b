#include "softgrain/experiment/create.hpp"

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/bpm_compaction.hpp"
#include "softgrain/experiment/bpm_compression.hpp"
#include "softgrain/experiment/mpm_simulation.hpp"

namespace softgrain {

std::unique_ptr<Simulation> create_simulation(const Case& the_case) {
  const auto& [loading, model] = the_case.experiment;
  require(loading == "diametral" || loading == "compaction" || loading == "isotropic",
          "experiment.loading must be 'diametral', 'compaction' or 'isotropic', got '{}'", loading);
  if (model == "mpm") return create_mpm_simulation(the_case);
  require(model == "bpm", "experiment.model must be 'bpm' or 'mpm', got '{}'", model);
  if (loading == "diametral") return std::make_unique<BpmCompression>(the_case);
  return std::make_unique<BpmCompaction>(the_case);
}

}  // namespace softgrain
