#pragma once
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A point where two grains, or a grain and a wall, push on each other, or pull where they adhere.
template <int Dim>
struct ContactPointOf {
  int a = 0;          ///< a grain
  int b = 0;          ///< another grain, or wall w as `wall_index(w)`
  Vec<Dim> force;     ///< of a on b [N/m in the plane]
  Vec<Dim> normal;    ///< unit, from a to b
  Vec<Dim> position;  ///< [m]
  double length = 0;  ///< share of the outline that touches here [m], in the plane
  Vec<Dim> image{};   ///< from where b is to where a sees it, across the edge of a periodic cell [m]
};
using ContactPoint = ContactPointOf<2>;

/// The number of wall w as a body of a ContactPoint: below every grain's.
constexpr int wall_index(int wall) { return -1 - wall; }

/// Two grains that push on each other or adhere, in however many points.
template <int Dim>
struct GrainPairOf {
  int a = 0, b = 0;  ///< grains a < b, or a wall b < 0
  int points = 0;
  double normal_force = 0;  ///< f_n = sum over the points of f . n [N/m in the plane], > 0 where they push
  Vec<Dim> force;           ///< of a on b [N/m in the plane]
  Vec<Dim> normal;          ///< unit, from a to b: mean over the points, weighted by their |f . n|
  Vec<Dim> position;        ///< mean over the points, weighted alike [m]
  double length = 0;        ///< of the contact, sum over its points [m]
  Vec<Dim> image{};         ///< as of the points
};
using GrainPair = GrainPairOf<2>;

/// The points of each pair of bodies taken together, ordered by (a, b); points without normal force are left
/// out. Pairs of grains first, those with walls (b < 0) in `walls`.
template <int Dim>
struct ContactNetworkOf {
  int grains = 0;
  std::vector<GrainPairOf<Dim>> pairs, walls;
};
using ContactNetwork = ContactNetworkOf<2>;
ContactNetworkOf<2> contact_network(std::span<const ContactPointOf<2>> points, int grains);
ContactNetworkOf<3> contact_network(std::span<const ContactPointOf<3>> points, int grains);

/// How many neighbours grains have; walls are none.
struct Coordination {
  double z = 0;              ///< Z = 2 N_pairs/N_grains (theory (54))
  double z_no_rattlers = 0;  ///< the same among the grains that are not rattlers; 0 if all are
  double rattlers = 0;       ///< share of the grains that are rattlers
  double z_backbone = 0;     ///< Z among the grains of the backbone; 0 if there is none
  double backbone = 0;       ///< share of the grains in it
  double z_with_walls = 0;   ///< 2 (N_pairs + N_wall_pairs)/N_grains: 4 where frictionless disks jam in a box
};

/// Rattlers have fewer than two contacts (three in space), walls among them here, with grains that are no
/// rattlers: they are taken out again and again until none is left. Walls hold a grain but do not count in Z,
/// but in z_with_walls. The backbone is what remains when grains with fewer than three contacts (four) are
/// taken out in the same way: two frictionless contacts hold a disk only where they lie opposite each other.
Coordination coordination(const ContactNetworkOf<2>& network);
Coordination coordination(const ContactNetworkOf<3>& network);

/// Mean number of sides of the polygons that squeezed grains become: neighbours, walls among them, along
/// which a grain touches for at least `least_share` of its perimeter [m].
double mean_sides(const ContactNetwork& network, std::span<const double> perimeter,
                  double least_share = 0.02);

}  // namespace softgrain
