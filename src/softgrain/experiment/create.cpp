#include "softgrain/experiment/create.hpp"

#include "softgrain/experiment/bpm_compaction.hpp"
#include "softgrain/experiment/bpm_compression.hpp"
#include "softgrain/experiment/mpm_simulation.hpp"

namespace softgrain {

std::unique_ptr<Simulation> create_simulation(const Case& the_case) {
  if (the_case.experiment.model == GrainModel::mpm) return create_mpm_simulation(the_case);
  if (the_case.experiment.loading == LoadingPath::diametral)
    return std::make_unique<BpmCompression>(the_case);
  return std::make_unique<BpmCompaction>(the_case);
}

}  // namespace softgrain
