#include "softgrain/soft/outline_contacts.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "softgrain/soft/contact_work.hpp"
#include "support/outlines.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;
using test::overlapping_pair;
using test::state_of;

namespace {

struct Facing {
  double distance = std::numeric_limits<double>::infinity();
  Vec<2> place, normal;
};

/// The closest of many points of a grain's outline to a point; the curve by blending the parabolas
/// through x_0 x_1 x_2 and x_1 x_2 x_3.
Facing brute_force(const SoftGrains& grains, const OutlineState& state, int grain, const Vec<2>& x) {
  Facing best;
  const int begin = grains.outline_begin(grain), n = grains.outline_end(grain) - begin;
  for (int v = 0; v < n; ++v) {
    const auto vertex = [&](int k) { return state.position[begin + (v + k + n) % n]; };
    const auto parabola = [&](int first, double s) {  // through three vertices at s = 0, 1, 2
      return (s - 1) * (s - 2) / 2 * vertex(first) - s * (s - 2) * vertex(first + 1) +
             s * (s - 1) / 2 * vertex(first + 2);
    };
    const auto point = [&](double s) { return (1 - s) * parabola(-1, s + 1) + s * parabola(0, s); };
    constexpr int samples = 2000;
    for (int k = 0; k <= samples; ++k) {
      const double s = static_cast<double>(k) / samples;
      const Vec<2> place = point(s), along = point(s + 1e-4) - point(s - 1e-4);
      if (norm(x - place) < best.distance)
        best = {norm(x - place), place, (-1 / norm(along)) * perpendicular(along)};
    }
  }
  return best;
}

/// What a contact faces.
Vec<2> place_of(const OutlineContact& c, const OutlineState& state) {
  Vec<2> place;
  for (std::size_t k = 0; k < 4; ++k) place += c.weights()[k] * state.position[c.master[k]];
  return place;
}

constexpr double pi = 3.141592653589793;

}  // namespace

TEST_CASE("every vertex of both outlines faces the closest point of the other's curve") {
  const SoftGrains grains = overlapping_pair();
  const OutlineState state = state_of(grains);
  const auto contacts = OutlineNeighbours().detect(grains, state);
  std::map<int, OutlineContact> by_vertex;
  for (const OutlineContact& c : contacts) by_vertex[c.vertex] = c;
  CHECK(by_vertex.size() == contacts.size());
  const double margin = 0.5 * (2 * pi / 12 + 2 * pi / 20) / 2;
  std::array<int, 2> met{};
  for (int v = 0; v < grains.outline_size(); ++v) {
    const int grain = grains.grain_of_vertex(v);
    const Vec<2>& x = state.position[v];
    const Facing facing = brute_force(grains, state, 1 - grain, x);
    const auto found = by_vertex.find(v);
    if (found == by_vertex.end()) {
      CHECK(facing.distance > 0.999 * margin);
      continue;
    }
    ++met[grain];
    const OutlineContact& c = found->second;
    CHECK(norm(place_of(c, state) - facing.place) < 1e-3);
    CHECK(norm(c.normal) == doctest::Approx(1));
    CHECK(norm(c.normal - facing.normal) < 5e-3);
    CHECK(std::abs(c.gap) == doctest::Approx(facing.distance).epsilon(1e-4));
    CHECK((c.gap < 0) == (dot(x - facing.place, facing.normal) < 0));
  }
  CHECK(met[0] >= 1);
  CHECK(met[1] >= 2);
  CHECK(std::ranges::count_if(contacts, [](const OutlineContact& c) { return c.gap < 0; }) >= 1);
}

TEST_CASE("on outlines with short and long segments and sharp bends, too, vertices face the closest point") {
  int met = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SoftGrains grains({test::placed(test::disk(4), 1, {0, 0}), test::placed(test::disk(4), 1, {2, 0.1})},
                      make_law(MaterialLaw::neo_hookean, 1, 0.3), 1);
    test::shake(grains, 0.15, seed);  // a segment is 0.4 long
    const OutlineState state = state_of(grains);
    for (const OutlineContact& c : OutlineNeighbours().detect(grains, state)) {
      if (std::abs(c.gap) > 0.1)
        continue;  // further away the closest vertex need not be near the closest point
      const Facing facing =
          brute_force(grains, state, 1 - grains.grain_of_vertex(c.vertex), state.position[c.vertex]);
      CHECK(std::abs(c.gap) < facing.distance + 2e-3);
      ++met;
    }
  }
  CHECK(met > 50);
}

TEST_CASE("the contacts of many grains are those of each pair of them") {
  std::vector<GrainPlacement> placed;  // on a square lattice, overlapping, 24 vertices each
  for (int g = 0; g < 16; ++g)
    placed.push_back(test::placed(test::disk(6), 1, {1.97 * (g % 4), 1.97 * (g / 4)}, {}, 0.1 * g));
  const auto detect = [&](std::vector<GrainPlacement> some) {
    const SoftGrains grains(std::move(some), make_law(MaterialLaw::neo_hookean, 1, 0.3), 1);
    return OutlineNeighbours().detect(grains, state_of(grains));
  };
  using Pair = std::array<int, 2>;                      // the slave's and the master's grain
  std::map<Pair, std::map<int, double>> gap, expected;  // by the slave's place on its outline
  for (const OutlineContact& c : detect(placed))
    gap[{c.vertex / 24, c.master[0] / 24}][c.vertex % 24] = c.gap;
  for (int a = 0; a < 16; ++a)
    for (int b = a + 1; b < 16; ++b)
      for (const OutlineContact& c : detect({placed[a], placed[b]}))
        expected[c.vertex < 24 ? Pair{a, b} : Pair{b, a}][c.vertex % 24] = c.gap;
  CHECK(gap.size() == 48);  // 24 pairs touch, both ways
  CHECK(gap == expected);
}

TEST_CASE("a grain that rolls round another finds the same contacts as a search from the beginning") {
  const std::vector<GrainPlacement> placed{test::placed(test::disk(3), 1, {0, 0}),
                                           test::placed(test::disk(5), 1, {1.99, 0})};
  const SoftGrains grains(placed, make_law(MaterialLaw::hencky, 1, 0.3), 1);
  OutlineNeighbours neighbours;
  const OutlineState state = state_of(grains);
  for (int step = 0; step < 20; ++step) {
    const double angle = 0.3 * step;
    const Vec<2> shift = 1.99 * Vec<2>{std::cos(angle), std::sin(angle)} - placed[1].centre;
    OutlineState moved = state;
    for (int v = grains.outline_begin(1); v < grains.outline_end(1); ++v) moved.position[v] += shift;
    moved.start = moved.position;
    const auto contacts = neighbours.detect(grains, moved);
    CHECK(contacts.size() >= 1);
    for (const OutlineContact& c : contacts) {
      const int other = 1 - grains.grain_of_vertex(c.vertex);
      CHECK(grains.grain_of_vertex(c.master[0]) == other);
      const Facing facing = brute_force(grains, moved, other, moved.position[c.vertex]);
      CHECK(norm(place_of(c, moved) - facing.place) < 1e-3);
    }
  }
}

TEST_CASE("the normal is the gradient of the gap, by the slave and by each vertex of the master") {
  const SoftGrains grains = overlapping_pair();
  OutlineState state = state_of(grains);
  const auto contacts = OutlineNeighbours().detect(grains, state);
  REQUIRE(contacts.size() >= 3);
  const auto gap_of = [&](int vertex) {
    for (const OutlineContact& c : OutlineNeighbours().detect(grains, state))
      if (c.vertex == vertex) return c.gap;
    return 1e9;
  };
  constexpr double h = 1e-6;
  for (const OutlineContact& c : contacts)
    for (int k = -1; k < 4; ++k) {
      const int moving = k < 0 ? c.vertex : c.master[k];
      const double weight = k < 0 ? 1 : -c.weights()[k];
      for (int d = 0; d < 2; ++d) {
        const double x = state.position[moving][d];
        state.position[moving][d] = x + h;
        const double more = gap_of(c.vertex);
        state.position[moving][d] = x - h;
        const double less = gap_of(c.vertex);
        state.position[moving][d] = x;
        CHECK(std::abs((more - less) / (2 * h) - weight * c.normal[d]) < 1e-8);
      }
    }
}

TEST_CASE("the curve passes through its vertices and keeps its direction there") {
  for (const double xi : {0.0, 0.3, 1.0}) {
    double sum = 0;
    for (const double w : curve_weights(xi)) sum += w;
    CHECK(sum == doctest::Approx(1));
  }
  CHECK(curve_weights(0) == std::array<double, 4>{0, 1, 0, 0});
  CHECK(curve_weights(1) == std::array<double, 4>{0, 0, 1, 0});
  // the end of one span, by vertices 0 to 3, is the start of the next, by vertices 1 to 4
  constexpr double h = 1e-6;
  const auto end = curve_weights(1 - h), start = curve_weights(h);
  for (std::size_t k = 0; k < 3; ++k) {
    const double vertex = k == 1 ? 1 : 0;  // weight of vertex k + 1 where the spans meet
    CHECK((vertex - end[k + 1]) / h == doctest::Approx((start[k] - vertex) / h).scale(1).epsilon(1e-5));
  }
}

TEST_CASE("along a round grain contact does the work of its gap but for terms of third order in the slip") {
  const std::vector<GrainPlacement> placed{test::placed(test::disk(16), 1, {0, 0}),
                                           test::placed(test::disk(16), 1, {1.99, 0})};
  const SoftGrains grains(placed, make_law(MaterialLaw::hencky, 1, 0.3), 1);
  for (const double slip : {0.05, 0.1, 0.2}) {  // the second grain on a circle about the first one
    OutlineState state = state_of(grains);
    const Vec<2> shift = 1.99 * Vec<2>{std::cos(slip), std::sin(slip)} - placed[1].centre;
    for (int v = grains.outline_begin(1); v < grains.outline_end(1); ++v) state.position[v] += shift;
    OutlineState start = state;
    start.position = start.start;
    int closed = 0;
    for (const OutlineContact& c : OutlineNeighbours().detect(grains, state)) {
      if (c.gap > 0) continue;
      ++closed;
      const Vec<2>& x = start.position[c.vertex];
      const Facing facing = brute_force(grains, start, grains.grain_of_vertex(c.master[0]), x);
      const double opened = c.gap - dot(x - facing.place, facing.normal);
      // with the normal of the end: about slip^2
      CHECK(std::abs(dot(c.normal, relative_displacement(c, state)) - opened) < 0.3 * slip * slip * slip);
    }
    CHECK(closed >= 1);
  }
}

TEST_CASE("slip is the path of the vertex along the edge less that of the place it faces") {
  const SoftGrains grains = overlapping_pair();
  OutlineState state = state_of(grains);
  const std::array<Vec<2>, 2> path{Vec<2>{0.01, -0.04}, Vec<2>{0.02, 0.05}};
  for (int v = 0; v < grains.outline_size(); ++v) state.start[v] -= path[grains.grain_of_vertex(v)];
  const auto contacts = OutlineNeighbours().detect(grains, state);
  REQUIRE(!contacts.empty());
  for (const OutlineContact& c : contacts)
    CHECK(c.slip ==
          doctest::Approx(dot(perpendicular(c.normal), path[grains.grain_of_vertex(c.vertex)] -
                                                           path[grains.grain_of_vertex(c.master[0])])));
}

TEST_CASE("impulses are carried by vertex and by wall or master grain, not by place") {
  const auto shape = test::disk(4);
  const SoftGrains grains(
      {test::placed(shape, 1, {0, 0}), test::placed(shape, 1, {2, 0}), test::placed(shape, 1, {4, 0})},
      make_law(MaterialLaw::hencky, 1, 0.3), 1);
  const auto against = [](int vertex, int master) {
    return OutlineContact{.vertex = vertex, .master = {master, master, master, master}, .normal = {}};
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

TEST_CASE("the gap of a contact follows its vertex along the curve") {
  const SoftGrains grains = overlapping_pair();
  OutlineState state = state_of(grains, {test::floor_at(-1)});
  const auto contacts = OutlineNeighbours().detect(grains, state);
  for (const OutlineContact& c : contacts) CHECK(gap_now(c, state) == doctest::Approx(c.gap));
  // and is found again from a little further on
  const OutlineContact& c = contacts.back();
  const Vec<2> moved = 0.02 * perpendicular(c.normal) + 0.01 * c.normal;
  state.position[c.vertex] += moved;
  const Facing facing =
      brute_force(grains, state, 1 - grains.grain_of_vertex(c.vertex), state.position[c.vertex]);
  CHECK(gap_now(c, state) ==
        doctest::Approx(dot(state.position[c.vertex] - facing.place, facing.normal)).epsilon(1e-3));
}

TEST_CASE("contacts take the work of their impulses, and friction its part along the contact") {
  const OutlineState state{
      .position = {{0.03, -0.01}}, .start = {{0, 0}}, .walls = {test::floor_at(0)}, .dt = 0.1};
  const std::vector<OutlineContact> contacts{{.vertex = 0, .wall = 0, .normal = {0, 1}}};
  const std::vector<Vec<2>> impulse{{2, 0.5}};  // (p_n, p_t), t = (-1, 0): P = (-0.5, 2)
  WorkBudget work;
  std::vector<Vec<2>> wall_impulse(1);
  add_contact_work(contacts, impulse, state, work, wall_impulse);
  CHECK(work.contacts == doctest::Approx(0.5 * 0.3 + 2 * 0.1));
  CHECK(work.friction == doctest::Approx(0.5 * 0.3));
  CHECK(work.walls == 0);
  CHECK(wall_impulse[0] == Vec<2>{0.5, -2});
}
