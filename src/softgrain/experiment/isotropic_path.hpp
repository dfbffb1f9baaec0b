#pragma once
#include <memory>

#include "softgrain/experiment/compaction_path.hpp"

namespace softgrain {

/// Isotropic compaction: all walls of a square box come in, each at half the speed, go back and rest as in a
/// CompactionPath. The box stays square about its centre, so undeformed grains fill Phi_0 = Phi_start
/// e^(2 eps).
class IsotropicPath final : public CompactionPath {
 public:
  IsotropicPath(const Case::Loading& loading, double height, double dt, double packing_fraction)
      : CompactionPath(loading, height, dt, packing_fraction, 2) {}

  std::array<double, 4> shares() const override { return {0.5, 0.5, 0.5, 0.5}; }
};

/// The path of a case with a box of this side [m], by steps of dt [s].
inline std::unique_ptr<PlatePath> box_path(const Case& c, double side, double dt) {
  if (c.experiment.loading == "isotropic")
    return std::make_unique<IsotropicPath>(c.loading, side, dt, c.sample.packing_fraction);
  return std::make_unique<CompactionPath>(c.loading, side, dt, c.sample.packing_fraction);
}

}  // namespace softgrain
