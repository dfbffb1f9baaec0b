#pragma once
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain::bench {

/// Free square blocks of elastic material in a row, which vibrate in Lame's mode,
///   u = A cos(omega t) phi(X),  phi = (cos kx sin ky, -sin kx cos ky),  k = pi/L,  omega^2 = 2 k^2 G/rho:
/// exact in linear elasticity for every Poisson's ratio, as shear and change of volume are zero everywhere
/// and the normal stress is zero on the edges. They begin at rest, with the stress of u = A phi. Each has
/// cells of side h = 1 mm with four material points at the Gauss positions, and lies on a lattice whose nodes
/// are its corners, too. Points are numbered block by block, cell by cell in rows, four by four in rows.
struct VibratingBlocks {
  static constexpr double h = 1e-3, E = 10e6, nu = 0.3, rho = 1000;  ///< [m], [Pa], [-], [kg/m^3]
  static constexpr double strain = 1e-4;                             ///< A k, the largest
  static constexpr int gap = 2;                                      ///< between blocks [cells]
  int count = 1;
  int cells = 100;  ///< along the side of a block

  int points() const { return 4 * cells * cells * count; }
  double side() const { return cells * h; }  ///< L [m]
  /// Lower left corner of a block [m]; round the row is a margin of one cell.
  Vec<2> corner(int block) const { return {h * (1 + block * (cells + gap)), h}; }
  double omega() const;  ///< [1/s]

  /// 3/8 of a period [s]: velocity and displacement are both large then.
  double duration() const;
  /// Equal steps over the duration, each at most 0.3 h/c_p.
  int explicit_steps() const;

  Vec<2> displacement(const Vec<2>& X) const;  ///< A phi [m]; X from the corner of the block
  Mat<2> displacement_gradient(const Vec<2>& X) const;
  std::vector<Vec<2>> positions() const;        ///< (points) at the start [m]
  Vec<2> from_corner(int point) const;          ///< its X in its block [m]
  std::vector<Vec<2>> closed_velocity() const;  ///< (points) at the end [m/s], by the closed form
};

/// rms of a - b over the rms of b.
double relative_difference(std::span<const Vec<2>> a, std::span<const Vec<2>> b);

}  // namespace softgrain::bench
