#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/simulation.hpp"
#include "softgrain/experiment/wall_drive.hpp"
#include "softgrain/observe/energy.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// The step, solver and contact law that a case asks for.
RigidStepOptions rigid_step_options(const Case& the_case);

/// Grains of bonded primary particles between walls that follow a path: what the test of one grain and the
/// compaction of many have in common.
class BpmSimulation : public Simulation {
 public:
  bool finished() const override { return drive_.finished(step_); }
  double progress() const override { return drive_.progress(step_); }
  double time() const override { return static_cast<double>(step_) * case_.time.step; }
  double strain() const override { return drive_.strain(height_start_, plate_distance()); }
  std::int64_t steps_done() const override { return step_; }
  std::int64_t steps_planned() const override { return drive_.steps_planned(); }
  bool at_turning_point() const override { return drive_.at_turning_point(step_); }
  PathOutcome outcome() const override { return drive_.outcome(step_); }
  void follow(PlateMotion motion) override { drive_.follow(std::move(motion)); }
  StepReport step() override;
  SolvedContactProblem step_and_catch_problem() override;
  Scene scene() const override;
  std::vector<GrainView> grains() const override;
  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;

  const RigidDynamics<2>& dynamics() const { return dynamics_; }

 protected:
  /// skin [m] of the lists of pairs.
  BpmSimulation(const Case& the_case, std::unique_ptr<PlatePath> path, std::vector<Attraction> laws,
                RigidParticles<2> particles, FrictionRule friction, double skin);

  /// Forces of the last step and what they did, summed between two rows, or over the run; saved with a
  /// checkpoint.
  struct Sums {
    std::array<double, 4> impulse{};        ///< on each wall, outwards, since the last row [N s/m]
    double duration = 0;                    ///< since the last row [s]
    double wall_work = 0, dissipation = 0;  ///< over the run [J/m]
    double between = 0, friction = 0;       ///< of the dissipation: between grains; by sliding there
    double energy_start = 0;                ///< kinetic + attraction before the first step [J/m]
  };

  /// Looks at the step that was just made, whose overlaps are sound: may end the run by `drive_.state`.
  virtual void judge(const StepReport&) {}
  /// Draws the walls, and what else the experiment shows.
  virtual void complete_scene(Scene& scene) const = 0;
  /// Area of each grain at the start [m^2], for the pressures of its primaries.
  virtual double grain_area(int grain) const = 0;

  double plate_distance() const;
  /// Outward force on a wall [N/m], mean since the last row.
  double wall_force(int wall) const;
  EnergyBudget energy_budget() const;
  /// Number of pieces in which the primaries of all grains hold together.
  int clusters() const;
  /// step, time, strain, leg, wall_height; then the experiment's own; then energies and contacts.
  std::vector<Quantity> row_of(std::vector<Quantity> own) const;
  void start_new_row();

  Case case_;
  WallDrive drive_;
  AttractionForces attraction_;
  RigidDynamics<2> dynamics_;
  double height_start_ = 0;  ///< [m]
  std::int64_t step_ = 0;
  Sums sums_;
  std::array<double, 4> wall_impulse_{};  ///< on each wall, outwards, of the last step [N s/m]

 private:
  std::vector<double> pressures() const;
};

}  // namespace softgrain
