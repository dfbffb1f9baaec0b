#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"
#include "softgrain/observe/surface_measure.hpp"

namespace softgrain {

/// Directions over the sphere and the quads between them: a cube of `cells` along an edge, blown up.
struct DirectionGrid {
  explicit DirectionGrid(int cells);

  std::vector<Vec<3>> direction;         ///< unit
  std::vector<double> solid_angle;       ///< that each stands for; 4 pi in all
  std::vector<std::array<int, 4>> quad;  ///< counter-clockwise seen from outside
  double flat_area = 0;                  ///< of the quads, two triangles each
};

/// Surface of a grain made of spheres.
struct RoundedSurface {
  std::vector<Vec<3>> vertex;  ///< (directions) [m]
  std::vector<int> sphere;     ///< (directions) that is met there, -1 where there is none
  SurfaceMeasure measure;
};

/// What a probe sphere of radius `probe` [m] meets that comes down towards the middle of the spheres along
/// each direction e:
///   r(e) = max_i (x_i . e + sqrt((R_i + probe)^2 - x_i^2 + (x_i . e)^2)) - probe,
///   V = sum_e r^3/3 dOmega.
/// Notches narrower than the probe are bridged, and pores inside do not exist; a single sphere is met at its
/// own surface. Where a ray meets nothing, r = 0. The area is that of the quads, over the share of a sphere's
/// that they have.
RoundedSurface rounded_surface(std::span<const Vec<3>> position, std::span<const double> radius, double probe,
                               const DirectionGrid& grid);

}  // namespace softgrain
