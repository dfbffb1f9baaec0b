#pragma once
#include <array>
#include <span>
#include <vector>

#include "softgrain/math/block_cholesky.hpp"
#include "softgrain/soft/reference_grid.hpp"

namespace softgrain {

/// Where the block K_ab of a cell's stiffness goes in the matrix of the grain.
struct CellBlock {
  int block = 0;            ///< number in the BlockPattern
  bool transposed = false;  ///< it holds K_ab^T
};

/// What the reference shape of a cell means to the force of laws with P = mu F + h(J) cof F, see
/// CellInLanes: L_ab = sum_p V_p dN_a/dX . dN_b/dX, symmetric and with rows that sum to zero.
struct CellShape {
  double L_11 = 0, L_12 = 0, L_13 = 0, L_22 = 0, L_23 = 0, L_33 = 0;
  std::array<double, 4> inverse_area{};  ///< 1/(4 V_p) [1/R^2] of its points
  double inverse_volume = 0;             ///< 1/sum_p V_p [1/R^2]
};

/// The arc that an outline vertex brings to walls: of the circle through it and its two neighbours, up to the
/// inclination where the neighbour's arc begins. Of a regular polygon the arcs make the circle through its
/// vertices.
struct OutlineArc {
  double half_chord = 0;  ///< l, half the distance of the neighbours [R]
  double radius = 0;      ///< r = l/sin(turn), with the angle `turn` between the two segments [R]
  double end_sine =
      0;  ///< sin(turn/2); 0 where the outline is straight, concave or has a corner: the vertex alone
};

/// The arcs of a closed outline, counter-clockwise, whose corners are known (not 0): all else that is convex
/// has one.
std::vector<OutlineArc> arcs_between(std::span<const Vec<2>> outline, std::span<const char> corner);

/// All that grains of one shape share, in units of their radius: made once, never changed.
struct Topology {
  /// Takes over the grid; finds points, volumes, and the symbolic factorisation with the outline last.
  explicit Topology(ReferenceGrid reference_grid);
  /// With the outline's corners known: 1 at each vertex where there is one. There the curve ends, and all
  /// else that is convex has an arc.
  Topology(ReferenceGrid reference_grid, std::vector<char> corners);
  /// Of a rigid grain: a grid without cells, whose node 0 is the centre of mass at the origin and whose other
  /// nodes are the outline. Its nodes carry the grain's mass and its moment of inertia, those of the outline
  /// equal shares where they lie evenly: moment is the integral of |X|^2 over the body [R^4].
  /// corner: of the outline's vertices those where it has none of its curve's smoothness; none: it is smooth.
  Topology(ReferenceGrid outline, double moment, std::vector<char> corner = {});

  bool rigid() const { return grid.cell.empty(); }

  ReferenceGrid grid;
  std::vector<MaterialPoint> points;  ///< (4 cells)
  std::vector<CellShape> cell_shapes;
  std::vector<double> node_volume;  ///< (nodes) fullness sum_p N_i V_p [R^2]: the lumped mass over rho R^2
  std::vector<OutlineArc> arc;      ///< (outline vertices)
  std::vector<char> corner;         ///< (outline vertices) 1 where the outline has a corner; empty: nowhere
  double area = 0;                  ///< of the body, pi for a disk [R^2]
  bool round = false;               ///< the outline is a regular polygon about the origin
  BlockPattern pattern;
  std::vector<CellBlock>
      cell_blocks;  ///< (10 cells): the pairs (a, b), b <= a, of the four nodes of each cell

 private:
  void balance(double moment);
};

/// How far the undeformed outline with its arcs reaches from the origin in a direction of length 1 [R]: its
/// support function, as walls see it.
double reach_of(const Topology& shape, const Vec<2>& direction);

}  // namespace softgrain
