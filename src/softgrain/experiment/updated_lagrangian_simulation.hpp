#pragma once
#include <memory>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/plate_path.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/mpm/updated_lagrangian.hpp"

namespace softgrain {

/// One grain between two plates by updated-Lagrangian MPM: to be compared with MpmSimulation, which writes
/// the same columns. A cell has the size that gives both grains 14 cells^2 points. Raises UsageError for
/// another loading or unknown words.
class UpdatedLagrangianSimulation final : public Simulation {
 public:
  explicit UpdatedLagrangianSimulation(const Case& the_case);

  /// [s]
  static double longest_time_step(const Case& the_case);

  bool finished() const override { return step_ >= path_->steps(); }
  double progress() const override {
    return static_cast<double>(step_) / static_cast<double>(path_->steps());
  }
  double time() const override { return static_cast<double>(step_) * dt_; }
  double strain() const override { return path_->strain(height_start_, plate_distance()); }
  std::int64_t steps_done() const override { return step_; }
  std::int64_t steps_planned() const override { return path_->steps(); }
  bool at_turning_point() const override { return step_ > 0 && path_->leg(step_) != path_->leg(step_ - 1); }
  void follow(PlateMotion motion) override;
  StepReport step() override;
  std::vector<Quantity> observe() override;
  Scene scene() const override;
  std::vector<GrainView> grains() const override;
  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;

 private:
  /// What is summed between two rows; saved with a checkpoint.
  struct Sums {
    double force_bottom = 0, force_top = 0;  ///< impulses since the last row [N s/m]
    double duration = 0;                     ///< since the last row [s]
  };
  const PointGrain& grain() const { return dynamics_.grains.front(); }
  double plate_distance() const;

  UpdatedLagrangianDynamics dynamics_;
  double dt_ = 0;
  std::unique_ptr<PlatePath> path_;
  double height_start_ = 0;
  std::int64_t step_ = 0;
  Sums sums_;
};

}  // namespace softgrain
