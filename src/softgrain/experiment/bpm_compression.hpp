#pragma once
#include <memory>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/experiment/diametral_path.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/observe/stress.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// One bonded-particle grain between two plates: the paper's Fig. 1. The bottom plate is fixed, the top one
/// follows the path.
class BpmCompression final : public Simulation {
 public:
  explicit BpmCompression(const Case& the_case);

  bool finished() const override { return step_ >= path_.steps(); }
  double progress() const override { return static_cast<double>(step_) / static_cast<double>(path_.steps()); }
  double time() const override { return static_cast<double>(step_) * case_.time.step; }
  std::int64_t steps_done() const override { return step_; }
  std::int64_t steps_planned() const override { return path_.steps(); }
  bool at_turning_point() const override { return step_ > 0 && path_.leg(step_) != path_.leg(step_ - 1); }
  StepReport step() override;
  std::vector<Quantity> observe() override;
  Scene scene() const override;
  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;

  const RigidDynamics<2>& dynamics() const { return dynamics_; }
  double sigma_I() const;  ///< F0/<a0> [Pa]

 private:
  /// What is summed between two rows, or over the run; saved with a checkpoint.
  struct Sums {
    double force_bottom = 0, force_top = 0;  ///< impulses since the last row [N s/m]
    double duration = 0;                     ///< since the last row [s]
    double wall_work = 0, dissipation = 0;   ///< over the run [J/m]
    double energy_start = 0;                 ///< kinetic + attraction before the first step [J/m]
  };

  double width() const;
  int clusters() const;
  std::vector<BranchForce> branch_forces() const;

  Case case_;
  DiametralPath path_;
  AttractionForces attraction_;
  Aggregate aggregate_;
  RigidDynamics<2> dynamics_;
  double height_start_ = 0;  ///< distance of the plates when they touch the round grain [m]
  std::int64_t step_ = 0;
  Sums sums_;
};

}  // namespace softgrain
