#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "softgrain/lattice/updated_lagrangian.hpp"
#include "softgrain/model/model.hpp"

namespace softgrain {

/// Elastic grains by updated-Lagrangian MPM (the paper's own MPM), to be compared with ElasticGrains, which
/// has the same columns.
class LatticeGrains final : public Model {
 public:
  explicit LatticeGrains(UpdatedLagrangianDynamics dynamics) : dynamics_(std::move(dynamics)) {}

  std::unique_ptr<Model> copy() const override { return std::make_unique<LatticeGrains>(*this); }
  StepReport step(Box<2>& box, double dt) override;
  void visit(StateVisitor& visit) override;
  Settings settings() const override;
  void set(const Settings& settings) override;

  double density() const override { return dynamics_.density; }
  std::vector<double> radii() const override;
  std::vector<Vec<2>> centres() const override;
  Bodies bodies() const override;
  std::vector<ContactPoint> contacts() const override;
  Outlines outlines() const override;
  std::pair<double, double> extent(int axis) const override;
  Energies energies() const override;
  Numbers numbers(const Box<2>& box) const override;
  Scene scene(const Box<2>& box) const override;
  std::pair<double, double> reach() const override;
  std::vector<GrainView> grains() const override;

  const UpdatedLagrangianDynamics& dynamics() const { return dynamics_; }

 private:
  UpdatedLagrangianDynamics dynamics_;
  double impulse_time_ = 0;  // [s]
};

}  // namespace softgrain
