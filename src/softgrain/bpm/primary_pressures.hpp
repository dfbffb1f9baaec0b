#pragma once
#include <span>
#include <vector>

#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// Pressure of each primary [Pa] by Love and Weber: from its contacts, whose impulses acted for
/// `impulse_time` [s], and attractions, over its share of its grain's area pi R^2, pores included (theory
/// (28)). grain_radius: R of each grain [m].
std::vector<double> primary_pressures(const RigidDynamics<2>& dynamics, const AttractionForces& attraction,
                                      std::span<const double> grain_radius, double impulse_time);

}  // namespace softgrain
