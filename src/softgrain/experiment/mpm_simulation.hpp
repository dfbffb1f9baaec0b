#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/experiment/soft_view.hpp"
#include "softgrain/experiment/wall_drive.hpp"
#include "softgrain/mpm/explicit_step.hpp"
#include "softgrain/mpm/implicit_step.hpp"

namespace softgrain {

/// Soft grains by MPM under a plate: one grain between two plates (the paper's Fig. 1), or a packing in a box
/// whose lid comes down (Figs. 2-4), or all its walls in. `Dynamics` is ImplicitDynamics or ExplicitDynamics:
/// both hold the same data.
template <class Dynamics>
class MpmSimulation final : public Simulation {
 public:
  /// walls: bottom and top, then, in a box, left and right.
  MpmSimulation(Dynamics dynamics, WallDrive drive, double dt);

  bool finished() const override { return drive_.finished(step_); }
  double progress() const override { return drive_.progress(step_); }
  double time() const override { return static_cast<double>(step_) * dt_; }
  double strain() const override { return drive_.strain(height_start_, plate_distance()); }
  std::int64_t steps_done() const override { return step_; }
  std::int64_t steps_planned() const override { return drive_.steps_planned(); }
  bool at_turning_point() const override { return drive_.at_turning_point(step_); }
  std::string early_end() const override { return drive_.early_end(step_); }
  PathOutcome outcome() const override { return box() ? drive_.outcome(step_) : PathOutcome{}; }
  void follow(PlateMotion motion) override { drive_.follow(std::move(motion)); }
  StepReport step() override;
  SolvedContactProblem step_and_catch_problem() override;
  std::vector<Quantity> observe() override;
  Scene scene() const override { return soft_scene(view()); }
  std::vector<GrainView> grains() const override { return grain_views(dynamics_.grains); }
  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;

  const Dynamics& dynamics() const { return dynamics_; }

 private:
  /// What is summed between two rows, or over the run; saved with a checkpoint.
  struct Sums {
    std::array<double, 4> impulse{};      ///< on each wall, outwards, since the last row [N s/m]
    double duration = 0;                  ///< since the last row [s]
    double iterations = 0, rejected = 0;  ///< since the last row; over the run
  };
  double box_stress() const;
  SoftStepReport step_at(double approach_speed);
  SoftStepReport step_under(double stress);
  bool box() const { return dynamics_.walls.size() > 2; }
  double plate_distance() const;
  double box_width() const;
  double wall_force(int wall) const;
  SoftView view() const;
  std::vector<Quantity> energies() const;
  double stored_energy() const;

  Dynamics dynamics_;
  WallDrive drive_;
  double dt_ = 0;
  double height_start_ = 0;
  std::int64_t step_ = 0;
  Sums sums_;
};

/// The experiment of a case whose model is "mpm".
std::unique_ptr<Simulation> create_mpm_simulation(const Case& the_case);

}  // namespace softgrain
