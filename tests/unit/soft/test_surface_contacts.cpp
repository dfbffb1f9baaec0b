#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include "softgrain/soft/facing_surface.hpp"
#include "softgrain/soft/rigid_surface.hpp"
#include "softgrain/soft/solid_topology.hpp"
#include "support/meshes.hpp"
#include "support/solid_grains.hpp"

using namespace softgrain;

namespace {

std::vector<Vec<3>> outline_of(const SolidTopology& ball) {
  return {ball.grid.node.begin() + ball.grid.outline_begin, ball.grid.node.end()};
}

Vec<3> place_of(const SurfacePoint& point, const Vec<3>* x) {
  const SurfaceContact contact{.point = 1000, .own = &point};
  Vec<3> place;
  contact.for_each_own_vertex([&](int v, double weight) { place += weight * x[v]; });
  return place;
}

/// Two balls on each other along z, their centres 2 - 2 d apart, with the state that contacts are found in.
struct TwoBalls {
  SolidGrains grains;
  OutlineStateOf<3> state;

  explicit TwoBalls(double d, int n = 4) : grains(pair_of(d, n)), state() {
    grains.gather_outline(state.position);
    state.start = state.position;
    state.dt = 1;
  }
  static SolidGrains pair_of(double d, int n) {
    const auto shape = test::ball(n);
    return {{{.topology = shape, .radius = 1, .centre = {}, .velocity = {}},
             {.topology = shape,
              .radius = 1,
              .centre = {0, 0, 2 - 2 * d},
              .angle = test::some_turn(1),
              .velocity = {}}},
            {GrainMaterial{make_law(MaterialLaw::neo_hookean, 1, 0.45), 1}}};
  }
};

}  // namespace

TEST_CASE("the smooth outline of a ball is the sphere") {
  const SolidTopology ball(ball_grid(6));
  const std::vector<Vec<3>> x = outline_of(ball);
  double squares = 0, count = 0;
  for (const PatchNet& net : ball.patches) {
    const SurfacePatch patch(net, x.data());
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const auto c = patch.at((i + 0.5) / 6, (j + 0.5) / 6);
        squares += std::pow(norm(c.place) - 1, 2), count += 1;
        CHECK(dot(c.normal(), c.place) > 0.99);
      }
  }
  CHECK(std::sqrt(squares / count) < 5e-4);
  const SurfaceMeasure measure = measure_surface(ball.patches, x.data());
  CHECK(measure.volume == doctest::Approx(4 * std::numbers::pi / 3).epsilon(6e-4));
  CHECK(measure.area == doctest::Approx(4 * std::numbers::pi).epsilon(1e-3));
}

TEST_CASE(
    "a patch of the smooth outline is linear in its vertices: flat nets are flat, weights add up to 1") {
  const SolidTopology ball(ball_grid(4));
  std::vector<Vec<3>> x = outline_of(ball);
  for (Vec<3>& vertex : x) vertex[2] = 0.3 * vertex[0] - 0.2 * vertex[1] + 1;
  int ghosts = 0;
  for (const PatchNet& net : ball.patches) {
    ghosts += net.ghosts ? 1 : 0;
    const SurfacePatch patch(net, x.data());
    for (const double u : {0.0, 0.3, 1.0})
      for (const double v : {0.1, 0.8}) {
        const Vec<3> c = patch.at(u, v).place;
        CHECK(c[2] == doctest::Approx(0.3 * c[0] - 0.2 * c[1] + 1).epsilon(1e-14));
        const auto weights = patch_weights(net, u, v);
        Vec<3> by_weights;
        double sum = 0;
        for (std::size_t k = 0; k < 16; ++k)
          by_weights += weights[k] * x[static_cast<std::size_t>(net.vertex[k])], sum += weights[k];
        CHECK(sum == doctest::Approx(1).epsilon(1e-14));
        CHECK(norm(by_weights - c) < 1e-14);
      }
  }
  CHECK(ghosts == 24);  // three quads at each of the eight vertices of valence 3
}

TEST_CASE("tangents of a patch are the derivatives of its place, and neighbouring patches meet") {
  const SolidTopology ball(ball_grid(4));
  const std::vector<Vec<3>> x = outline_of(ball);
  constexpr double step = 1e-6;
  for (const PatchNet& net : ball.patches) {
    const SurfacePatch patch(net, x.data());
    const auto c = patch.at(0.3, 0.7);
    CHECK(norm((1 / (2 * step)) * (patch.at(0.3 + step, 0.7).place - patch.at(0.3 - step, 0.7).place) -
               c.along_u) < 1e-9);
    CHECK(norm((1 / (2 * step)) * (patch.at(0.3, 0.7 + step).place - patch.at(0.3, 0.7 - step).place) -
               c.along_v) < 1e-9);
    CHECK(norm(patch.at(0, 0).place - x[static_cast<std::size_t>(net.vertex[5])]) < 1e-14);
    CHECK(norm(patch.at(1, 1).place - x[static_cast<std::size_t>(net.vertex[10])]) < 1e-14);
  }
}

TEST_CASE(
    "vertices and middles of the first of two balls face the other's sphere along the line of centres") {
  TwoBalls two(0.02);
  const auto contacts = SurfaceNeighbours{}.detect(two.grains, two.state, 0.3);
  REQUIRE(contacts.size() > 8);
  int vertices = 0, of_patches = 0, of_edges = 0;
  for (const SurfaceContact& contact : contacts) {
    ++(contact.own == nullptr ? vertices : contact.own->of_edge() ? of_edges : of_patches);
    CHECK(two.grains.grain_of_vertex(contact.vertex) == 0);
    CHECK(contact.facing == 1);
    const Vec<3> centre{0, 0, 1.96};  // of the master
    const Vec<3> d = place_of(contact, two.state.position) - centre;
    CHECK(contact.gap == doctest::Approx(norm(d) - 1).epsilon(0.006));  // of a smooth outline of 98 vertices
    CHECK(dot(contact.normal, d) / norm(d) > 0.999);
    CHECK(gap_now(contact, two.state) == doctest::Approx(contact.gap).epsilon(1e-9));
  }
  CHECK((vertices > 0 && of_patches > 0 && of_edges > 0));
}

TEST_CASE("the finer of two balls brings its points, whether it is the smaller or has more vertices") {
  const auto coarse = test::ball(4), fine = test::ball(6);
  struct Pair {
    std::shared_ptr<const SolidTopology> shape[2];
    double radius[2];
    int finer;
  };
  for (const Pair& pair : {Pair{{coarse, fine}, {1, 1}, 1}, Pair{{fine, coarse}, {1, 1}, 0},
                           Pair{{coarse, coarse}, {1, 0.9}, 1}, Pair{{coarse, fine}, {0.5, 1}, 0}}) {
    const auto placed = [&](int k, double z) {
      return PlacementOf<3>{
          .topology = pair.shape[k], .radius = pair.radius[k], .centre = {0, 0, z}, .velocity = {}};
    };
    SolidGrains grains({placed(0, 0), placed(1, 0.98 * (pair.radius[0] + pair.radius[1]))},
                       {GrainMaterial{make_law(MaterialLaw::neo_hookean, 1, 0.45), 1}});
    OutlineStateOf<3> state;
    grains.gather_outline(state.position);
    state.start = state.position;
    const auto contacts = SurfaceNeighbours{}.detect(grains, state, 0.1);
    CHECK(!contacts.empty());
    for (const SurfaceContact& contact : contacts)
      CHECK(grains.grain_of_vertex(contact.vertex) == pair.finer);
  }
}

TEST_CASE("every vertex and middle near another ball is found, in a cell that repeats, too") {
  for (const bool repeats : {false, true}) {
    TwoBalls two(0.04, 6);
    if (repeats) {  // the second ball is met through the image above
      two.state.cell.repeats = {false, false, true};
      two.state.cell.edges = Mat<3>::diagonal({1, 1, 10});
      for (std::size_t v = two.state.position.size() / 2; v < two.state.position.size(); ++v)
        two.state.position[v][2] += 10;
      two.state.start = two.state.position;
    }
    const double margin = 0.1, error = 0.003;  // of the smooth outline
    const auto contacts = SurfaceNeighbours{}.detect(two.grains, two.state, margin);
    const double segment = std::sqrt(4 * std::numbers::pi / 218);
    const Middles middles(two.grains);
    int near = 0;
    const auto look_at = [&](const SurfaceContact& point) {
      if (two.grains.grain_of_vertex(point.vertex) != 0) return;
      const Vec<3> way = place_of(point, two.state.position) - Vec<3>{0, 0, 1.92};
      if (norm(way) - 1 > margin * segment - error) return;
      ++near;
      CHECK(std::count_if(contacts.begin(), contacts.end(),
                          [&](const SurfaceContact& c) { return c.point == point.point; }) == 1);
    };
    for (int v = 0; v < two.grains.outline_size(); ++v) look_at({.point = v, .vertex = v});
    for (int q = 0; q < middles.size(); ++q) look_at(middles.point(q));
    CHECK(near > 12);
  }
}

TEST_CASE("the middle of a patch is its place at u = v = 1/2, with ghosts and with edges") {
  const SolidTopology ball(ball_grid(4));
  const SolidTopology cube = rigid_surface(StarSurface(test::cube_mesh(1)), 4);
  for (const SolidTopology* shape : {&ball, &cube}) {
    const Vec<3>* x = shape->grid.node.data() + shape->grid.outline_begin;
    for (std::size_t q = 0; q < shape->patches.size(); ++q)
      CHECK(norm(place_of(shape->middles[q], x) - SurfacePatch(shape->patches[q], x).at(0.5, 0.5).place) <
            1e-14);
  }
}

TEST_CASE("the middle of an edge, each once, is where both patches beside it have the middle of this side") {
  const SolidTopology ball(ball_grid(4));
  const Vec<3>* x = ball.grid.node.data() + ball.grid.outline_begin;
  const std::size_t patches = ball.patches.size();
  REQUIRE(ball.middles.size() == 3 * patches);  // Euler: 2 edges for each quad of a closed surface
  std::map<std::pair<int, int>, const SurfacePoint*> edges;
  for (std::size_t k = patches; k < ball.middles.size(); ++k) {
    const SurfacePoint& edge = ball.middles[k];
    CHECK((edge.count == 4 || edge.count == 6));
    CHECK(edges.insert({{edge.corner[0], edge.corner[1]}, &edge}).second);
  }
  std::map<const SurfacePoint*, int> sides;
  for (const PatchNet& net : ball.patches) {
    constexpr std::array<std::array<double, 2>, 4> middle{{{0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}}};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto ends =
          std::minmax(net.vertex[PatchNet::corner[k]], net.vertex[PatchNet::corner[(k + 1) % 4]]);
      const SurfacePoint* edge = edges.at(ends);
      ++sides[edge];
      CHECK(norm(place_of(*edge, x) - SurfacePatch(net, x).at(middle[k][0], middle[k][1]).place) < 1e-14);
    }
  }
  for (const auto& [edge, count] : sides) CHECK(count == 2);
}

TEST_CASE("impulses of contacts between grains in space change no momentum") {
  TwoBalls two(0.03);
  const auto contacts = SurfaceNeighbours{}.detect(two.grains, two.state, 0.1);
  for (const SurfaceContact& contact : contacts) {
    double sum = 0;
    contact.for_each_vertex([&](int, double weight) { sum += weight; });
    CHECK(std::abs(sum) < 1e-14);
  }
}

TEST_CASE("impulses go over to the contacts that are found next, in their own axes") {
  TwoBalls two(0.02);
  const auto old = SurfaceNeighbours{}.detect(two.grains, two.state, 0.1);
  std::vector<Vec<3>> impulse;
  for (std::size_t c = 0; c < old.size(); ++c) impulse.push_back({1.0 + static_cast<double>(c), 0.2, -0.1});
  for (Vec<3>& x : two.state.position) x = test::turn_in(0, 2, 0.01) * x;
  const auto now = SurfaceNeighbours{}.detect(two.grains, two.state, 0.1);
  const auto carried = carried_impulses(two.grains, old, impulse, now);
  REQUIRE(now.size() == old.size());
  for (std::size_t c = 0; c < now.size(); ++c)
    CHECK(norm(impulse_vector(now[c], carried[c]) - impulse_vector(old[c], impulse[c])) < 1e-13);
}

TEST_CASE("a point in front of a thin fin meets its near side, whichever side its nearest vertex is on") {
  TwoBalls balls(0, 6);
  constexpr double thickness = 0.02;
  const int vertices = balls.grains.outline_end(0);
  std::vector<int> behind;
  for (int v = 0; v < vertices; ++v) {
    double& z = balls.state.position[v][2];
    if (z < -0.8) behind.push_back(v);
    z *= thickness;
  }
  const Surfaces surfaces(balls.grains, balls.state);
  const int of_other = vertices;
  REQUIRE(behind.size() > 10);
  for (const int nearest : behind) {
    const Vec<3> below = balls.state.position[nearest], at{below[0] + 0.02, below[1] - 0.01, 0.06};
    const SurfaceContact contact =
        contact_with_patch(surfaces, {.point = of_other, .vertex = of_other}, at, 0, nearest, 1);
    const double height = thickness * std::sqrt(1 - at[0] * at[0] - at[1] * at[1]);  // of the spheroid
    CHECK(std::abs(contact.gap - (at[2] - height)) < 1e-3);
    CHECK(contact.normal[2] > 0.99);
  }
}
