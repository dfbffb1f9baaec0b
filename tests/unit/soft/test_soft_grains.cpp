#include "softgrain/soft/soft_grains.hpp"

#include <doctest/doctest.h>

#include <numbers>

#include "softgrain/core/error.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

SoftGrains mixed_grains() {
  const auto disk = test::disk(2);
  const auto square = test::square(3);
  std::vector<GrainPlacement> grains;
  for (int g = 0; g < 11; ++g)
    grains.push_back(test::placed(g % 3 == 1 ? square : disk, 1 + 0.25 * g, {10.0 * g, 2}, {0.5 * g, -1}));
  return {std::move(grains), make_law(MaterialLaw::neo_hookean, 1, 0.3), 4};
}

}  // namespace

TEST_CASE("mass, momentum and kinetic energy of grains that fly are those of disks and squares") {
  const SoftGrains grains = mixed_grains();
  Vec<2> momentum;
  double energy = 0;
  for (int g = 0; g < grains.size(); ++g) {
    const double R = 1 + 0.25 * g, mass = 4 * R * R * (g % 3 == 1 ? 1 : std::numbers::pi);
    CHECK(grains.mass(g) == doctest::Approx(mass));
    const Vec<2> v{0.5 * g, -1};
    momentum += mass * v;
    energy += mass * dot(v, v) / 2;
  }
  CHECK(grains.momentum()[0] == doctest::Approx(momentum[0]));
  CHECK(grains.momentum()[1] == doctest::Approx(momentum[1]));
  CHECK(grains.kinetic_energy() == doctest::Approx(energy));
}

TEST_CASE("grains of one shape share batches, and every grain is found in its lane") {
  const SoftGrains grains = mixed_grains();
  CHECK(grains.batches.size() == 2);  // seven disks and four squares
  std::vector<Vec<2>> outline;
  grains.gather_outline(outline);
  REQUIRE(outline.size() == grains.outline_size());
  for (int g = 0; g < grains.size(); ++g) {
    const ReferenceGrid& grid = grains.topology(g).grid;
    REQUIRE(grains.outline_end(g) - grains.outline_begin(g) == grid.outline_nodes());
    for (int k = 0; k < grid.outline_nodes(); ++k) {
      const Vec<2> expected = Vec<2>{10.0 * g, 2} + (1 + 0.25 * g) * grid.outline()[k];
      CHECK(norm(outline[grains.outline_begin(g) + k] - expected) < 1e-13);
      CHECK(grains.node_position(g, grid.outline_begin + k) == outline[grains.outline_begin(g) + k]);
      CHECK(grains.grain_of_vertex(grains.outline_begin(g) + k) == g);
    }
  }
}

TEST_CASE("values of outline vertices go to the nodes of their own grain") {
  const SoftGrains grains = mixed_grains();
  std::vector<Vec<2>> value(grains.outline_size());
  for (int v = 0; v < grains.outline_size(); ++v) value[v] = {1.0 * v, -0.5 * v};
  for (const GrainBatch& batch : grains.batches) {
    WideVectors nodes(batch.position.size());
    grains.scatter_outline(value, batch, nodes);
    const ReferenceGrid& grid = batch.topology->grid;
    for (int i = 0; i < grid.nodes(); ++i)
      for (int lane = 0; lane < Wide::size; ++lane) {
        const int g = batch.grain[lane];
        const bool on_outline = g >= 0 && i >= grid.outline_begin;
        const Vec<2> expected =
            on_outline ? value[grains.outline_begin(g) + i - grid.outline_begin] : Vec<2>{};
        CHECK(test::lane_of(nodes[i], lane) == expected);
      }
  }
}

TEST_CASE("grains without size or weight are refused") {
  const auto make = [](double radius, double density) {
    SoftGrains({test::placed(test::disk(2), radius, {})}, make_law(MaterialLaw::hencky, 1, 0.3), density);
  };
  CHECK_THROWS_AS(make(0, 1), UsageError);
  CHECK_THROWS_AS(make(1, 0), UsageError);
}
