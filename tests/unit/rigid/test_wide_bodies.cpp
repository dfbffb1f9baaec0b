#include <doctest/doctest.h>

#include <set>
#include <tuple>

#include "softgrain/rigid/close_pairs.hpp"
#include "softgrain/rigid/neighbours.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;
using test::Plane;
using test::Space;

namespace {

/// Three bodies of six radii among the others, in their midst and at their edge.
template <int Dim>
RigidParticles<Dim> with_wide_bodies(RigidParticles<Dim> bodies, double across) {
  for (const double share : {0.1, 0.5, 0.9}) {
    const int i = static_cast<int>(share * bodies.size());
    bodies.radius[i] = 6;
    for (int k = 0; k < Dim; ++k) bodies.position[i][k] = share * across;
  }
  return bodies;
}

using Meeting = std::tuple<int, int, std::array<int, 3>>;

template <int Dim>
std::set<Meeting> meetings(const std::vector<BodyPair>& pairs) {
  std::set<Meeting> all;
  for (const BodyPair& pair : pairs) {
    CHECK(pair.a < pair.b);
    CHECK(all.emplace(pair.a, pair.b, pair.image).second);
  }
  return all;
}

/// Images n of j that i meets, by trying them all.
template <int Dim>
std::set<Meeting> meetings_within(const RigidParticles<Dim>& bodies, double gap) {
  std::set<Meeting> all;
  const int images = Dim == 2 ? 9 : 27;
  for (int i = 0; i < bodies.size(); ++i)
    for (int j = i + 1; j < bodies.size(); ++j)
      for (int code = 0; code < images; ++code) {
        if (!bodies.cell.any() && code != images / 2) continue;  // code images/2 is that of no image
        typename PeriodicCell<Dim>::Image n;
        std::array<int, 3> image{};
        for (int k = 0, rest = code; k < Dim; ++k, rest /= 3) image[k] = n[k] = rest % 3 - 1;
        const Vec<Dim> d = bodies.position[j] + bodies.cell.shift(n) - bodies.position[i];
        if (norm(d) - bodies.radius[i] - bodies.radius[j] < gap) all.emplace(i, j, image);
      }
  return all;
}

}  // namespace

TEST_CASE_TEMPLATE("bodies much wider than others have the pairs that trying all finds", Dimension, Plane,
                   Space) {
  constexpr int Dim = Dimension::value;
  const int per_side = Dim == 2 ? 20 : 14;
  auto bodies = with_wide_bodies(test::random_bodies<Dim>(per_side, 5), 2.0 * per_side);
  bodies.walls.clear();
  for (int i = 0; i < bodies.size(); ++i) bodies.grain[i] = i;
  NeighbourReference<Dim> reference{.skin = 0.2, .position = {}, .wall_point = {}};
  set_reference(reference, bodies);
  CHECK(meetings<Dim>(pairs_between(bodies, reference)) == meetings_within(bodies, 0.2));

  bodies.cell.repeats.fill(true);
  for (int k = 0; k < Dim; ++k) bodies.cell.edges(k, k) = 2.0 * per_side;
  bodies.cell.edges(0, 1) = 3;
  reference = {.skin = 0.2, .position = {}, .wall_point = {}};
  set_reference(reference, bodies);
  CHECK(meetings<Dim>(pairs_between(bodies, reference)) == meetings_within(bodies, 0.2));
}
