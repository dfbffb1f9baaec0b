#pragma once
#include "softgrain/geometry/star_surface.hpp"
#include "softgrain/soft/solid_topology.hpp"

namespace softgrain {

/// The outline has an edge where the mesh, and two quads there, turn by more than this [rad]: 30 deg.
inline constexpr double least_edge = 0.5235987755982988;

/// A rigid grain in space with the surface of a mesh: the outline of ball_grid(n), each vertex in its
/// direction from the centre of mass where the surface is. Volume and inertia are those of the mesh itself.
/// The radius R is the distance of its farthest vertex. Raises UsageError for n < 2.
SolidTopology rigid_surface(const StarSurface& surface, int n);

/// Masses of nodes about the origin, over rho R^3: w_k of the outline, as equal as they can be with
///   sum w_k X_k = 0,  sum w_k X_k (x) X_k = moments,
/// and the rest of the volume at the origin, last.
std::vector<double> masses_with(std::span<const Vec<3>> outline, double volume, const Mat<3>& moments);

}  // namespace softgrain
