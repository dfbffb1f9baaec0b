#pragma once
#include <span>
#include <type_traits>
#include <vector>

#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/bpm/surface_attraction.hpp"
#include "softgrain/observe/stress.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// Pressure of each primary [Pa] by Love and Weber: from its contacts, whose impulses acted for
/// `impulse_time` [s], and attractions, over its share of its grain's area pi R^2, pores included (theory
/// (28)); in space of its volume. grain_radius: R of each grain [m].
/// more: other forces on primaries.
template <int Dim>
std::vector<double> primary_pressures(const RigidDynamics<Dim>& dynamics,
                                      const AttractionForcesOf<Dim>& attraction,
                                      const SurfaceAttraction<Dim>& adhesion,
                                      std::span<const double> grain_radius, double impulse_time,
                                      std::type_identity_t<std::span<const BranchForceOf<Dim>>> more = {});

}  // namespace softgrain
