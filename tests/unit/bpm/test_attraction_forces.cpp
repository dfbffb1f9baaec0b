#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/bpm/attraction_forces.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;

namespace {

/// Two grains of random primaries, interlaced so that most near neighbours are strangers.
RigidParticles<2> two_grains() {
  auto bodies = test::random_bodies<2>(9, 41);
  for (Vec<2>& x : bodies.position) x *= 1.1;  // overlaps stay below 5 %
  const auto places = bodies.position;
  for (int i = 0; i < bodies.size(); ++i) {
    bodies.position[i] = places[32 * i % 81];  // 32 and 81 have no common factor: every place once
    bodies.grain[i] = i < 54 ? 0 : 1;
  }
  return bodies;
}

NeighbourReference<2> reference_of(const RigidParticles<2>& bodies) {
  NeighbourReference<2> reference{.skin = 0.3, .position = {}, .wall_point = {}};
  set_reference(reference, bodies);
  return reference;
}

/// The paper's Eq. (1) over all pairs of a grain closer than 2 a0; F0 under overlap.
std::vector<Vec<2>> brute_force(const RigidParticles<2>& bodies, double F0, double gamma) {
  std::vector<Vec<2>> force(bodies.size());
  for (int i = 0; i < bodies.size(); ++i) {
    for (int j = 0; j < bodies.size(); ++j) {
      const Vec<2> d = bodies.position[j] - bodies.position[i];
      const double r = norm(d), a0 = bodies.radius[i] + bodies.radius[j], gap = std::fmax(r - a0, 0);
      if (i == j || bodies.grain[i] != bodies.grain[j] || r > 2 * a0) continue;
      force[i] += (F0 * std::pow(1 + gap / a0, -gamma) / r) * d;
    }
  }
  return force;
}

}  // namespace

TEST_CASE("attraction acts between all near pairs of one grain, never between grains") {
  auto bodies = two_grains();
  const auto reference = reference_of(bodies);
  drift(bodies, 0.1);  // less than half the skin
  for (const double gamma : {7.0, 3.0}) {
    AttractionForces attraction({.F0 = 5, .gamma = gamma});
    attraction.update(bodies, reference);
    std::vector<Vec<2>> force(bodies.size(), Vec<2>{1, 2});
    attraction.add_forces(bodies, force);
    const auto expected = brute_force(bodies, 5, gamma);
    Vec<2> sum;
    for (int i = 0; i < bodies.size(); ++i) {
      CHECK(norm(force[i] - Vec<2>{1, 2} - expected[i]) < 1e-6);  // the lanes are 1e-7 off at deep overlap
      sum += force[i] - Vec<2>{1, 2};
    }
    CHECK(norm(sum) < 1e-12);
  }
}

TEST_CASE("the energy is that of all near pairs, and its slope is minus the force") {
  auto bodies = two_grains();
  for (Vec<2>& x : bodies.position) x *= 1.1;  // now without overlap
  const auto reference = reference_of(bodies);
  AttractionForces attraction({.F0 = 5, .gamma = 7});
  attraction.update(bodies, reference);
  std::vector<Vec<2>> force(bodies.size());
  attraction.add_forces(bodies, force);
  const double step = 1e-5;
  for (const int i : {0, 17, 40, 80}) {
    for (int k = 0; k < 2; ++k) {
      const double x = bodies.position[i][k];
      bodies.position[i][k] = x + step;
      const double above = attraction.energy(bodies);
      bodies.position[i][k] = x - step;
      const double below = attraction.energy(bodies);
      bodies.position[i][k] = x;
      CHECK(force[i][k] == doctest::Approx(-(above - below) / (2 * step)).epsilon(1e-6));
    }
  }
}

TEST_CASE("the list is made again only when the reference moves on") {
  auto bodies = two_grains();
  auto reference = reference_of(bodies);
  AttractionForces attraction({.F0 = 5, .gamma = 7});
  const auto count = [&] {
    int pairs = 0;
    attraction.for_each_pair([&](int i, int j) {
      CHECK(i < j);
      ++pairs;
    });
    return pairs;
  };
  attraction.update(bodies, reference);
  const int at_first = count();
  for (Vec<2>& x : bodies.position) x *= 10;
  attraction.update(bodies, reference);
  CHECK(count() == at_first);
  set_reference(reference, bodies);
  attraction.update(bodies, reference);
  CHECK(count() == 0);
}

TEST_CASE("no primaries have no attraction") {
  RigidParticles<2> nothing;
  AttractionForces attraction({.F0 = 5, .gamma = 7});
  attraction.update(nothing, reference_of(nothing));
  CHECK(attraction.energy(nothing) == 0);
}
