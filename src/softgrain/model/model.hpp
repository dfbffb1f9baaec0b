#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/contact/step_report.hpp"
#include "softgrain/geometry/box.hpp"
#include "softgrain/model/settings.hpp"
#include "softgrain/observe/contact_network.hpp"
#include "softgrain/observe/energy.hpp"
#include "softgrain/observe/observation.hpp"
#include "softgrain/observe/surface_measure.hpp"
#include "softgrain/state/field.hpp"

namespace softgrain {

/// What can be drawn: disks (primaries, or material points), outlines of grains, walls as segments, and
/// contacts with their force.
struct Scene {
  Arrays particles;  ///< position (n, 2), radius, then any field by primary or point
  /// pair (m, 2) of particles, walls from n on, in the order of wall_segments; force (m, 1) [N/m], normal.
  /// With a position (m, 2) [m] of their own the pairs are of grains, not of particles; walls from their
  /// number on.
  Arrays contacts;
  Arrays outlines;  ///< position (v, 2) of the outlines' vertices, grain (v): a new grain, a new polygon
  /// In space positions have three columns, outlines are closed surfaces, and `surface` has their quads:
  /// quad (q, 4) of vertices, counter-clockwise seen from outside, grain (q), and of the cell behind pressure
  /// (q) [Pa], J (q) and Cauchy stress (q, 9) [Pa]; walls (w, 12), four corners of each face [m]
  Arrays surface;
  std::vector<double>
      wall_segments;  ///< in the plane x0 y0 x1 y1 for each wall, or edge of a periodic cell [m]
  /// Its lattice vectors, x0 y0 x1 y1, in space three of three, 0 for one that it has not [m]; or empty
  std::vector<double> cell;
};

/// Particles of a scene that come part after part, so that those of a large packing are nowhere whole.
struct ParticleParts {
  int count = 0;       ///< 0: the scene has its particles itself
  ArrayShapes arrays;  ///< of all parts together
  /// Those of part 0, 1, ... On several ranks all ask at once, for the first one.
  std::function<Arrays(int part)> rows;
};

/// Vectors where they lie in memory: component d of row i is begin[i * row + d * component].
struct VectorView {
  const double* begin = nullptr;
  std::size_t rows = 0;
  std::size_t row = 2, component = 1;
};

/// One grain where it lies in memory: it follows the steps, and lasts as long as the model.
struct GrainView {
  VectorView position;  ///< of primaries, grid nodes or material points [m]
  VectorView velocity;  ///< theirs [m/s]
  VectorView outline;   ///< vertices, counter-clockwise [m]; none where only the scene finds them (bpm)
};

/// Outlines of all grains, one after the other.
struct Outlines {
  std::vector<Vec<2>> vertex;  ///< each grain's counter-clockwise [m]
  std::vector<int> begin;      ///< (grains + 1) first vertex of each grain
  double area = 0;             ///< of all grains, deformed: sum of A_g [m^2]
};

/// In space, how large each grain is.
template <int Dim>
using OutlinesOf = std::conditional_t<Dim == 2, Outlines, std::vector<SurfaceMeasure>>;

/// Bodies that move, whatever they are: primaries, nodes or points.
template <int Dim>
struct BodiesOf {
  std::vector<double> mass;        ///< [kg/m in the plane]
  std::vector<Vec<Dim>> velocity;  ///< [m/s]
  std::vector<int> grain;          ///< to which each belongs
};
using Bodies = BodiesOf<2>;

/// Mass and damper of a press, over the area of its walls.
struct PressBody {
  double mass = 0;    ///< [kg/m^2]
  double damper = 0;  ///< [Pa s/m]
};

/// Of grains that fill a box of length L along the axis of the press, with waves of speed c. Their stiffness
/// over the area of a wall is k = rho c^2/L, and
///   m = k tau^2,  Z = 2 k tau,  tau = max(L/c, dt/10):
/// the press is damped critically and takes up the waves that come to it; in long implicit steps, which damp
/// by themselves, it weighs a few hundredths of what its contacts do.
/// Grains that are softer, as a packing is before it jams, damp it more.
PressBody critically_damped(double density, double wave_speed, double length, double dt);

/// Grains in a box, however they are modelled. A model knows no case, no path, no row and no file.
template <int Dim>
class ModelOf {
 public:
  virtual ~ModelOf() = default;
  virtual std::unique_ptr<ModelOf> copy() const = 0;

  /// One step of dt [s]; the walls of the box move by dt times their velocity and get the impulses that they
  /// felt. Raises NumericalError where the state is not finite or no solution is found.
  virtual StepReport step(Box<Dim>& box, double dt) = 0;
  /// On several ranks, on all at once: the first one gets what a step left with the rank of a grain alone.
  /// Before that nobody, and after it the first one alone, may look at more than contacts between grains (and
  /// in a periodic cell at centres, in an open box at the extent).
  virtual void gather() {}
  /// After a step: true if no smaller box holds the grains. Raises NumericalError where its overlaps show
  /// that the step has no solution.
  virtual bool is_exhausted(const StepReport&, const Box<Dim>&) const { return false; }
  /// Why no smaller box holds them, for the user.
  virtual std::string exhaustion(const Box<Dim>&) const { return ""; }

  /// All that the next step depends on but the box.
  virtual void visit(StateVisitor& visit) = 0;
  /// After a visitor has read the state: with this box the model is as if it had never stopped, bit for bit.
  virtual void go_on(const Box<Dim>&) {}
  /// Each grain as a whole gets the velocity L x more, x its centre; the work that this takes is the walls'.
  virtual void follow(const Mat<Dim>& /*L*/) {}
  /// What holds now, of what may change.
  virtual Settings settings() const { return {}; }
  /// From the coming step on. Before a visitor reads the state, so that it is read as it was written.
  virtual void set(const Settings&) {}
  /// Sums since the last row begin again.
  virtual void begin_row() {}

  virtual double density() const = 0;                 ///< of the grains [kg/m^3]
  virtual std::vector<double> radii() const = 0;      ///< of the undeformed grains [m]
  virtual std::vector<Vec<Dim>> centres() const = 0;  ///< of mass, of the grains [m]
  virtual BodiesOf<Dim> bodies() const = 0;
  virtual std::vector<ContactPointOf<Dim>> contacts() const = 0;  ///< that carry impulse, of the last step
  virtual OutlinesOf<Dim> outlines() const = 0;
  /// Least and largest coordinate of the grains along an axis [m].
  virtual std::pair<double, double> extent(int axis) const = 0;
  virtual Energies energies() const = 0;
  /// What only this model knows, by the names of its columns; energies: what energies() says now.
  virtual Numbers numbers(const Box<Dim>& box, const Energies& energies) const = 0;
  /// Points, contacts and outlines; of walls without sides the x from which to which they are drawn.
  virtual Scene scene(const Box<Dim>& box) const = 0;
  /// The particles of the same scene, if they come in parts; and the scene without them. They hold until the
  /// next step.
  virtual ParticleParts particle_parts() const { return {}; }
  virtual Scene scene_without_parts(const Box<Dim>& box) const { return scene(box); }
  virtual std::pair<double, double> reach() const = 0;
  virtual std::vector<GrainView> grains() const = 0;

  /// Of a press along an axis, in steps of dt [s].
  virtual PressBody press_body(const Box<Dim>&, int /*axis*/, double /*dt*/) const { return {}; }

  /// Keeps the contact problem of the next step, with its impulses per metre of depth; where a step solves
  /// several, the last. Raises UsageError where no such problem can be had.
  virtual void catch_problem();
  /// That was kept.
  virtual SolvedContactProblem caught_problem(double dt);
};
using Model = ModelOf<2>;

}  // namespace softgrain
