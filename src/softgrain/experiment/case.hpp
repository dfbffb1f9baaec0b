#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "softgrain/geometry/outline_curve.hpp"
#include "softgrain/geometry/star_surface.hpp"
#include "softgrain/lattice/contact_on.hpp"
#include "softgrain/lattice/shape_functions.hpp"
#include "softgrain/loading/stage.hpp"
#include "softgrain/material/material_law.hpp"
#include "softgrain/math/precision.hpp"
#include "softgrain/rigid/activation.hpp"
#include "softgrain/sample/diameters.hpp"
#include "softgrain/sample/placed_grain.hpp"

namespace softgrain {

// The choices of a case. Their words in case files: io/case/words.hpp.

enum class LoadingPath {
  diametral,   ///< one grain between two walls, the top one moves
  compaction,  ///< grains in a box whose top wall comes down
  isotropic,   ///< grains in a box whose four walls come in
  biaxial,     ///< isotropic to a stress, then top and bottom wall come in while the side walls keep it
  triaxial,    ///< the same in space, where four side walls keep it
  shear,       ///< isotropic to a stress, then simple shear of a periodic cell under that stress
  die,         ///< the top wall presses grains in a box, keeps the stress, and leaves; the sides open
  relaxation,  ///< compaction, then rest
  stages,      ///< grains in a box, along stages of one's own
};
enum class GrainModel { bpm, mpm, rigid };  ///< bonded rigid primaries, an elastic body, a rigid one
enum class ShapeOfGrain {
  disk,
  ellipse,
  polygon,
  outline,  ///< of the grain's own
  surface,  ///< the same in space
};
enum class EqualPrimaries { count, size };  ///< what the grains of a packing share
enum class Integrator {
  backward_euler,    ///< implicit
  symplectic_euler,  ///< explicit
};
enum class BoxEnd { walls, periodic };  ///< what ends a box along an axis
enum class Places {
  random,
  pour,  ///< as they lie after they have fallen into the box
};
enum class Formulation { total_lagrangian, updated_lagrangian };

/// One experiment, complete: what a case file says, in SI units, with every default filled in. Per metre of
/// depth.
struct Case {
  struct Experiment {
    LoadingPath loading = LoadingPath::diametral;
    GrainModel model = GrainModel::bpm;
    int dimension = 2;  ///< of space; in 2 everything is per metre of depth
  } experiment;

  struct Grain {
    double radius = 5e-3;                     ///< R [m]
    double density = 990;                     ///< rho [kg/m^3]: the grain weighs rho pi R^2
    ShapeOfGrain shape = ShapeOfGrain::disk;  ///< others than disks lie in the circle of the diameter
    double aspect = 2;                        ///< of an ellipse, long over short axis
    int sides = 5;                            ///< of a regular polygon
    std::vector<OutlinePoint> outline{};      ///< of a shape of one's own, in any unit
    TriangleMesh surface{};                   ///< of one in space, in any unit
    double angle = 0;                         ///< by which one between two walls is turned [rad]
  } grain;

  struct Bpm {
    int primaries = 1750;              ///< rigid primary particles in a grain
    double size_ratio = 1.625;         ///< largest over smallest primary diameter (paper: 0.26 mm / 0.16 mm)
    double attraction = 100;           ///< F0 of a grain between walls [N/m]
    double force = 0.2;                ///< the same in space [N]
    double cohesive_pressure = 0.5e6;  ///< sigma_I = F0/<a0>, or F0/<a0>^2, of each grain of a packing [Pa]
    double exponent = 7;               ///< gamma [-]
    double inner_friction = 0;         ///< mu between the primaries of a grain
    EqualPrimaries equal = EqualPrimaries::count;
    int library = 6;  ///< different aggregates of which a packing is made
  } bpm;

  struct Mpm {
    MaterialLaw law = MaterialLaw::neo_hookean;
    MaterialParameters material;  ///< of the law
    int cells = 16;               ///< along a side of the inner square: 14 cells^2 points in a grain
    Integrator integrator = Integrator::backward_euler;
    Formulation formulation = Formulation::total_lagrangian;       ///< or updated, for comparison
    Integrator lattice_integrator = Integrator::symplectic_euler;  ///< of updated_lagrangian
    ShapeFunction shape_functions = ShapeFunction::gimp;           ///< of updated_lagrangian
    ContactOn contact_on = ContactOn::outline;                     ///< of updated_lagrangian
    double tolerance = 1e-4;  ///< largest last correction of Newton's method, over the mean grain radius
    double damping = 0;       ///< zeta [1/s] of f = -zeta m (v - v_walls)
  } mpm;

  struct Contact {
    double friction = 0;             ///< mu between grains
    double wall_friction = 0;        ///< mu against walls
    double surface_energy = 0;       ///< w between grains [J/m^2]; 0: they do not adhere
    double wall_surface_energy = 0;  ///< w against walls [J/m^2]
    double adhesion_range = 0;  ///< delta, up to which they attract [m]; 0: as the grid asks (adhesion_of)
    double restitution = 0;     ///< e_n, Newton's
    Activation activation = Activation::anticipated;
    double push_out = 0.1;  ///< beta: share of an existing overlap removed in a step
  } contact;

  struct Solver {
    int min_sweeps = 8;
    int max_sweeps = 50;
    double tolerance = 1e-5;  ///< mean overlap gained in a step over the mean primary diameter
    double relaxation = 1.2;  ///< omega
    Precision precision = Precision::single;  ///< of the sweeps
  } solver;

  struct Loading {
    double wall_velocity = 0.2;       ///< of the top wall; of opposite walls towards each other [m/s]
    double max_strain = 0.35;         ///< strain at the end of loading
    double max_packing_fraction = 0;  ///< Phi_0 at the end, of grains in a box; 0: as max_strain says
    double max_stress = 0;            ///< sigma at the end, of grains in a box [Pa]; 0: any
    double max_overlap = 0;           ///< mean, of primaries over their radius, at the end, in a box; 0: any
    std::vector<double> unload_at{};  ///< strains at which the wall turns back
    double unload_by = 0.015;         ///< strain given back before loading again
    double hold = 0;                  ///< rest of the wall at each turn and at the end [s]
    double hold_stress = 0;           ///< sigma that walls keep for `hold` before the end [Pa]; 0: none
    double confining_stress = 0;      ///< of the side walls of a biaxial path [Pa]
    double shear_rate = 0;            ///< of a periodic cell [1/s]; 0: quasi-static
    double inertial_number = 1e-3;    ///< of what is quasi-static
    bool quasi_static = false;        ///< whether the case leaves a speed or a rate to it; no key
    double max_shear = 1;             ///< shear strain at the end
    double rest = 0;     ///< kinetic over stored energy that ends the rest of a relaxation; 0: none
    bool eject = false;  ///< whether the side walls of a die open after unloading, until they bear nothing
  } loading;

  std::vector<Stage> stages{};  ///< of one's own, instead of those of a short form

  struct Time {
    double step = 0;  ///< dt [s]; 0: the model's own (first_time_step)
  } time;

  /// How the diameters of grains in a box are distributed.
  struct Sizes {
    SizeLaw sizes = SizeLaw::uniform;
    double smallest_diameter = 1.4e-3,
           largest_diameter = 2.4e-3;  ///< of grains in a box [m]
    double median_diameter = 1.8e-3;   ///< of lognormal sizes [m]
    double deviation = 0.15;           ///< of ln d of lognormal sizes
    std::vector<double> diameters{};   ///< of a list [m]
    std::vector<double> shares{};      ///< of the grains' area that each of them has; empty: `numbers`
    std::vector<double> numbers{};     ///< how many grains of each, in proportion; empty: as many of each
  };

  struct Sample : Sizes {
    std::int64_t seed = 1;
    Places places = Places::random;     ///< of grains that are not placed one by one
    int grains = 20;                    ///< in a box
    double packing_fraction = 0.7;      ///< of the undeformed grains in the box at the start
    double aspect = 1;                  ///< width over height of the box at the start
    std::vector<PlacedGrain> placed{};  ///< in their places, instead of random ones; see complete_sample
    std::vector<double> placed_z{};     ///< z of each of these in space [m]
  } sample;

  /// Of several kinds of grains: what `grain`, `mpm` and `sample` say where there is but one.
  struct Kind {
    std::string name;
    int grains = 0;                      ///< in the box
    GrainModel model = GrainModel::mpm;  ///< rigid ones mix with those of one other model
    Grain grain;                         ///< but its radius
    Bpm bpm;                             ///< of bonded grains
    MaterialLaw law = MaterialLaw::neo_hookean;
    MaterialParameters material;
    int cells = 0;
    Sizes sizes;
  };
  std::vector<Kind> kinds{};  ///< none, or at least two (experiment/kinds.hpp)

  /// Contact of two kinds, or of a kind and the walls, where it is not what `contact` says.
  struct Pair {
    static constexpr int wall = -1;
    int kind = 0, other = wall;              ///< numbers in `kinds`
    std::optional<double> friction{};        ///< mu
    std::optional<double> surface_energy{};  ///< w [J/m^2]
    std::optional<double> adhesion_range{};  ///< delta [m]
  };
  std::vector<Pair> pairs{};

  struct Box {
    BoxEnd x = BoxEnd::walls, y = BoxEnd::walls, z = BoxEnd::walls;  ///< z in space
    /// Of placed grains [m], depth along y in space; 0: as far as the grains reach
    double width = 0, height = 0, depth = 0;
    double gravity_x = 0, gravity_y = 0, gravity_z = 0;  ///< [m/s^2]
    bool open_top = false;                               ///< no top wall until a stage moves it
  } box;

  struct Output {
    int samples = 600;          ///< rows of series.csv, evenly over the run
    int snapshots = 24;         ///< restart points, evenly over the run
    double snapshot_every = 0;  ///< wall time after which another one is due [s]; 0: never
    bool vtk = true;            ///< .vtp files for ParaView beside the snapshots
    bool report = true;         ///< report.html when the run is done
  } output;
};

/// Grains in a box; else one grain between two walls.
inline bool is_in_a_box(const Case& c) { return c.experiment.loading != LoadingPath::diametral; }
inline bool is_in_space(const Case& c) { return c.experiment.dimension == 3; }
/// A box that repeats along x, y, and z in space.
inline std::array<bool, 3> repeats_of(const Case& c) {
  if (!is_in_a_box(c)) return {};
  return {c.box.x == BoxEnd::periodic, c.box.y == BoxEnd::periodic,
          is_in_space(c) && c.box.z == BoxEnd::periodic};
}
/// Along the axis of the height.
inline bool repeats_in_height(const Case& c) {
  return repeats_of(c)[static_cast<std::size_t>(c.experiment.dimension - 1)];
}
template <int Dim = 2>
Vec<Dim> gravity_of(const Case& c) {
  if (!is_in_a_box(c)) return {};
  Vec<Dim> g{c.box.gravity_x, c.box.gravity_y};
  if constexpr (Dim == 3) g[2] = c.box.gravity_z;
  return g;
}
inline bool is_bonded(const Case& c) { return c.experiment.model == GrainModel::bpm; }
inline bool is_elastic(const Case& c) { return c.experiment.model == GrainModel::mpm; }
inline bool is_rigid(const Case& c) { return c.experiment.model == GrainModel::rigid; }
inline bool is_isotropic(const Case& c) { return c.experiment.loading == LoadingPath::isotropic; }

}  // namespace softgrain
