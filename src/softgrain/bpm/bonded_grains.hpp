#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/bpm/bonded_view.hpp"
#include "softgrain/bpm/surface_attraction.hpp"
#include "softgrain/contact/pair_friction.hpp"
#include "softgrain/model/model.hpp"
#include "softgrain/observe/stress.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// Coefficients of friction mu: between primaries of one grain, of two, and against walls.
struct FrictionOfPrimaries {
  std::vector<double> inside{0};  ///< of each kind
  double between = 0, wall = 0;
  std::vector<PairFriction> named{};  ///< of pairs of kinds, instead of those two

  /// Of primaries whose grains are these, grains of these kinds.
  FrictionRule rule(const std::vector<int>& grain_of, const std::vector<int>& kind_of_grain) const;
};

/// Grains of bonded primaries as they are placed.
template <int Dim>
struct BondedGrainsSetupOf {
  RigidParticles<Dim> particles;     ///< grain after grain
  std::vector<double> grain_radius;  ///< of the undeformed grains [m]
  std::vector<Attraction> laws;      ///< of each grain
  std::vector<int> kind;             ///< of each grain
  FrictionOfPrimaries friction;
  std::vector<PairAdhesion> adhesion{};  ///< between grains, and at walls, of pairs of kinds
  RigidStepOptions options;
  double skin = 0;     ///< of the lists of pairs [m]
  double density = 0;  ///< of the grains, the largest [kg/m^3]
  double sigma_I = 0;  ///< F0/<a0>, in space F0/<a0>^2, of all grains; of several kinds the least [Pa]
  Vec<Dim> gravity{};  ///< [m/s^2]
};
using BondedGrainsSetup = BondedGrainsSetupOf<2>;

/// What contacts with the bodies of another model took in a step [J/m, J in space]: of what the primaries
/// lost, and of it by sliding.
struct JointWork {
  double contact = 0, friction = 0;
};

/// The bonded-particle model: a grain is an aggregate of rigid primaries that attract each other and touch by
/// contact dynamics (the paper's BPM-CD). In a box the grains are exhausted where their primaries are packed
/// so densely that no smaller box holds them: rigid disks have no solution past their own random close
/// packing, and a growing overlap says so. In space primaries are spheres.
template <int Dim>
class BondedGrainsOf final : public ModelOf<Dim> {
 public:
  explicit BondedGrainsOf(BondedGrainsSetupOf<Dim> setup);

  std::unique_ptr<ModelOf<Dim>> copy() const override { return std::make_unique<BondedGrainsOf>(*this); }
  /// The first step starts without a guess of the impulses and may take 200 times the sweeps.
  StepReport step(Box<Dim>& box, double dt) override;
  /// A step in two parts, whose contacts bodies of another model may share (docs/decisions/0080), by
  /// symplectic Euler: forces, gaps and frames at x, and x+ = x + dt v+. First the velocities without
  /// contacts; the system keeps references, and its impulses, those of the step before, have not acted. No
  /// cell, no presses. take_walls before; walls go on by themselves.
  RigidContactSystem<Dim> begin_joint_step(double dt);
  /// Once all impulses have acted.
  StepReport end_joint_step(const SolverReport& solver, double dt, const JointWork& with_others);
  /// Walls, presses and cell as they are in the box.
  void take_walls(const Box<Dim>& box);
  /// Of the coming step: the first one may take more sweeps.
  SolverOptions solver_options() const;
  void follow(const Mat<Dim>& L) override;
  bool is_exhausted(const StepReport& report, const Box<Dim>& box) const override;
  std::string exhaustion(const Box<Dim>& box) const override;
  void gather() override;
  void visit(StateVisitor& visit) override;
  void go_on(const Box<Dim>& box) override;
  Settings settings() const override;
  void set(const Settings& settings) override;

  double density() const override { return density_; }
  std::vector<double> radii() const override { return grain_radius_; }
  std::vector<Vec<Dim>> centres() const override;
  BodiesOf<Dim> bodies() const override;
  /// Contacts between grains, and with walls.
  std::vector<ContactPointOf<Dim>> contacts() const override {
    return contact_points(dynamics_, adhesion_, impulse_time_);
  }
  OutlinesOf<Dim> outlines() const override { return outlines_of(dynamics_); }
  std::pair<double, double> extent(int axis) const override;
  Energies energies() const override;
  Numbers numbers(const Box<Dim>& box, const Energies& energies) const override;
  Scene scene(const Box<Dim>& box) const override { return scene_with(box, {}); }
  /// With more forces on primaries, for their pressures.
  Scene scene_with(const Box<Dim>& box, std::span<const BranchForceOf<Dim>> more) const;
  std::pair<double, double> reach() const override;
  std::vector<GrainView> grains() const override;
  PressBody press_body(const Box<Dim>& box, int axis, double dt) const override;
  void catch_problem() override;
  SolvedContactProblem caught_problem(double dt) override;

  const RigidDynamics<Dim>& dynamics() const { return dynamics_; }
  /// Between the parts of a joint step, when impulses of others act on the primaries.
  RigidDynamics<Dim>& dynamics() { return dynamics_; }

 private:
  /// Work over the run [J/m, J in space].
  struct Work {
    double walls = 0, dissipation = 0;
    double between = 0, friction = 0;  // of the dissipation: between grains; by sliding there
    double energy_start = 0;           // potential energies before the first step
    double height_start = 0;           // of them that of gravity
  };
  double add_forces(std::span<Vec<Dim>> force);
  void add_work();
  void list_attraction();
  double energy_of_attraction() const;               // inside grains and between them
  double solid_fraction(const Box<Dim>& box) const;  // of the box that primaries fill
  int clusters() const;
  double attraction_ratio() const;
  double energy_of_height() const;  // -sum m g . x

  int kinds() const;

  std::vector<double> grain_radius_;
  std::vector<int> kind_;  // of each grain
  double density_ = 0, sigma_I_ = 0;
  Vec<Dim> gravity_{};
  FrictionOfPrimaries friction_;
  AttractionForcesOf<Dim> attraction_;
  SurfaceAttraction<Dim> adhesion_;
  RigidDynamics<Dim> dynamics_;
  int most_sweeps_ = 0;      // of a step but the first
  double impulse_time_ = 0;  // the step over which impulses acted; 0: none was made [s]
  Work work_;
  std::vector<Vec<Dim>> velocity_start_;  // of the step whose problem is kept
  bool keeps_problem_ = false;
};
using BondedGrains = BondedGrainsOf<2>;

}  // namespace softgrain
