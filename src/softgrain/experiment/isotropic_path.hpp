#pragma once
#include <memory>

#include "softgrain/experiment/compaction_path.hpp"

namespace softgrain {

/// Isotropic compaction: all walls of a box come in, lid and bottom at half the speed each, go back and rest
/// as in a CompactionPath. The box keeps its shape and centre, so undeformed grains fill Phi_0 = Phi_start
/// e^(2 eps).
class IsotropicPath final : public CompactionPath {
 public:
  /// aspect: width over height of the box.
  IsotropicPath(const Case::Loading& loading, double height, double dt, double packing_fraction,
                double aspect = 1)
      : CompactionPath(loading, height, dt, packing_fraction, 2), aspect_(aspect) {}

  std::array<double, 4> shares() const override { return {0.5, 0.5, 0.5 * aspect_, 0.5 * aspect_}; }

 private:
  double aspect_;
};

/// The path of a case with a box of this height [m], by steps of dt [s].
inline std::unique_ptr<PlatePath> box_path(const Case& c, double height, double dt) {
  if (c.experiment.loading == LoadingPath::isotropic)
    return std::make_unique<IsotropicPath>(c.loading, height, dt, c.sample.packing_fraction, c.sample.aspect);
  return std::make_unique<CompactionPath>(c.loading, height, dt, c.sample.packing_fraction);
}

}  // namespace softgrain
