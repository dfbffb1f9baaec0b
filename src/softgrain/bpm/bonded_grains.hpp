#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/bpm/bonded_view.hpp"
#include "softgrain/model/model.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// Coefficients of friction mu: between primaries of one grain, of two, and against walls.
struct FrictionOfPrimaries {
  double inside = 0, between = 0, wall = 0;

  /// Of primaries whose grains are these.
  FrictionRule rule(const std::vector<int>& grain_of) const {
    return [friction = *this, grain_of](int a, int b) {
      if (b >= static_cast<int>(grain_of.size())) return friction.wall;
      return grain_of[a] == grain_of[b] ? friction.inside : friction.between;
    };
  }
  friend bool operator==(const FrictionOfPrimaries&, const FrictionOfPrimaries&) = default;
};

/// Grains of bonded primaries as they are placed.
struct BondedGrainsSetup {
  RigidParticles<2> particles;       ///< grain after grain
  std::vector<double> grain_radius;  ///< of the undeformed grains [m]
  std::vector<Attraction> laws;      ///< of each grain
  FrictionOfPrimaries friction;
  RigidStepOptions options;
  double skin = 0;     ///< of the lists of pairs [m]
  double density = 0;  ///< of the grains [kg/m^3]
  double sigma_I = 0;  ///< F0/<a0>, the same in all grains [Pa]
  Vec<2> gravity{};    ///< [m/s^2]
};

/// The bonded-particle model: a grain is an aggregate of rigid primaries that attract each other and touch by
/// contact dynamics (the paper's BPM-CD). In a box the grains are exhausted where their primaries are packed
/// so densely that no smaller box holds them: rigid disks have no solution past their own random close
/// packing, and a growing overlap says so.
class BondedGrains final : public Model {
 public:
  explicit BondedGrains(BondedGrainsSetup setup);

  std::unique_ptr<Model> copy() const override { return std::make_unique<BondedGrains>(*this); }
  /// The first step starts without a guess of the impulses and may take 200 times the sweeps.
  StepReport step(Box<2>& box, double dt) override;
  void follow(const Mat<2>& L) override;
  bool is_exhausted(const StepReport& report, const Box<2>& box) const override;
  std::string exhaustion(const Box<2>& box) const override;
  void gather() override;
  void visit(StateVisitor& visit) override;
  void go_on(const Box<2>& box) override;
  Settings settings() const override;
  void set(const Settings& settings) override;

  double density() const override { return density_; }
  std::vector<double> radii() const override { return grain_radius_; }
  std::vector<Vec<2>> centres() const override;
  Bodies bodies() const override;
  /// Contacts between grains, and with walls.
  std::vector<ContactPoint> contacts() const override { return contact_points(dynamics_, impulse_time_); }
  Outlines outlines() const override { return outlines_of(dynamics_); }
  std::pair<double, double> extent(int axis) const override;
  Energies energies() const override;
  Numbers numbers(const Box<2>& box) const override;
  Scene scene(const Box<2>& box) const override;
  std::pair<double, double> reach() const override;
  std::vector<GrainView> grains() const override;
  PressBody press_body(const Box<2>& box, int axis, double dt) const override;
  void catch_problem() override;
  SolvedContactProblem caught_problem(double dt) override;

  const RigidDynamics<2>& dynamics() const { return dynamics_; }

 private:
  /// Work over the run [J/m].
  struct Work {
    double walls = 0, dissipation = 0;
    double between = 0, friction = 0;  // of the dissipation: between grains; by sliding there
    double energy_start = 0;           // potential energies before the first step
    double height_start = 0;           // of them that of gravity
  };
  void add_work();
  double solid_fraction(const Box<2>& box) const;  // area of the primaries over that of the box
  int clusters() const;
  double energy_of_height() const;  // -sum m g . x [J/m]

  std::vector<double> grain_radius_;
  double density_ = 0, sigma_I_ = 0;
  Vec<2> gravity_{};
  FrictionOfPrimaries friction_;
  AttractionForces attraction_;
  RigidDynamics<2> dynamics_;
  int most_sweeps_ = 0;      // of a step but the first
  double impulse_time_ = 0;  // the step over which impulses acted; 0: none was made [s]
  Work work_;
  std::vector<Vec<2>> velocity_start_;  // of the step whose problem is kept
  bool keeps_problem_ = false;
};

}  // namespace softgrain
