#pragma once
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "softgrain/model/model.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "softgrain/soft/soft_view.hpp"

namespace softgrain {

/// Soft grains by the material point method on grids that fit them (the paper's MPM-CD, total Lagrangian).
/// `Dynamics` is ImplicitDynamics, or ExplicitStep in the plane or in space: all hold the same data.
template <class Dynamics>
class ElasticGrains final : public ModelOf<Dynamics::dimension> {
 public:
  static constexpr int Dim = Dynamics::dimension;  // NOLINT(readability-identifier-naming): as a parameter

  /// Grains among as many walls as the dynamics were given.
  explicit ElasticGrains(Dynamics dynamics)
      : dynamics_(std::move(dynamics)), walls_(static_cast<int>(dynamics_.box.walls.size())) {}

  std::unique_ptr<ModelOf<Dim>> copy() const override { return std::make_unique<ElasticGrains>(*this); }
  StepReport step(Box<Dim>& box, double dt) override {
    return step_by(box, [&] { return dynamics_.step(dt); });
  }
  /// The same of an explicit step whose contacts bodies of another model share.
  template <class Joint>  // a JointSolve
  StepReport joint_step(Box<Dim>& box, double dt, const Joint& joint) {
    return step_by(box, [&] { return dynamics_.step(dt, joint); });
  }
  void follow(const Mat<Dim>& L) override {
    dynamics_.grains.know_all();
    dynamics_.work.walls += add_affine_velocity(dynamics_.grains, L);
  }
  void gather() override { dynamics_.grains.gather(); }
  void visit(StateVisitor& visit) override;
  Settings settings() const override;
  void set(const Settings& settings) override;
  void begin_row() override { sums_.steps = sums_.iterations = 0; }

  double density() const override { return dynamics_.grains.mean_density(); }
  std::vector<double> radii() const override;
  std::vector<Vec<Dim>> centres() const override { return centres_of(dynamics_.grains); }
  BodiesOf<Dim> bodies() const override { return nodes_of(dynamics_.grains); }
  std::vector<ContactPointOf<Dim>> contacts() const override { return contact_points(view()); }
  OutlinesOf<Dim> outlines() const override { return outlines_of(dynamics_.grains); }
  std::pair<double, double> extent(int axis) const override;
  Energies energies() const override;
  Numbers numbers(const Box<Dim>& box, const Energies& energies) const override;
  Scene scene(const Box<Dim>&) const override { return soft_scene(view()); }
  ParticleParts particle_parts() const override { return softgrain::particle_parts(view()); }
  Scene scene_without_parts(const Box<Dim>&) const override { return scene_around_points(view()); }
  std::pair<double, double> reach() const override;
  std::vector<GrainView> grains() const override { return grain_views(dynamics_.grains); }
  PressBody press_body(const Box<Dim>& box, int axis, double dt) const override;
  void catch_problem() override;
  SolvedContactProblem caught_problem(double dt) override;

  const Dynamics& dynamics() const { return dynamics_; }
  /// In a joint step, for what bodies of another model give.
  Dynamics& dynamics() { return dynamics_; }

 private:
  /// Steps and iterations since the last row; sub-steps taken back over the run.
  struct Sums {
    double steps = 0, iterations = 0, rejected = 0;
  };
  StepReport step_by(Box<Dim>& box, const std::function<SoftStepReport()>& advance);
  SoftViewOf<Dim> view() const;

  Dynamics dynamics_;
  int walls_;
  Sums sums_;
};

}  // namespace softgrain
