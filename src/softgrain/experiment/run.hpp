#pragma once
#include "softgrain/experiment/simulation.hpp"

namespace softgrain {

/// How well energy was kept, over the rows of a run.
struct EnergyBalance {
  /// Largest |energy_error|, and largest energy that came from nothing, -dissipation [J/m].
  double error = 0;
  /// Largest of the walls' work, kinetic energy and stored energy, and not below `least_energy` [J/m]; 0: no
  /// row tells.
  double scale = 0;

  void add(const Energies& energies);
  double imbalance() const { return scale > 0 ? error / scale : 0; }
};

/// What a whole run reached: the numbers of the closing verdict.
struct RunReport {
  std::int64_t steps = 0;
  std::int64_t steps_converged = 0;
  std::int64_t sweeps = 0;
  double residual_max = 0;    ///< worst contact of the worst step [-]
  double residual_limit = 0;  ///< that it had to reach in a step that converged [-]; 0: none was measured
  double overlap_max = 0;     ///< over the mean primary radius [-]
  EnergyBalance energy{};     ///< by the recorder

  void add(const StepReport& step);
};

/// Sees each step, adds to the report what only it sees; returns false to stop the run after it (signal, time
/// limit). Files and text live behind it.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual bool after_step(AnySimulation& simulation, const StepReport& step, RunReport& run) = 0;
};

/// The loop: diametral compression, compaction and shear are the same loop along another path. A
/// NumericalError gets the number of its step.
RunReport run(AnySimulation& simulation, Recorder& recorder, RunReport report = {});

}  // namespace softgrain
