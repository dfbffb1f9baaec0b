#pragma once
#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/estimate.hpp"

namespace softgrain {

/// What the ranks of softgrain-mpi will take for a run, each with one thread.
struct RanksEstimate {
  double hours = 0;   ///< wall time [h] if each rank has a core of its own
  double memory = 0;  ///< of the first rank [bytes], which holds the most: the state is on all of them
  int useful = 1;     ///< ranks that have work; more wait
};

/// By the model of docs/scaling.md, t = a + s/P + x L + B/b: a of a step is done by all ranks, s is shared,
/// in x exchanges of latency L = 2 us log2 P a rank receives B bytes at b = 5 GB/s. a/s, x and B are
/// measured, L and b are assumed.
RanksEstimate estimate_on_ranks(const Case& the_case, const Estimate& alone, int ranks);

}  // namespace softgrain
