#include "softgrain/experiment/ranks_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace softgrain {
namespace {

/// Of a step, as measured (docs/scaling.md).
struct Sharing {
  double shared;             ///< share of the CPU time that is divided among ranks
  double exchanges;          ///< in which all take part
  double bytes_of_particle;  ///< that a rank receives in them, for each primary or point
};

Sharing sharing_of(const Case& c) {
  if (is_bonded(c)) return {.shared = 0.62, .exchanges = 42, .bytes_of_particle = 15};
  if (!is_elastic(c) || c.mpm.formulation == Formulation::updated_lagrangian) return {};
  if (c.mpm.integrator == Integrator::symplectic_euler || is_in_space(c))
    return {.shared = 0.60, .exchanges = 32, .bytes_of_particle = 11};
  return {.shared = 0.82, .exchanges = 40, .bytes_of_particle = 30};
}

/// Elastic grains are shared in batches of eight.
int most_ranks(const Case& c) {
  const int grains = is_in_a_box(c) ? c.sample.grains : 1;
  return std::max(1, is_bonded(c) ? grains : (grains + 7) / 8);
}

}  // namespace

RanksEstimate estimate_on_ranks(const Case& the_case, const Estimate& alone, int ranks) {
  constexpr double latency = 2e-6, bandwidth = 5e9;  // [s], [bytes/s]: assumed
  constexpr double of_mpi = 20e6;                    // [bytes] of each rank
  const Sharing sharing = sharing_of(the_case);
  const int useful = sharing.shared > 0 ? std::min(ranks, most_ranks(the_case)) : 1;
  const double work = 3600 * alone.hours * (1 - sharing.shared + sharing.shared / useful);
  const double exchange = sharing.exchanges * latency * std::log2(static_cast<double>(ranks)) +
                          (ranks > 1 ? sharing.bytes_of_particle * alone.particles / bandwidth : 0);
  const double memory = alone.memory - alone.shared_memory * (1 - 1.0 / useful) + (ranks > 1 ? of_mpi : 0);
  return {.hours = (work + alone.steps * exchange) / 3600, .memory = memory, .useful = useful};
}

}  // namespace softgrain
