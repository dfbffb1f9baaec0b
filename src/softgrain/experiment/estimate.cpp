#include "softgrain/experiment/estimate.hpp"

#include "softgrain/experiment/diametral_path.hpp"

namespace softgrain {

Estimate estimate(const Case& the_case) {
  constexpr double contacts_per_primary = 2.2;
  constexpr double contacts_per_second = 15e6;  // one thread, one sweep
  Estimate result;
  result.primaries = the_case.bpm.primaries;
  const double contacts = contacts_per_primary * static_cast<double>(result.primaries);
  result.contacts = static_cast<std::int64_t>(contacts);
  result.steps = DiametralPath(the_case.loading, the_case.grain.radius, the_case.time.step).steps();
  result.memory = 50e6 + 1000 * static_cast<double>(result.primaries) + 200 * contacts;
  const double work = contacts * the_case.solver.max_sweeps * static_cast<double>(result.steps);
  result.hours = work / contacts_per_second / 3600;
  return result;
}

}  // namespace softgrain
