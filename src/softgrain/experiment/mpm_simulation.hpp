#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/plate_path.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/experiment/soft_view.hpp"
#include "softgrain/mpm/explicit_step.hpp"
#include "softgrain/mpm/implicit_step.hpp"

namespace softgrain {

/// Soft grains by MPM under a plate: one grain between two plates (the paper's Fig. 1), or a packing in a box
/// whose lid comes down (Figs. 2-4). `Dynamics` is ImplicitDynamics or ExplicitDynamics: both hold the same
/// data.
template <class Dynamics>
class MpmSimulation final : public Simulation {
 public:
  /// walls: the bottom, the top one that the path moves, then, in a box, left and right. A box's run also
  /// ends at the stress max_stress [Pa], unless 0.
  MpmSimulation(Dynamics dynamics, std::unique_ptr<PlatePath> path, double dt, double max_stress);

  bool finished() const override { return sums_.ended || step_ >= path_->steps(); }
  double progress() const override {
    return sums_.ended ? 1 : static_cast<double>(step_) / static_cast<double>(path_->steps());
  }
  double time() const override { return static_cast<double>(step_) * dt_; }
  std::int64_t steps_done() const override { return step_; }
  std::int64_t steps_planned() const override { return path_->steps(); }
  bool at_turning_point() const override { return step_ > 0 && path_->leg(step_) != path_->leg(step_ - 1); }
  std::string early_end() const override { return sums_.ended ? "loading.max_stress is reached" : ""; }
  StepReport step() override;
  std::vector<Quantity> observe() override;
  Scene scene() const override { return soft_scene(view()); }
  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;

  const Dynamics& dynamics() const { return dynamics_; }

 private:
  /// What is summed between two rows, or over the run; saved with a checkpoint.
  struct Sums {
    std::array<double, 4> impulse{};      ///< on each wall, outwards, since the last row [N s/m]
    double duration = 0;                  ///< since the last row [s]
    double iterations = 0, rejected = 0;  ///< since the last row; over the run
    double stress = 0;                    ///< vertical, the mean that max_stress is compared with [Pa]
    bool ended = false;                   ///< before the end of the path
  };
  bool box() const { return dynamics_.walls.size() > 2; }
  double plate_distance() const;
  double wall_force(int wall) const;
  void judge();
  SoftView view() const;
  std::vector<Quantity> energies() const;
  double stored_energy() const;

  Dynamics dynamics_;
  std::unique_ptr<PlatePath> path_;
  double dt_ = 0, max_stress_ = 0;
  double height_start_ = 0;
  std::int64_t step_ = 0;
  Sums sums_;
};

/// The experiment of a case whose model is "mpm".
std::unique_ptr<Simulation> create_mpm_simulation(const Case& the_case);

}  // namespace softgrain
