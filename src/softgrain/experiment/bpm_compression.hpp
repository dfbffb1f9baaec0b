#pragma once
#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/experiment/bpm_simulation.hpp"

namespace softgrain {

/// One bonded-particle grain between two plates: the paper's Fig. 1. The bottom plate is fixed, the top one
/// follows the path.
class BpmCompression final : public BpmSimulation {
 public:
  explicit BpmCompression(const Case& the_case);

  std::vector<Quantity> observe() override;

  double sigma_I() const;  ///< F0/<a0> [Pa]

 private:
  BpmCompression(const Case& the_case, const Aggregate& aggregate);
  void complete_scene(Scene& scene) const override;
  double grain_area(int grain) const override;
  double width() const;

  double mean_distance_ = 0;  ///< <a0> [m]
};

}  // namespace softgrain
