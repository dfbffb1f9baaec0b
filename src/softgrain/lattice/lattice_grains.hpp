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
  void begin_row() override { sums_.steps = sums_.iterations = 0; }

  double density() const override { return dynamics_.density; }
  std::vector<double> radii() const override;
  std::vector<Vec<2>> centres() const override;
  Bodies bodies() const override;
  std::vector<ContactPoint> contacts() const override;
  Outlines outlines() const override;
  std::pair<double, double> extent(int axis) const override;
  Energies energies() const override;
  Numbers numbers(const Box<2>& box, const Energies& energies) const override;
  Scene scene(const Box<2>& box) const override;
  std::pair<double, double> reach() const override;
  std::vector<GrainView> grains() const override;

  const UpdatedLagrangianDynamics& dynamics() const { return dynamics_; }

 private:
  /// Steps and iterations since the last row; sub-steps taken back over the run.
  struct Sums {
    double steps = 0, iterations = 0, rejected = 0;
  };
  void visit_implicit(StateVisitor& visit);

  UpdatedLagrangianDynamics dynamics_;
  double impulse_time_ = 0;  // [s]
  Sums sums_;                // of implicit steps
};

}  // namespace softgrain
