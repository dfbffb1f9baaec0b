#pragma once
#include <vector>

#include "softgrain/model/model.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// Contacts between grains, and with walls, that carry impulses which acted for `impulse_time` [s].
std::vector<ContactPoint> contact_points(const RigidDynamics<2>& dynamics, double impulse_time);

/// Of all grains, by a probe of the size of a mean primary.
Outlines outlines_of(const RigidDynamics<2>& dynamics);

}  // namespace softgrain
