#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "softgrain/math/padded_vec.hpp"
#include "softgrain/observe/surface_measure.hpp"

namespace softgrain {

/// The outline of a grain in space is the smooth surface through its vertices that the curve of the plane
/// makes with itself: over a quad, and the net of 4 x 4 vertices round it,
///   c(u, v) = sum_ij w_i(u) w_j(v) P_ij,  w = curve_weights,  u, v in [0, 1],
/// P_11, P_21, P_22, P_12 the quad, counter-clockwise. At a vertex of valence 3, which turns into P_11, the
/// net lacks P_01, P_10 and P_00. With the vertex' third neighbour C
///   P_01 = 3/4 (P_12 + C) - 1/2 P_11,  P_10 = 3/4 (P_21 + C) - 1/2 P_11,
/// and P_00 such that the net's twist changes as little as it can. Along a side that is sharp the row of the
/// net beyond it goes straight on, P_0j = 2 P_1j - P_2j: flat faces stay flat up to their edges. All is
/// linear in the vertices.
struct PatchNet {
  /// The sides u = 0, u = 1, v = 0 and v = 1
  enum Side : unsigned { low_u = 1, high_u = 2, low_v = 4, high_v = 8 };
  /// Where the quad's own vertices P_11, P_21, P_22, P_12 stand in the net.
  static constexpr std::array<std::size_t, 4> corner{5, 9, 10, 6};

  std::array<int, 16> vertex{};  ///< P_ij at 4 i + j; with ghosts C at 0 and P_11 at 1 and 4
  bool ghosts = false;           ///< P_11 has valence 3
  unsigned sharp = 0;            ///< sides along which the outline has an edge
};

/// Nets of all quads of a closed outline, whose vertices have valence 4 or 3, two of valence 3 never in one
/// quad. quads: vertices, counter-clockwise seen from outside; quads_round: as SolidTopology has them.
std::vector<PatchNet> patch_nets(std::span<const std::array<int, 4>> quads,
                                 std::span<const std::array<int, 4>> quads_round);

/// Weights of the net's vertices in c(u, v); they add up to 1.
std::array<double, 16> patch_weights(const PatchNet& net, double u, double v);

/// Weights of a contact, which every sweep reads: half as long.
using PatchWeights = std::array<float, 16>;
/// The same in multiples of 2^-23, which single precision holds, and they add up to 1 to the last digit: what
/// all vertices do together still moves the place as much. |weight| < 2.
PatchWeights narrow_weights(const std::array<double, 16>& weights);

/// The net of a point that has one vertex, the first, as a rigid sphere has.
inline constexpr PatchNet net_of_one_vertex{};

/// A point of the outline between its vertices: at sum weight x of the first `count`, which is even.
struct SurfacePoint {
  std::array<int, 16> vertex{};
  std::array<double, 16> weight{};
  int count = 16;               ///< 4 or 6 of an edge
  std::array<int, 4> corner{};  ///< of the patch whose middle it is; or first the two ends of an edge
  bool of_edge() const { return count < 16; }
};

/// The middles u = v = 1/2 of all patches, then those of all edges between two of them, each once: sorted by
/// their ends, the lower number first.
std::vector<SurfacePoint> middles_of(std::span<const PatchNet> patches);

/// A patch in its present shape.
class SurfacePatch {
 public:
  /// position: from the grain's first outline vertex on [m].
  template <class Place>
  SurfacePatch(const PatchNet& net, const Place* position) {
    for (std::size_t k = 0; k < 16; ++k) net_[k] = load_lanes(position[net.vertex[k]]);
    if (net.ghosts) put_ghosts();
    if (net.sharp != 0) go_straight_on(net);
  }

  /// c, dc/du and dc/dv [m].
  struct Point {
    Vec<3> place, along_u, along_v;
    Vec<3> normal() const;  ///< unit, outwards
  };
  Point at(double u, double v) const;

  /// The place of the patch nearest to x, from (u, v) on.
  struct Nearest {
    double u = 0, v = 0;
    bool inside = true;  ///< (c - x) is normal to the patch; else the place is on its border
  };
  Nearest nearest(const Vec<3>& x, double u, double v) const;

 private:
  void put_ghosts();
  void go_straight_on(const PatchNet& net);

  std::array<Lanes, 16> net_;
};

/// Volume and area of a closed outline in its present shape, by 3 x 3 Gauss points of each patch:
///   V = 1/3 sum c . (dc/du x dc/dv), A = sum |dc/du x dc/dv|.
SurfaceMeasure measure_surface(std::span<const PatchNet> patches, const Vec<3>* position);

}  // namespace softgrain
