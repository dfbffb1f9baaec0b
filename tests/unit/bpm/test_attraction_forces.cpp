#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/bpm/attraction_forces.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;

namespace {

/// Two grains of random primaries, interlaced so that most near neighbours are strangers.
template <int Dim>
RigidParticles<Dim> two_grains() {
  auto bodies = test::random_bodies<Dim>(Dim == 2 ? 9 : 5, 41);
  for (Vec<Dim>& x : bodies.position) x *= 1.1;  // overlaps stay below 5 %
  const auto places = bodies.position;
  const int n = bodies.size();
  for (int i = 0; i < n; ++i) {
    bodies.position[i] = places[32 * i % n];  // 32 has no factor in common with 81 or 125: every place once
    bodies.grain[i] = i < 2 * n / 3 ? 0 : 1;
  }
  return bodies;
}

template <int Dim>
NeighbourReference<Dim> reference_of(const RigidParticles<Dim>& bodies) {
  NeighbourReference<Dim> reference{.skin = 0.3, .position = {}, .wall_point = {}};
  set_reference(reference, bodies);
  return reference;
}

/// The paper's Eq. (1) over all pairs of a grain closer than 2 a0; F0 under overlap.
template <int Dim>
std::vector<Vec<Dim>> brute_force(const RigidParticles<Dim>& bodies, double F0, double gamma) {
  std::vector<Vec<Dim>> force(bodies.size());
  for (int i = 0; i < bodies.size(); ++i) {
    for (int j = 0; j < bodies.size(); ++j) {
      const Vec<Dim> d = bodies.position[j] - bodies.position[i];
      const double r = norm(d), a0 = bodies.radius[i] + bodies.radius[j], gap = std::fmax(r - a0, 0);
      if (i == j || bodies.grain[i] != bodies.grain[j] || r > 2 * a0) continue;
      force[i] += (F0 * std::pow(1 + gap / a0, -gamma) / r) * d;
    }
  }
  return force;
}

}  // namespace

TEST_CASE_TEMPLATE("attraction acts between all near pairs of one grain, never between grains", Dimension,
                   test::Plane, test::Space) {
  constexpr int Dim = Dimension::value;
  auto bodies = two_grains<Dim>();
  const auto reference = reference_of(bodies);
  drift(bodies, 0.1);  // less than half the skin
  const Vec<Dim> start{1, 2};
  for (const double gamma : {7.0, 3.0}) {
    AttractionForcesOf<Dim> attraction({.F0 = 5, .gamma = gamma});
    attraction.update(bodies, reference);
    std::vector<Vec<Dim>> force(bodies.size(), start);
    attraction.add_forces(bodies, force);
    const auto expected = brute_force(bodies, 5, gamma);
    Vec<Dim> sum;
    for (int i = 0; i < bodies.size(); ++i) {
      CHECK(norm(force[i] - start - expected[i]) < 1e-6);  // the lanes are 1e-7 off at deep overlap
      sum += force[i] - start;
    }
    CHECK(norm(sum) < 1e-12);
  }
}

TEST_CASE_TEMPLATE("the energy is that of all near pairs, and its slope is minus the force", Dimension,
                   test::Plane, test::Space) {
  constexpr int Dim = Dimension::value;
  auto bodies = two_grains<Dim>();
  for (Vec<Dim>& x : bodies.position) x *= 1.1;  // now without overlap
  const auto reference = reference_of(bodies);
  AttractionForcesOf<Dim> attraction({.F0 = 5, .gamma = 7});
  attraction.update(bodies, reference);
  std::vector<Vec<Dim>> force(bodies.size());
  attraction.add_forces(bodies, force);
  const double step = 1e-5;
  for (const int i : {0, 17, 40, 80}) {
    for (int k = 0; k < Dim; ++k) {
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
  auto bodies = two_grains<2>();
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
