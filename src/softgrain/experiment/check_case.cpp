#include "softgrain/experiment/check_case.hpp"

#include <algorithm>

#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/experiment/grains_of_case.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/experiment/shape_of_case.hpp"

namespace softgrain {
namespace {

/// Primaries or points of a simulation that is created at once.
constexpr double few_primaries = 5000, few_points = 1e5;
/// Grains whose places are looked for at once.
constexpr int few_grains = 300;

/// A few small grains, far apart.
Case twin_of(Case c) {
  c.bpm.primaries = std::min(c.bpm.primaries, 20);
  c.bpm.library = 1;
  c.mpm.cells = std::min(c.mpm.cells, std::max(4, least_cells(c.grain)));
  c.sample.grains = std::min(c.sample.grains, 8);
  for (Case::Kind& kind : c.kinds) {
    kind.cells = std::min(kind.cells, std::max(4, least_cells(kind.grain)));
    kind.grains = std::min(kind.grains, 4);
    kind.bpm.primaries = std::min(kind.bpm.primaries, 20);
    kind.bpm.library = 1;
  }
  c.sample.packing_fraction = std::min(c.sample.packing_fraction, 0.2);
  c.sample.aspect = 1;
  c.sample.placed.clear();
  c.sample.placed_z.clear();
  return c;
}

}  // namespace

void check_case(const Case& c) {
  check_time_step(c);
  const bool bpm = has_bonded(c);
  if (estimate(c).particles <= (bpm ? few_primaries : few_points)) {
    create_any_simulation(c);
    return;
  }
  create_any_simulation(twin_of(c));
  if (!is_in_a_box(c) || c.sample.grains > few_grains) return;
  if (is_in_space(c))
    sample_solid_box(c);
  else
    sample_box(c);
}

}  // namespace softgrain
