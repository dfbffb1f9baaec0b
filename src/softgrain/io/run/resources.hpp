#pragma once
#include <filesystem>

#include "softgrain/experiment/estimate.hpp"

namespace softgrain {

/// What there is for a run [bytes].
struct Resources {
  double memory = 0;  ///< free memory, the limit of the control group or of the process, whichever is least
  double disk = 0;    ///< free space on the disk of the run's directory
};

/// Of this machine, now; infinity where it does not tell. The directory need not exist yet.
Resources available_resources(const std::filesystem::path& directory);

/// Raises UsageError when the run would take more than 90 % of what there is, naming both numbers and
/// remedies.
void require_resources(const Estimate& needed, const Resources& available);

}  // namespace softgrain
