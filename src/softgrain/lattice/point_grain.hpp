#pragma once
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A grain of material points that move through a lattice of nodes, with an outline of massless vertices
/// that move with them. Per metre of depth.
struct PointGrain {
  double radius = 0;             ///< R at rest [m]
  std::vector<double> volume;    ///< (points) V_p at rest [m^2]
  std::vector<Vec<2>> position;  ///< (points) x_p [m]
  std::vector<Vec<2>> velocity;  ///< (points) v_p [m/s]
  std::vector<Mat<2>> F;         ///< (points) deformation gradient
  std::vector<Vec<2>> outline;   ///< (vertices) counter-clockwise [m]

  int points() const { return static_cast<int>(position.size()); }
  double area() const;                          ///< sum_p V_p [m^2]
  Vec<2> momentum(double density) const;        ///< sum_p rho V_p v_p [kg m/s per m]
  double kinetic_energy(double density) const;  ///< [J/m]
};

/// A disk at rest. One point for each quarter of a cell of the lattice, at the centre of the part that is in
/// the disk, with its area; parts below 5 % are left out, and all areas scaled so that their sum is pi R^2.
/// `vertices` on a circle whose polygon has that area, too. Raises UsageError for a radius below two cells.
PointGrain disk_of_points(double radius, const Vec<2>& centre, double cell, int vertices);

}  // namespace softgrain
