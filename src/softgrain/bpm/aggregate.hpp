#pragma once
#include <cstdint>
#include <vector>

#include "softgrain/geometry/support.hpp"
#include "softgrain/math/vec.hpp"

namespace softgrain {

inline constexpr int fewest_primaries = 7;       ///< of a grain
inline constexpr double largest_size_ratio = 4;  ///< of primaries

/// How a grain is made of primary particles.
struct AggregateOptions {
  int primaries = 1750;
  double size_ratio = 1.625;  ///< largest over smallest diameter; diameters are uniform between
  double gamma = 7;           ///< exponent of the attraction that holds the grain while it relaxes
  std::uint64_t seed = 1;
};

/// A round grain at rest under its own attraction, of unit radius about the origin. Lengths are in units of
/// the grain's R.
template <int Dim>
struct AggregateOf {
  std::vector<Vec<Dim>> position;
  std::vector<double> radius;
  double roundness = 0;      ///< (h_max - h_min) / R of the outline
  double coordination = 0;   ///< Z = 2 contacts / primaries; about 4 of isostatic frictionless disks, 6 of
                             ///< spheres
  double mean_distance = 0;  ///< <a0>, mean of a1 + a2 over touching pairs
};
using Aggregate = AggregateOf<2>;

/// Cut-out recipe (docs/decisions/0008): disks (spheres) contract under a central force into a dense random
/// packing half as large again (in space 1.9 times); the `primaries` of them that reach least far from the
/// centre are kept; they relax under their attraction with viscous damping; the result is scaled to unit mean
/// radius. The same seed gives the same bits. Raises UsageError for fewer than 7 primaries, a size ratio
/// outside [1, 4], or gamma <= 0.
template <int Dim = 2>
AggregateOf<Dim> prepare_aggregate(const AggregateOptions& options);

}  // namespace softgrain
