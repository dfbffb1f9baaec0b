#pragma once
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/io/format/snapshot.hpp"
#include "softgrain/io/run/run_directory.hpp"
#include "softgrain/io/run/run_json.hpp"

namespace softgrain {

/// A state of a run from which another one begins.
struct OriginState {
  RunPaths paths;
  Snapshot snapshot;
  std::vector<RunOrigin> origins;  ///< of a run that begins from it: this state, then those before it
};

/// "RUN", its last snapshot, or "RUN@123" and "RUN@s000123.h5", that of step 123. Raises UsageError where
/// there is no such run or snapshot, with the steps that there are, and IoError for a damaged one.
OriginState read_origin(const std::string& text);

/// Gives the simulation of a case the state of another run. Raises UsageError where it belongs to other
/// grains, with the key that makes them others.
void begin_from(AnySimulation& simulation, const OriginState& origin, const Case& the_case);

}  // namespace softgrain
