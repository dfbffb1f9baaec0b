#pragma once
#include <string>
#include <vector>

#include "softgrain/experiment/bpm_sample.hpp"
#include "softgrain/experiment/bpm_simulation.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/observe/contact_network.hpp"

namespace softgrain {

/// A box of bonded-particle grains whose lid comes down, the other walls at rest: the paper's Figs. 2-4; or
/// whose walls all come in. No gravity. Attraction and inner friction act within a grain, contact.friction
/// between grains. The run ends with the path, at a stress, or where the primaries are packed so densely that
/// no smaller box holds them: rigid disks have no solution past their own random close packing, and a growing
/// overlap says so.
class BpmCompaction final : public BpmSimulation {
 public:
  explicit BpmCompaction(const Case& the_case);

  std::vector<Quantity> observe() override;
  std::string early_end() const override;
  PathOutcome outcome() const override;

  const BoxSample& sample() const { return box_; }
  /// Furthest that a grain was moved from its place in the sample, over its radius.
  double displaced() const { return displaced_; }
  /// Contacts between grains, and with walls, under the impulses of the last step.
  std::vector<ContactPoint> contact_points() const;
  /// Centres of mass of the grains [m].
  std::vector<Vec<2>> centres() const;

 private:
  BpmCompaction(const Case& the_case, BoxSample box);
  BpmCompaction(const Case& the_case, BoxSample box, BpmSample sample);
  void judge(const StepReport& report) override;
  void complete_scene(Scene& scene) const override;
  double grain_area(int grain) const override;
  double width() const;
  double solid_fraction() const;  ///< area of the primaries over that of the box

  /// Outlines of all grains; `begin` as PackingView::outline_begin.
  std::vector<Vec<2>> outlines(std::vector<int>& begin) const;

  BoxSample box_;
  std::vector<int> begin_;  ///< (grains + 1) first primary of each
  double displaced_ = 0;
};

}  // namespace softgrain
