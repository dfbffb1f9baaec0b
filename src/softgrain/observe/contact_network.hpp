#pragma once
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// A point where two grains, or a grain and a wall, push on each other.
struct ContactPoint {
  int a = 0;          ///< a grain
  int b = 0;          ///< another grain, or wall w as `wall_index(w)`
  Vec<2> force;       ///< of a on b [N/m]
  Vec<2> normal;      ///< unit, from a to b
  Vec<2> position;    ///< [m]
  double length = 0;  ///< share of the outline that touches here [m]
  Vec<2> image{};     ///< from where b is to where a sees it, across the edge of a periodic cell [m]
};

/// The number of wall w as a body of a ContactPoint: below every grain's.
constexpr int wall_index(int wall) { return -1 - wall; }

/// Two grains that push on each other, in however many points.
struct GrainPair {
  int a = 0, b = 0;  ///< grains a < b, or a wall b < 0
  int points = 0;
  double normal_force = 0;  ///< f_n = sum over the points of f . n [N/m], >= 0 in compression
  Vec<2> force;             ///< of a on b [N/m]
  Vec<2> normal;            ///< unit, from a to b: mean over the points, weighted by their normal force
  Vec<2> position;          ///< mean over the points, weighted alike [m]
  double length = 0;        ///< of the contact, sum over its points [m]
  Vec<2> image{};           ///< as of the points
};

/// The points of each pair of bodies taken together, ordered by (a, b); points without normal force (f . n <=
/// 0) are left out. Pairs of grains first, those with walls (b < 0) in `walls`.
struct ContactNetwork {
  int grains = 0;
  std::vector<GrainPair> pairs, walls;
};
ContactNetwork contact_network(std::span<const ContactPoint> points, int grains);

/// How many neighbours grains have; walls are none.
struct Coordination {
  double z = 0;              ///< Z = 2 N_pairs/N_grains (theory (54))
  double z_no_rattlers = 0;  ///< the same among the grains that are not rattlers; 0 if all are
  double rattlers = 0;       ///< share of the grains that are rattlers
  double z_backbone = 0;     ///< Z among the grains of the backbone; 0 if there is none
  double backbone = 0;       ///< share of the grains in it
  double z_with_walls = 0;   ///< 2 (N_pairs + N_wall_pairs)/N_grains: 4 where frictionless disks jam in a box
};

/// Rattlers have fewer than two contacts, walls among them here, with grains that are no rattlers: they are
/// taken out again and again until none is left. Walls hold a grain but do not count in Z, but in
/// z_with_walls. The backbone is what remains when grains with fewer than three contacts are taken out in the
/// same way: two frictionless contacts hold a disk only where they lie opposite each other.
Coordination coordination(const ContactNetwork& network);

/// Mean number of sides of the polygons that squeezed grains become: neighbours, walls among them, along
/// which a grain touches for at least `least_share` of its perimeter [m].
double mean_sides(const ContactNetwork& network, std::span<const double> perimeter,
                  double least_share = 0.02);

}  // namespace softgrain
