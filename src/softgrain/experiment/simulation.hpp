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

/// An experiment, advanced step by step: grains (a model), a box, and a loading.
class Simulation final {
 public:
  /// dt [s]: of every step.
  Simulation(std::unique_ptr<Model> model, Box<2> box, Loading loading, double dt);
  Simulation(const Simulation& other);
  Simulation(Simulation&&) = default;
  Simulation& operator=(Simulation&&) = default;

  bool finished() const { return loading_.finished(); }
  /// 0 at the start, 1 when finished; never goes back.
  double progress() const { return loading_.progress(time(), dt_); }
  double time() const { return static_cast<double>(step_) * dt_; }  ///< [s]
  double strain() const { return loading_.strain(box_); }           ///< by the walls, as in the rows
  double time_step() const { return dt_; }                          ///< [s]
  std::int64_t steps_done() const { return step_; }
  std::int64_t steps_planned() const { return steps_planned_; }
  /// Why the simulation has finished before its last planned step, for the user; "" if it has not.
  std::string early_end() const;
  /// What a finished simulation made of its loading; completed and silent before.
  LoadingOutcome outcome() const;
  /// True after the last step before the load turns: a state worth keeping.
  bool at_turning_point() const { return loading_.at_turning_point(); }
  /// Before the first step: the walls leave the stages of the case for this motion. Raises UsageError.
  void follow(WallMotion motion);

  /// Advances by one time step. Raises NumericalError when the state is not finite or the overlap shows that
  /// no solution exists.
  StepReport step();
  /// Advances by one time step too, and returns the contact problem that was solved in it, with its impulses
  /// per metre of depth; where a step solves several, the last. Raises UsageError where no such problem can
  /// be had.
  SolvedContactProblem step_and_catch_problem();

  /// What a row of series.csv says now (observe/columns.hpp). Wall forces and iterations are means over the
  /// steps since `begin_row`.
  Observation observe() const;
  void begin_row();
  Energies energies() const;
  Scene scene() const;
  std::vector<GrainView> grains() const { return model_->grains(); }
  const Model& model() const { return *model_; }
  const Box<2>& box() const { return box_; }

  Checkpoint checkpoint() const;
  /// Raises IoError for a checkpoint that is not of this case.
  void restore(const Checkpoint& checkpoint);
  /// Before the first step: takes grains and walls from another run's checkpoint, with their energies and
  /// what was spent so far. Steps and time begin anew, and so does the loading; its strains count from where
  /// the other run began. Raises IoError for a checkpoint of other grains.
  void begin_from(const Checkpoint& checkpoint);
  void visit(StateVisitor& visit);

 private:
  /// Since the last row.
  struct RowSums {
    std::vector<double> impulse;  // on each wall, outwards [N s/m]
    double duration = 0;          // [s]
  };
  void apply_settings() { model_->set(initial_.then(loading_.settings())); }
  StepFelt felt_in(const StepReport& report) const;
  PackingMeasures packing() const;
  Bodies over_cell(Bodies bodies) const;
  double largest_rate() const;

  std::unique_ptr<Model> model_;
  Box<2> box_;
  Loading loading_;
  Settings initial_;  // of the case, which stages change
  double dt_ = 0;
  std::int64_t step_ = 0, steps_planned_ = 0;
  RowSums row_;
};

}  // namespace softgrain
