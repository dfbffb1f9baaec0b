#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "softgrain/geometry/box.hpp"
#include "softgrain/loading/loading.hpp"
#include "softgrain/model/model.hpp"
#include "softgrain/observe/observation.hpp"

namespace softgrain {

/// Everything that a simulation needs to go on as if it had never stopped, bit for bit.
struct Checkpoint {
  std::int64_t step = 0;
  double time = 0;  ///< [s]
  Arrays arrays;    ///< as state/field.hpp declares them
};

/// An experiment as whoever runs and records it sees it, whatever its dimension.
class AnySimulation {
 public:
  virtual ~AnySimulation() = default;

  virtual bool finished() const = 0;
  /// 0 at the start, 1 when finished; never goes back.
  virtual double progress() const = 0;
  virtual double time() const = 0;       ///< [s]
  virtual double strain() const = 0;     ///< by the walls, as in the rows
  virtual double time_step() const = 0;  ///< [s]
  virtual std::int64_t steps_done() const = 0;
  virtual std::int64_t steps_planned() const = 0;
  /// Why the simulation has finished before its last planned step, for the user; "" if it has not.
  virtual std::string early_end() const = 0;
  /// What a finished simulation made of its loading; completed and silent before.
  virtual LoadingOutcome outcome() const = 0;
  /// True after the last step before the load turns: a state worth keeping.
  virtual bool at_turning_point() const = 0;

  /// Advances by one time step. Raises NumericalError when the state is not finite or the overlap shows that
  /// no solution exists.
  virtual StepReport step() = 0;
  /// Advances by one time step too, and returns the contact problem that was solved in it, with its impulses
  /// per metre of depth; where a step solves several, the last. Raises UsageError where no such problem can
  /// be had.
  virtual SolvedContactProblem step_and_catch_problem() = 0;

  /// On several ranks, on all at once, before the first one asks for what follows (ModelOf::gather).
  virtual void gather() {}
  /// What a row of series.csv says now (observe/columns.hpp). Wall forces and iterations are means over the
  /// steps since `begin_row`.
  virtual Observation observe() const = 0;
  virtual void begin_row() = 0;
  virtual Scene scene() const = 0;
  /// The particles of the same scene, if they come in parts; and the scene without them. They hold until the
  /// next step.
  virtual ParticleParts particle_parts() const { return {}; }
  virtual Scene scene_without_parts() const { return scene(); }

  virtual Checkpoint checkpoint() const = 0;
  /// Raises IoError for a checkpoint that is not of this case.
  virtual void restore(const Checkpoint& checkpoint) = 0;
  /// Before the first step: takes grains and walls from another run's checkpoint, with their energies and
  /// what was spent so far. Steps and time begin anew, and so does the loading; its strains count from where
  /// the other run began. Raises IoError for a checkpoint of other grains.
  virtual void begin_from(const Checkpoint& checkpoint) = 0;
  virtual void visit(StateVisitor& visit) = 0;

 protected:
  AnySimulation() = default;
  AnySimulation(const AnySimulation&) = default;
  AnySimulation(AnySimulation&&) = default;
  AnySimulation& operator=(const AnySimulation&) = default;
  AnySimulation& operator=(AnySimulation&&) = default;
};

/// Lifts or lowers an open top to the surface of the grains: a hundredth of their mean radius above their
/// highest point.
template <int Dim>
void follow_surface(const ModelOf<Dim>& model, Box<Dim>& box);

/// An experiment, advanced step by step: grains (a model), a box, and a loading.
template <int Dim>
class SimulationOf final : public AnySimulation {
 public:
  /// dt [s]: of every step.
  SimulationOf(std::unique_ptr<ModelOf<Dim>> model, Box<Dim> box, LoadingOf<Dim> loading, double dt);
  SimulationOf(const SimulationOf& other);
  SimulationOf(SimulationOf&&) noexcept = default;
  SimulationOf& operator=(SimulationOf&&) noexcept = default;

  bool finished() const override { return loading_.finished(); }
  double progress() const override { return loading_.progress(time(), dt_); }
  double time() const override { return static_cast<double>(step_) * dt_; }
  double strain() const override { return loading_.strain(box_); }
  double time_step() const override { return dt_; }
  std::int64_t steps_done() const override { return step_; }
  std::int64_t steps_planned() const override { return steps_planned_; }
  std::string early_end() const override;
  LoadingOutcome outcome() const override;
  bool at_turning_point() const override { return loading_.at_turning_point(); }
  /// Before the first step: the walls leave the stages of the case for this motion. Raises UsageError.
  void follow(WallMotion motion);

  StepReport step() override;
  SolvedContactProblem step_and_catch_problem() override;

  void gather() override { model_->gather(); }
  Observation observe() const override;
  void begin_row() override;
  Energies energies() const;
  Scene scene() const override { return in_box(model_->scene(box_)); }
  ParticleParts particle_parts() const override;
  Scene scene_without_parts() const override { return in_box(model_->scene_without_parts(box_)); }
  std::vector<GrainView> grains() const { return model_->grains(); }
  const ModelOf<Dim>& model() const { return *model_; }
  const Box<Dim>& box() const { return box_; }

  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;
  void begin_from(const Checkpoint& checkpoint) override;
  void visit(StateVisitor& visit) override;

 private:
  /// Since the last row.
  struct RowSums {
    std::vector<double> impulse;  // on each wall, outwards [N s/m]
    double duration = 0;          // [s]
  };
  void apply_settings() { model_->set(initial_.then(loading_.settings())); }
  StepFelt felt_in(const StepReport& report);
  Scene in_box(Scene scene) const;
  PackingMeasures packing() const;
  BodiesOf<Dim> over_cell(BodiesOf<Dim> bodies) const;
  double largest_rate() const;

  std::unique_ptr<ModelOf<Dim>> model_;
  Box<Dim> box_;
  LoadingOf<Dim> loading_;
  Settings initial_;  // of the case, which stages change
  double dt_ = 0;
  std::int64_t step_ = 0, steps_planned_ = 0;
  RowSums row_;
};
using Simulation = SimulationOf<2>;

}  // namespace softgrain
