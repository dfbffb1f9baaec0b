#pragma once
#include <optional>

namespace softgrain {

/// What may change while grains are followed. What has no value stays as it is, and a model leaves out what
/// it does not have.
struct Settings {
  std::optional<double> friction{};          ///< mu between grains
  std::optional<double> wall_friction{};     ///< mu against walls
  std::optional<double> solver_tolerance{};  ///< of the contact solver of bonded grains
  std::optional<double> newton_tolerance{};  ///< of Newton's method of implicit elastic grains
  std::optional<double> damping{};           ///< zeta [1/s] of elastic grains

  /// Changed by others that come later.
  Settings then(const Settings& later) const {
    return {.friction = later.friction ? later.friction : friction,
            .wall_friction = later.wall_friction ? later.wall_friction : wall_friction,
            .solver_tolerance = later.solver_tolerance ? later.solver_tolerance : solver_tolerance,
            .newton_tolerance = later.newton_tolerance ? later.newton_tolerance : newton_tolerance,
            .damping = later.damping ? later.damping : damping};
  }
  friend bool operator==(const Settings&, const Settings&) = default;
};

}  // namespace softgrain
