#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/mixed/primary_neighbours.hpp"
#include "softgrain/soft/elastic_grains.hpp"

namespace softgrain {

/// Elastic and bonded grains of one sample as they are placed. Each engine numbers its grains from 0, and its
/// kinds; here they have the numbers of the sample.
struct MixedGrainsSetup {
  ExplicitDynamics elastic;
  BondedGrainsSetup bonded;         ///< rigid disks, too, as single primaries
  std::vector<int> elastic_number;  ///< (elastic grains) in the sample
  std::vector<int> bonded_number;   ///< (bonded and rigid grains)
  std::vector<int> kind;            ///< (grains of the sample)
  int kinds = 1;
  std::vector<PairFriction> pair_friction{};  ///< of pairs of these kinds
};

/// Bonded grains among elastic ones in the plane, by symplectic Euler, under one contact solve: contacts of
/// outlines and walls, of primaries and walls, and of primaries and outlines (docs/decisions/0080). The
/// elastic engine leads: its sub-steps are those of all, and it moves presses.
class MixedGrains final : public Model {
 public:
  explicit MixedGrains(MixedGrainsSetup setup);

  std::unique_ptr<Model> copy() const override { return std::make_unique<MixedGrains>(*this); }
  StepReport step(Box<2>& box, double dt) override;
  bool is_exhausted(const StepReport& report, const Box<2>& box) const override;
  std::string exhaustion(const Box<2>& box) const override { return bonded_.exhaustion(box); }
  void follow(const Mat<2>& L) override;
  void visit(StateVisitor& visit) override;
  void go_on(const Box<2>& box) override;
  Settings settings() const override { return elastic_.settings().then(bonded_.settings()); }
  void set(const Settings& settings) override;
  void begin_row() override { elastic_.begin_row(); }

  double density() const override;  ///< of all grains together
  std::vector<double> radii() const override { return in_order(elastic_.radii(), bonded_.radii()); }
  std::vector<Vec<2>> centres() const override { return in_order(elastic_.centres(), bonded_.centres()); }
  Bodies bodies() const override;
  std::vector<ContactPoint> contacts() const override;
  Outlines outlines() const override;
  std::pair<double, double> extent(int axis) const override;
  Energies energies() const override;
  Numbers numbers(const Box<2>& box, const Energies& energies) const override;
  Scene scene(const Box<2>& box) const override;
  std::pair<double, double> reach() const override;
  std::vector<GrainView> grains() const override { return in_order(elastic_.grains(), bonded_.grains()); }

  PressBody press_body(const Box<2>& box, int axis, double dt) const override;

  const ElasticGrains<ExplicitDynamics>& elastic() const { return elastic_; }
  const BondedGrains& bonded() const { return bonded_; }
  /// Those of primaries and outlines, with their impulses of the last sub-step [N s/m].
  const std::vector<PrimaryContact>& primary_contacts() const { return contacts_; }
  const std::vector<Vec<2>>& primary_impulses() const { return impulse_; }

 private:
  SolverReport solve(const ContactsOfStep<2>& step);
  std::vector<double> friction() const;
  int pushing() const;  // of primary_contacts
  void tell_who_is_met();
  std::vector<BranchForce> forces_on_primaries() const;
  int spans_pushing(std::size_t contact) const;
  std::vector<ContactPoint> between_models() const;
  void add_outlines(const std::vector<ContactPoint>& points, Scene& scene) const;

  /// What each engine says of its grains, in the order of the sample.
  template <class T>
  std::vector<T> in_order(const std::vector<T>& of_elastic, const std::vector<T>& of_bonded) const {
    std::vector<T> all(kind_.size());
    for (std::size_t k = 0; k < of_elastic.size(); ++k) all[elastic_number_[k]] = of_elastic[k];
    for (std::size_t k = 0; k < of_bonded.size(); ++k) all[bonded_number_[k]] = of_bonded[k];
    return all;
  }

  ElasticGrains<ExplicitDynamics> elastic_;
  BondedGrains bonded_;
  std::vector<int> elastic_number_, bonded_number_, kind_;
  int kinds_;
  std::vector<PairFriction> pair_friction_;
  double mean_primary_ = 0;  // radius [m]
  StepReport bonded_report_;
  PrimaryNeighbours neighbours_;
  std::vector<PrimaryContact> contacts_;
  std::vector<Vec<2>> impulse_;
};

}  // namespace softgrain
