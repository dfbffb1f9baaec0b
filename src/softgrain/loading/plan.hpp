#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "softgrain/loading/stage.hpp"

namespace softgrain {

/// What stages count in. Arrays by component: yy, xx, xy. That of xy is gamma itself, and so are its travel,
/// and -gamma its length. In space: zz, yy, xx.
struct LoadingFrame {
  StrainMeasure measure;                 ///< of yy; xx counts as ln(w_start/w)
  std::array<double, 3> start{1, 1, 0};  ///< height and width where strains count from [m]
  double wall_velocity = 1;              ///< of walls that keep a stress, at most; of averages [m/s]
  double aspect = 1, aspect_y = 1;       ///< width over height; in space depth over height
  double packing_fraction = 0;           ///< Phi_0 where strains count from
  int dimension = 2;                     ///< in space the third component is no shear, but xx

  bool is_shear(int component) const { return component == 2 && dimension == 2; }
  /// Share of the rate of a part that each wall makes along its normal.
  template <int Dim>
  std::array<double, 2 * Dim> shares(Part part) const {
    return share_in<Dim>(part, aspect, aspect_y);
  }
  /// How much walls of a component come together when a part moves by 1.
  double closing_share(Part part, int component) const;
  double strain(int component, double length) const;  ///< with this distance of the walls [m]
  double travel(int component, double strain) const;  ///< of the walls towards each other [m]
};

/// What a stage is expected to take.
struct PlannedStage {
  double time = 0;       ///< [s]
  bool is_rest = false;  ///< it ends after a time, not at a strain

  std::int64_t steps(double dt) const;
};

/// Expected of each stage, with the walls so far from where strains count from [m]. A stage that ends at a
/// stress is taken to go to its limit; what walls that keep a stress make of a strain is not foreseen.
std::vector<PlannedStage> plan(std::span<const Stage> stages, const LoadingFrame& frame,
                               std::array<double, 3> travel);

/// A strain of a component.
struct StrainLimit {
  int component = 0;
  double strain = 0;
};

/// Where walls stop that move without an end in strain or time: at 3 together; apart, where the run began, or
/// 1 further.
std::optional<StrainLimit> limit_of(const Stage& stage, const std::array<double, 3>& strain_at_start);
}  // namespace softgrain
