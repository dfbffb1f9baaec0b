#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "softgrain/contact/step_report.hpp"

namespace softgrain {

/// One number of a row of series.csv.
struct Quantity {
  std::string name;
  std::string unit;  ///< SI, "" for none
  double value = 0;
};

/// A named array of a checkpoint, row-major: shape (rows, columns), columns = 1 for scalars.
struct Array {
  std::size_t columns = 1;
  std::variant<std::vector<double>, std::vector<std::int64_t>> values;
};

/// Everything that a simulation needs to go on as if it had never stopped, bit for bit.
struct Checkpoint {
  std::int64_t step = 0;
  double time = 0;  ///< [s]
  std::map<std::string, Array> arrays;
};

/// What can be drawn: disks (primaries, or material points), outlines of soft grains, walls as segments, and
/// contacts with their force.
struct Scene {
  std::map<std::string, Array> particles;  ///< position (n, 2), radius, then any field by primary particle
  /// pair (m, 2) of particles, walls from n on, in the order of wall_segments; force (m, 1) [N/m], normal.
  /// With a position (m, 2) [m] of their own the pairs are of grains, not of particles; walls from their
  /// number on.
  std::map<std::string, Array> contacts;
  std::map<std::string, Array>
      outlines;  ///< position (v, 2) of the outlines' vertices, grain (v): a new grain, a new polygon
  std::vector<double> wall_segments;  ///< x0 y0 x1 y1 for each wall [m]
};

/// Vectors where they lie in memory: component d of row i is begin[i * row + d * component].
struct VectorView {
  const double* begin = nullptr;
  std::size_t rows = 0;
  std::size_t row = 2, component = 1;
};

/// One grain where it lies in memory: it follows the steps, and lasts as long as the simulation.
struct GrainView {
  VectorView position;  ///< of primaries, grid nodes or material points [m]
  VectorView velocity;  ///< theirs [m/s]
  VectorView outline;   ///< vertices, counter-clockwise [m]; none where only the scene finds them (bpm)
};

/// How the plates move when it is not the case that says it.
struct PlateMotion {
  double duration = 0;  ///< [s]
  std::function<double(double)>
      velocity;  ///< of time [s]: rate of the distance of the plates [m/s], negative while loading
};

/// Whether a finished simulation did what its case asks for.
struct PathOutcome {
  /// It ended at the last strain or packing fraction, or at another end that the case names.
  bool completed = true;
  /// What was not reached, or not kept, and why, for the user; "" if nothing. A completed path may have one:
  /// it ended at its last strain, and a stress that would have ended it before was not reached.
  std::string shortfall;
};

struct SolvedContactProblem;

/// The one abstract class: an experiment with a model of a grain, advanced step by step.
class Simulation {
 public:
  virtual ~Simulation() = default;
  virtual bool finished() const = 0;
  virtual double progress() const = 0;  ///< 0 at the start, 1 when finished; never goes back
  virtual double time() const = 0;      ///< [s]
  virtual double strain() const = 0;    ///< by the walls, as in the rows
  virtual std::int64_t steps_done() const = 0;
  virtual std::int64_t steps_planned() const = 0;
  /// Why the simulation has finished before its last planned step, for the user; "" if it has not.
  virtual std::string early_end() const { return ""; }
  /// What a finished simulation made of its path; completed and silent before.
  virtual PathOutcome outcome() const { return {}; }
  /// True after the last step before the load turns: a state worth keeping.
  virtual bool at_turning_point() const = 0;
  /// Before the first step: the plates leave the case's loading path for this motion. Raises UsageError.
  virtual void follow(PlateMotion motion) = 0;
  /// Advances by one time step. Raises NumericalError when the state is not finite or the overlap shows that
  /// no solution exists.
  virtual StepReport step() = 0;
  /// Advances by one time step too, and returns the contact problem that was solved in it, with its impulses
  /// per metre of depth; where a step solves several, the last. Raises UsageError where no such problem can
  /// be had.
  virtual SolvedContactProblem step_and_catch_problem();
  /// The row of series.csv now. Wall forces are means over the steps since the last call of `observe`.
  virtual std::vector<Quantity> observe() = 0;
  virtual Scene scene() const = 0;
  virtual std::vector<GrainView> grains() const = 0;
  virtual Checkpoint checkpoint() const = 0;
  virtual void restore(const Checkpoint& checkpoint) = 0;
};

}  // namespace softgrain
