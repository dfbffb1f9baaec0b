#pragma once
#include <memory>
#include <vector>

#include "softgrain/bpm/surface_attraction.hpp"
#include "softgrain/model/model.hpp"
#include "softgrain/observe/rounded_surface.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// Contacts between grains, and with walls, that carry impulses which acted for `impulse_time` [s] or
/// attract: what their bodies feel, repulsion less attraction.
template <int Dim>
std::vector<ContactPointOf<Dim>> contact_points(const RigidDynamics<Dim>& dynamics,
                                                const SurfaceAttraction<Dim>& adhesion, double impulse_time);

/// Of all grains, by a probe of the size of a mean primary.
Outlines outlines_of(const RigidDynamics<2>& dynamics);
std::vector<SurfaceMeasure> outlines_of(const RigidDynamics<3>& dynamics);

/// Surface of a grain in space, with the directions of its vertices.
struct GrainSurface {
  std::shared_ptr<const DirectionGrid> grid;
  RoundedSurface surface;
};
/// Of all grains, by the same probe.
std::vector<GrainSurface> surfaces_of(const RigidDynamics<3>& dynamics);

}  // namespace softgrain
