#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "softgrain/soft/outline_contacts.hpp"
#include "support/outlines.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;
using test::overlapping_pair;
using test::state_of;

namespace {

constexpr double pi = 3.141592653589793;

}  // namespace

TEST_CASE(
    "a wall at any angle is at the distance of the circle through the vertices, and pushes its centre") {
  for (const int cells : {2, 3, 4, 8, 16}) {
    const SoftGrains grains({test::placed(test::disk(cells), 1, {0, 0})},
                            make_law(MaterialLaw::hencky, 1, 0.3), 1);
    const double radius = norm(grains.node_position(0, grains.topology(0).grid.outline_begin));
    for (int k = 0; k < 50; ++k) {
      const double angle = 0.1 * k;
      const Vec<2> n{std::cos(angle), std::sin(angle)};
      const OutlineState state =
          state_of(grains, {{.point = -(radius - 0.01) * n, .normal = n, .velocity = {}}});
      OutlineContact lowest{.normal = {}, .gap = 1};
      for (const OutlineContact& c : OutlineNeighbours().detect(grains, state))
        if (c.gap < lowest.gap) lowest = c;
      CHECK(lowest.gap == doctest::Approx(-0.01));
      Vec<2> place;  // where the force acts
      lowest.for_each_vertex([&](int v, double weight) { place += weight * state.position[v]; });
      CHECK(std::abs(dot(place, perpendicular(n))) < 1e-12);
    }
  }
}

TEST_CASE(
    "the gap at a wall has the gradient by which its force acts, and is concave, also of a deformed grain") {
  const SoftGrains grains = overlapping_pair();
  const double c = std::cos(1.0), s = std::sin(1.0);
  OutlineState state =
      state_of(grains, {{.point = {-0.97 * c, -0.97 * s}, .normal = {c, s}, .velocity = {}}});
  const auto contacts = OutlineNeighbours().detect(grains, state);
  const auto gap_of = [&](const OutlineContact& of) {
    for (const OutlineContact& found : OutlineNeighbours().detect(grains, state))
      if (found.vertex == of.vertex && found.wall == of.wall) return found.gap;
    return 1e9;
  };
  int with_neighbours = 0;
  for (const OutlineContact& contact : contacts) {
    if (contact.wall < 0) continue;
    int vertices = 0;
    contact.for_each_vertex([&](int v, double weight) {
      ++vertices;
      for (int d = 0; d < 2; ++d) {
        constexpr double h = 1e-6;
        const Vec<2> x = state.position[v];
        state.position[v][d] = x[d] + h;
        const double more = gap_of(contact);
        state.position[v][d] = x[d] - h;
        const double less = gap_of(contact);
        CHECK(std::abs((more - less) / (2 * h) - weight * contact.normal[d]) < 1e-7);
        CHECK(more + less <= 2 * contact.gap + 1e-14);
        state.position[v] = x;
      }
    });
    with_neighbours += vertices == 3;
  }
  CHECK(with_neighbours >= 2);
}

TEST_CASE("a vertex alone meets a wall where the outline is straight or has a corner") {
  const SoftGrains grains({test::placed(test::square(4), 1, {0, 0})}, make_law(MaterialLaw::hencky, 1, 0.3),
                          1);
  const OutlineState state = state_of(grains, {test::floor_at(-0.5)});
  int on_wall = 0;
  for (const OutlineContact& c : OutlineNeighbours().detect(grains, state)) {
    CHECK(c.gap == doctest::Approx(state.position[c.vertex][1] + 0.5));
    on_wall += c.share == 0 && c.gap < 1e-3;
  }
  CHECK(on_wall == 5);
}

TEST_CASE("vertices meet walls by the distance of their arcs, and slip by their path less the wall's") {
  const SoftGrains grains({test::placed(test::disk(4), 1, {0, 0})}, make_law(MaterialLaw::hencky, 1, 0.3), 1);
  Wall<2> wall = test::floor_at(-0.95);
  wall.velocity = {0.01, 0};
  OutlineState state = state_of(grains, {wall});
  for (Vec<2>& x : state.start) x -= Vec<2>{0.03, 0};
  state.dt = 2;
  const auto contacts = OutlineNeighbours().detect(grains, state);
  const double margin = 0.5 * 2 * pi / 16;
  for (int v = 0; v < grains.outline_size(); ++v)
    if (state.position[v][1] + 0.95 < margin)
      CHECK(std::ranges::count(contacts, v, &OutlineContact::vertex) == 1);
  CHECK(contacts.size() <= 6);
  for (const OutlineContact& c : contacts) {
    CHECK(c.gap < margin);
    CHECK(c.wall == 0);
    CHECK(c.normal == Vec<2>{0, 1});
    CHECK(c.gap <= state.position[c.vertex][1] + 0.95);
    CHECK(c.gap == doctest::Approx(gap_now(c, state)));
    CHECK(c.slip == doctest::Approx(-(0.03 - 2 * 0.01)));  // along e_z x n, which is -e_x
  }
}
