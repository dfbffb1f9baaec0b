#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "softgrain/soft/elastic_grains.hpp"
#include "support/solid_grains.hpp"
#include "support/solid_simulations.hpp"

// How deep smooth surfaces of grains in space lie in each other: looked for on the surfaces alone, by points
// drawn all over them.

using namespace softgrain;

namespace {

struct DrawnPoint {
  Vec<3> place, normal;
};

/// The points of each grain: fine x fine on each patch.
std::vector<std::vector<DrawnPoint>> drawn(const SolidGrains& grains, int fine) {
  std::vector<Vec<3>> x;
  grains.gather_outline(x);
  std::vector<std::vector<DrawnPoint>> all(static_cast<std::size_t>(grains.size()));
  for (int g = 0; g < grains.size(); ++g)
    for (const PatchNet& net : grains.topology(g).patches) {
      const SurfacePatch patch(net, &x[static_cast<std::size_t>(grains.outline_begin(g))]);
      for (int i = 0; i < fine; ++i)
        for (int j = 0; j < fine; ++j) {
          const auto c = patch.at((i + 0.5) / fine, (j + 0.5) / fine);
          all[static_cast<std::size_t>(g)].push_back({c.place, c.normal()});
        }
    }
  return all;
}

struct Crossing {
  double deepest = 0;  ///< [m]
  int inside = 0, points = 0;
};

/// A point x lies -(x - y) . n deep in another grain, y its nearest drawn point with the normal n.
Crossing crossing(const SolidGrains& grains, int fine) {
  const auto points = drawn(grains, fine);
  Crossing found;
  for (std::size_t a = 0; a < points.size(); ++a)
    for (const DrawnPoint& point : points[a]) {
      double deepest = 0;
      for (std::size_t b = 0; b < points.size(); ++b) {
        if (a == b) continue;
        double least = std::numeric_limits<double>::infinity(), depth = 0;
        for (const DrawnPoint& other : points[b]) {
          const Vec<3> d = point.place - other.place;
          if (dot(d, d) < least) least = dot(d, d), depth = -dot(d, other.normal);
        }
        deepest = std::max(deepest, depth);
      }
      found.deepest = std::max(found.deepest, deepest);
      found.inside += deepest > 0 ? 1 : 0;
      ++found.points;
    }
  return found;
}

}  // namespace

TEST_CASE("two balls that overlap cross by their overlap") {
  const auto shape = test::ball(4);
  const SolidGrains grains({{.topology = shape, .radius = 1, .centre = {}, .velocity = {}},
                            {.topology = shape, .radius = 1, .centre = {0, 0, 1.9}, .velocity = {}}},
                           {GrainMaterial{make_law(MaterialLaw::neo_hookean, 1, 0.45), 1}});
  const Crossing found = crossing(grains, 8);
  CHECK(std::abs(found.deepest - 0.1) < 0.005);
  CHECK(found.inside > 20);
}

TEST_CASE("elastic spheres pressed into each other do not cross between their vertices") {
  Case c = test::case_in_space(LoadingPath::isotropic);
  c.mpm.cells = 4;
  c.sample.grains = 8;
  c.sample.packing_fraction = 0.45;
  c.loading.wall_velocity = 4;
  c.loading.max_strain = 0.25;
  SimulationOf<3> simulation = test::solid_simulation_of(c);
  while (!simulation.finished()) simulation.step();
  const auto& model = dynamic_cast<const ElasticGrains<ExplicitStep<3>>&>(simulation.model());
  const SolidGrains& grains = model.dynamics().grains;
  double radius = 0;
  for (int g = 0; g < grains.size(); ++g) radius += grains.radius(g) / grains.size();
  const Crossing found = crossing(grains, 4);
  CAPTURE(found.deepest / radius);
  CAPTURE(found.inside);
  CHECK(found.deepest / radius < 0.02);  // 0.072 where vertices alone meet, 0.027 with middles of patches
  CHECK(found.inside < 0.08 * found.points);  // 0.20, 0.095
}
