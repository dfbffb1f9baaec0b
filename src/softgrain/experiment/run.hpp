#pragma once
#include "softgrain/experiment/simulation.hpp"

namespace softgrain {

/// What a whole run reached: the numbers of the closing verdict.
struct RunReport {
  std::int64_t steps = 0;
  std::int64_t steps_converged = 0;
  std::int64_t sweeps = 0;
  double residual_max = 0;  ///< worst contact of the worst step [-]
  double overlap_max = 0;   ///< over the mean primary radius [-]

  void add(const StepReport& step);
};

/// Sees each step; returns false to stop the run after it (signal, time limit). Files and text live behind
/// it.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual bool after_step(Simulation& simulation, const StepReport& step, const RunReport& run) = 0;
};

/// The loop: diametral compression, compaction and shear are the same loop along another path. A
/// NumericalError gets the number of its step.
RunReport run(Simulation& simulation, Recorder& recorder, RunReport report = {});

}  // namespace softgrain
