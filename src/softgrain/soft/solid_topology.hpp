#pragma once
#include <array>
#include <vector>

#include "softgrain/soft/solid_grid.hpp"
#include "softgrain/soft/surface_patch.hpp"

namespace softgrain {

/// What the force (theory (74)) of laws with P = mu F + h(J) cof F needs of the reference shape of a cell,
/// see BrickInLanes.
struct BrickShape {
  std::array<double, 8> inverse_volume{};  ///< 1/(8 V_p) [1/R^3] of its points
  double inverse_of_all = 0;               ///< 1/(8 sum_p V_p) [1/R^3]
};

/// L_ij = sum_p V_p dN_i/dX . dN_j/dX [R] of a grid, symmetric with rows that sum to zero: row i has the
/// entries begin[i] .. begin[i + 1] - 1, all but the diagonal.
struct LaplaceRows {
  std::vector<int> begin, column;
  std::vector<double> weight;
};

/// All that grains in space of one shape share, in units of their radius: made once, never changed.
struct SolidTopology {
  /// Takes over the grid; finds points, volumes, and the patches of the outline.
  explicit SolidTopology(SolidGrid reference_grid);
  /// Of a rigid grain: a grid without cells, all of whose nodes are of the outline; the last, which no quad
  /// has, is the centre of mass at the origin. Its nodes carry the grain's volume and its moment, equal
  /// shares on the outline: moment is the integral of |X|^2 over the body [R^5].
  SolidTopology(SolidGrid outline, double body_volume, double moment);

  SolidGrid grid;
  std::vector<SolidPoint> points;  ///< (8 cells)
  std::vector<BrickShape> cell_shapes;
  LaplaceRows laplace;
  std::vector<double> node_volume;    ///< (nodes) fullness sum_p N_i V_p [R^3]: the lumped mass over rho R^3
  double volume = 0;                  ///< of the body, 4 pi/3 for a ball [R^3]
  std::vector<PatchNet> patches;      ///< (quads) of the outline
  std::vector<SurfacePoint> middles;  ///< of patches, then of edges
  /// (outline vertices) the quads round each; -1 behind the third of a vertex of valence 3
  std::vector<std::array<int, 4>> quads_round;
  double patch_fullness = 1;  ///< volume of the body over that within the smooth outline
  bool ball = false;          ///< of a rigid grain: it is met at the true sphere, by its centre
  bool rigid() const { return grid.cell.empty(); }
  /// A rigid grain of any shape, which is met at its outline.
  bool rigid_shape() const { return rigid() && !ball; }
};

/// A rigid sphere of unit radius, drawn by the outline of ball_grid(n). Raises UsageError for n < 2.
SolidTopology rigid_ball(int n);

}  // namespace softgrain
