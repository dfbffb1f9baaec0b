#include "softgrain/mpm/outline_contacts.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

/// Two disks, the second finer (so its vertices are the slaves), deformed and overlapping by about 2 %.
SoftGrains overlapping_pair(double distance = 1.96) {
  SoftGrains grains({test::placed(test::disk(3), 1, {0, 0}), test::placed(test::disk(5), 1, {distance, 0.1})},
                    make_law("neo_hookean", 1, 0.3), 1, false);
  for (GrainBatch& batch : grains.batches)
    for (Vec<2, Wide>& x : batch.position) x[1] += 0.03 * x[0] * x[0];
  return grains;
}

OutlineState state_of(const SoftGrains& grains, std::vector<Wall<2>> walls = {}) {
  OutlineState state{.position = {}, .start = {}, .walls = std::move(walls), .dt = 1};
  grains.gather_outline(state.position);
  state.start = state.position;
  return state;
}

struct Facing {
  double distance = std::numeric_limits<double>::infinity();
  Vec<2> place;
  Vec<2> edge_normal;
};

/// The closest of all edges of a grain to a point.
Facing brute_force(const SoftGrains& grains, const OutlineState& state, int grain, const Vec<2>& x) {
  Facing best;
  const int begin = grains.outline_begin(grain), end = grains.outline_end(grain);
  for (int v = begin; v < end; ++v) {
    const Vec<2> a = state.position[v], b = state.position[v + 1 < end ? v + 1 : begin];
    const double share = std::clamp(dot(x - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
    const Vec<2> place = a + share * (b - a);
    if (norm(x - place) < best.distance)
      best = {norm(x - place), place, (-1 / norm(b - a)) * perpendicular(b - a)};
  }
  return best;
}

constexpr double pi = 3.141592653589793;

}  // namespace

TEST_CASE("a vertex faces the closest of all edges of the other outline") {
  const SoftGrains grains = overlapping_pair();
  const OutlineState state = state_of(grains);
  const auto contacts = OutlineNeighbours().detect(grains, state);
  std::map<int, OutlineContact> by_vertex;
  for (const OutlineContact& c : contacts) by_vertex[c.vertex] = c;
  CHECK(by_vertex.size() == contacts.size());
  const double margin = 0.5 * (2 * pi / 12 + 2 * pi / 20) / 2;
  int met = 0;
  for (int v = grains.outline_begin(1); v < grains.outline_end(1); ++v) {
    const Vec<2>& x = state.position[v];
    const Facing facing = brute_force(grains, state, 0, x);
    const auto found = by_vertex.find(v);
    if (facing.distance > 1.05 * margin) continue;
    if (found == by_vertex.end()) {
      CHECK(facing.distance > 0.95 * margin);
      continue;
    }
    ++met;
    const OutlineContact& c = found->second;
    const auto [w0, w1] = c.weights();
    const Vec<2> place = w0 * state.position[c.master[0]] + w1 * state.position[c.master[1]];
    CHECK(norm(place - facing.place) < 1e-14);
    CHECK(norm(c.normal) == doctest::Approx(1));
    CHECK(dot(c.normal, facing.edge_normal) > std::cos(2 * pi / 12));  // within the turn of one vertex
    CHECK(c.gap == doctest::Approx(dot(x - place, c.normal)));
    CHECK((c.gap < 0) == (dot(x - facing.place, facing.edge_normal) < 0));
  }
  CHECK(met >= 3);
  CHECK(std::ranges::count_if(contacts, [](const OutlineContact& c) { return c.gap < 0; }) >= 1);
}

TEST_CASE("the finer grain's vertices are the slaves, whichever grain comes first or moves") {
  for (const bool finer_first : {false, true}) {
    std::vector<GrainPlacement> placed{test::placed(test::disk(3), 1, {0, 0}),
                                       test::placed(test::disk(5), 1, {1.99, 0})};
    if (finer_first) std::swap(placed[0], placed[1]);
    SoftGrains grains(placed, make_law("hencky", 1, 0.3), 1, false);
    OutlineNeighbours neighbours;
    OutlineState state = state_of(grains);
    for (int step = 0; step < 20; ++step) {  // rolls round the other
      const double angle = 0.3 * step;
      const int mover = finer_first ? 0 : 1, other = 1 - mover;
      const Vec<2> centre = placed[other].centre + 1.99 * Vec<2>{std::cos(angle), std::sin(angle)};
      const Vec<2> shift = centre - placed[mover].centre;
      OutlineState moved = state;
      for (int v = grains.outline_begin(mover); v < grains.outline_end(mover); ++v)
        moved.position[v] += shift;
      const auto contacts = neighbours.detect(grains, moved);
      CHECK(contacts.size() >= 1);
      for (const OutlineContact& c : contacts) {
        CHECK(grains.grain_of_vertex(c.vertex) == mover);
        CHECK(grains.grain_of_vertex(c.master[0]) == other);
        // the same as a search from the beginning
        const Facing facing = brute_force(grains, moved, other, moved.position[c.vertex]);
        const auto [w0, w1] = c.weights();
        CHECK(norm(w0 * moved.position[c.master[0]] + w1 * moved.position[c.master[1]] - facing.place) <
              1e-14);
      }
    }
  }
}

TEST_CASE("of two equal grains the first one's vertices are the slaves") {
  const auto shape = test::disk(4);
  const SoftGrains grains({test::placed(shape, 1, {0, 0}), test::placed(shape, 1, {2.01, 0})},
                          make_law("hencky", 1, 0.3), 1, false);
  const auto contacts = OutlineNeighbours().detect(grains, state_of(grains));
  REQUIRE(!contacts.empty());
  for (const OutlineContact& c : contacts) CHECK(grains.grain_of_vertex(c.vertex) == 0);
}

TEST_CASE("vertices meet walls by their distance, and slip by their path less the wall's") {
  const SoftGrains grains({test::placed(test::disk(4), 1, {0, 0})}, make_law("hencky", 1, 0.3), 1, false);
  Wall<2> wall = test::floor_at(-0.95);
  wall.velocity = {0.01, 0};
  OutlineState state = state_of(grains, {wall});
  for (Vec<2>& x : state.start) x -= Vec<2>{0.03, 0};
  state.dt = 2;
  const auto contacts = OutlineNeighbours().detect(grains, state);
  const double margin = 0.5 * 2 * pi / 16;
  int expected = 0;
  for (const Vec<2>& x : state.position) expected += x[1] + 0.95 < margin;
  CHECK(contacts.size() == expected);
  for (const OutlineContact& c : contacts) {
    CHECK(c.wall == 0);
    CHECK(c.normal == Vec<2>{0, 1});
    CHECK(c.gap == doctest::Approx(state.position[c.vertex][1] + 0.95));
    CHECK(c.slip == doctest::Approx(-(0.03 - 2 * 0.01)));  // along e_z x n, which is -e_x
  }
}

TEST_CASE("slip is the path of the vertex along the edge less that of the place it faces") {
  const SoftGrains grains = overlapping_pair();
  OutlineState state = state_of(grains);
  const Vec<2> path_of_slave{0.02, 0.05}, path_of_master{0.01, -0.04};
  for (int v = 0; v < grains.outline_size(); ++v)
    state.start[v] -= grains.grain_of_vertex(v) == 1 ? path_of_slave : path_of_master;
  const auto contacts = OutlineNeighbours().detect(grains, state);
  REQUIRE(!contacts.empty());
  for (const OutlineContact& c : contacts)
    CHECK(c.slip == doctest::Approx(dot(perpendicular(c.normal), path_of_slave - path_of_master)));
}

TEST_CASE("the smoothed normals of a circle are radial") {
  const SoftGrains grains({test::placed(test::disk(4), 2, {3, 1})}, make_law("hencky", 1, 0.3), 1, false);
  const OutlineState state = state_of(grains);
  const auto normals = smoothed_normals(grains, state.position);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Vec<2> radial = state.position[v] - Vec<2>{3, 1};
    CHECK(norm(normals[v] - (1 / norm(radial)) * radial) < 1e-14);
  }
}

TEST_CASE("impulses are carried by vertex and by wall or master grain, not by edge") {
  const auto shape = test::disk(4);
  const SoftGrains grains(
      {test::placed(shape, 1, {0, 0}), test::placed(shape, 1, {2, 0}), test::placed(shape, 1, {4, 0})},
      make_law("hencky", 1, 0.3), 1, false);
  const auto against = [](int vertex, int master) {
    return OutlineContact{.vertex = vertex, .master = {master, master + 1}, .normal = {}};
  };
  const std::vector<OutlineContact> old{{.vertex = 2, .wall = 0, .normal = {}},
                                        {.vertex = 2, .wall = 1, .normal = {}},
                                        against(3, 17),
                                        against(4, 18)};
  const std::vector<Vec<2>> impulse{{1, 0.1}, {2, 0.2}, {3, 0.3}, {0, 0}};
  const std::vector<OutlineContact> now{{.vertex = 1, .wall = 0, .normal = {}},
                                        {.vertex = 2, .wall = 1, .normal = {}},
                                        against(3, 20),  // another edge of the same grain
                                        against(3, 40),  // another grain
                                        against(4, 18)};
  const auto carried = carried_impulses(grains, old, impulse, now);
  const std::vector<Vec<2>> expected{{0, 0}, {2, 0.2}, {3, 0.3}, {0, 0}, {0, 0}};
  CHECK(carried == expected);
}

TEST_CASE("the gap of a contact follows its vertex along the edge") {
  const SoftGrains grains = overlapping_pair();
  OutlineState state = state_of(grains, {test::floor_at(-1)});
  const auto contacts = OutlineNeighbours().detect(grains, state);
  for (const OutlineContact& c : contacts) CHECK(gap_now(c, state) == doctest::Approx(c.gap));
  // sliding along its own edge changes no distance, whatever the smoothed normal says
  const auto inner = std::ranges::find_if(
      contacts, [](const OutlineContact& c) { return c.wall < 0 && c.share > 0.2 && c.share < 0.8; });
  REQUIRE(inner != contacts.end());
  const Vec<2> edge = state.position[inner->master[1]] - state.position[inner->master[0]];
  state.position[inner->vertex] += 0.1 * edge;
  CHECK(gap_now(*inner, state) == doctest::Approx(inner->gap));
}
