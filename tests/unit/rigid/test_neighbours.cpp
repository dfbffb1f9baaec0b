#include <doctest/doctest.h>

#include <map>
#include <set>
#include <utility>

#include "softgrain/rigid/neighbours.hpp"
#include "support/random_bodies.hpp"

using namespace softgrain;
using test::Plane;
using test::Space;

namespace {

using PairSet = std::set<std::pair<int, int>>;

/// Whether some pair might be missing from a list.
bool is_stale(NeighbourReference<2> reference, const RigidParticles<2>& bodies) {
  return renew_stale_lists(reference, bodies);
}

template <int Dim>
PairSet listed_pairs(const RigidContacts<Dim>& contacts) {
  PairSet pairs;
  for (int c = 0; c < contacts.size(); ++c) pairs.emplace(contacts.body_a[c], contacts.body_b[c]);
  return pairs;
}

template <int Dim>
PairSet pairs_within(const RigidParticles<Dim>& bodies, double gap) {
  PairSet pairs;
  for (int i = 0; i < bodies.size(); ++i) {
    for (int j = i + 1; j < bodies.size(); ++j)
      if (norm(bodies.position[j] - bodies.position[i]) - bodies.radius[i] - bodies.radius[j] < gap)
        pairs.emplace(i, j);
    for (int w = 0; w < Dim; ++w)  // random_bodies has wall w at x_w = 0
      if (bodies.position[i][w] - bodies.radius[i] < gap) pairs.emplace(i, bodies.wall_body(w));
  }
  return pairs;
}

template <int Dim>
RigidParticles<Dim> six_grains() {
  auto bodies = test::random_bodies<Dim>(Dim == 2 ? 12 : 6, 4);
  for (int i = 0; i < bodies.size(); ++i) bodies.grain[i] = i / (bodies.size() / 6);
  return bodies;
}

}  // namespace

TEST_CASE_TEMPLATE("candidate contacts are the pairs and walls closer than the skin", Dimension, Plane,
                   Space) {
  constexpr int Dim = Dimension::value;
  const test::ContactScene<Dim> scene(Dim == 2 ? 12 : 6);
  CHECK(listed_pairs(scene.contacts) == pairs_within(scene.bodies, 0.2));
  CHECK(static_cast<int>(listed_pairs(scene.contacts).size()) == scene.contacts.size());
  for (int c = 0; c < scene.contacts.size(); ++c) {
    const int a = scene.contacts.body_a[c], b = scene.contacts.body_b[c];
    CHECK(a < b);
    CHECK(scene.contacts.inverse_mass_a[c] == 1 / scene.bodies.mass[a]);
    CHECK(scene.contacts.inverse_mass_b[c] == (b < scene.bodies.size() ? 1 / scene.bodies.mass[b] : 0));
    CHECK(scene.contacts.friction[c] == test::mixed_friction(a, b));
  }
}

TEST_CASE_TEMPLATE("contacts inside grains come grain by grain, those between them and with walls last",
                   Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  const auto bodies = six_grains<Dim>();
  const int n = bodies.size();
  NeighbourReference<Dim> reference{.skin = 0.2, .position = {}, .wall_point = {}};
  set_reference(reference, bodies);
  const auto contacts = candidate_contacts(bodies, reference, test::mixed_friction, {});
  CHECK(listed_pairs(contacts) == pairs_within(bodies, 0.2));
  CHECK(static_cast<int>(listed_pairs(contacts).size()) == contacts.size());
  REQUIRE(contacts.blocks.size() == 7);
  int next = 0;
  for (int k = 0; k < 7; ++k) {
    const ContactBlock& block = contacts.blocks[k];
    CHECK(block.begin() == next);
    next = block.end();
    CHECK(block.frictional.begin == block.frictionless.end);
    for (int c = block.begin(); c < block.end(); ++c) {
      const int b = contacts.body_b[c];
      CHECK((k < 6) == (b < n && bodies.grain[contacts.body_a[c]] == bodies.grain[b]));
      if (k < 6) CHECK(bodies.grain[b] == k);
      CHECK((contacts.friction[c] > 0) == (c >= block.frictional.begin));
    }
  }
  CHECK(next == contacts.size());
}

TEST_CASE_TEMPLATE("four contacts that are solved at once share no particle, and few are left over",
                   Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  const test::ContactScene<Dim> scene(Dim == 2 ? 12 : 6);
  const auto& contacts = scene.contacts;
  for (const ContactBlock& block : contacts.blocks)
    for (const ContactBatch& batch : {block.frictionless, block.frictional}) {
      CHECK((batch.fours_end - batch.begin) % 4 == 0);
      CHECK(batch.end - batch.fours_end < 12);
      for (int c = batch.begin; c < batch.fours_end; c += 4) {
        std::set<int> particles;
        for (int k = c; k < c + 4; ++k) {
          CHECK(particles.insert(contacts.body_a[k]).second);
          if (contacts.body_b[k] < scene.bodies.size()) CHECK(particles.insert(contacts.body_b[k]).second);
        }
      }
    }
}

TEST_CASE("the order of the contacts depends on the reference alone") {
  test::ContactScene<2> scene(12);
  drift(scene.bodies, 0.05);
  const auto later = candidate_contacts(scene.bodies, scene.reference, test::mixed_friction, {});
  CHECK(later.body_a == scene.contacts.body_a);
  CHECK(later.body_b == scene.contacts.body_b);
}

TEST_CASE_TEMPLATE("impulses follow their two bodies from list to list", Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  test::ContactScene<Dim> scene(Dim == 2 ? 12 : 6);
  test::RandomNumbers random(3);
  std::map<std::pair<int, int>, Vec<Dim>> kept;
  for (int c = 0; c < scene.contacts.size(); ++c) {
    Vec<Dim>& p = scene.contacts.impulse[c];
    p = random.vector<Dim>(1);
    p[0] = random.uniform(0.1, 1);
    kept[{scene.contacts.body_a[c], scene.contacts.body_b[c]}] = p;
  }
  for (Vec<Dim>& v : scene.bodies.velocity) v = random.vector<Dim>(1);
  drift(scene.bodies, 0.1);
  set_reference(scene.reference, scene.bodies);
  const auto next = candidate_contacts(scene.bodies, scene.reference, test::mixed_friction, scene.contacts);
  int carried = 0, fresh = 0;
  for (int c = 0; c < next.size(); ++c) {
    const auto old = kept.find({next.body_a[c], next.body_b[c]});
    CHECK(next.impulse[c] == (old == kept.end() ? Vec<Dim>{} : old->second));
    ++(old == kept.end() ? fresh : carried);
  }
  CHECK(carried > 10);
  CHECK(fresh > 3);
}

TEST_CASE("lists are made again once two bodies may have approached by 90 % of the skin, walls included") {
  auto bodies = test::random_bodies<2>(5, 2);
  const int n = bodies.size();
  NeighbourReference<2> reference{.skin = 2, .position = {}, .wall_point = {}};
  CHECK(is_stale(reference, bodies));  // never made
  const int generation = reference.generation;
  set_reference(reference, bodies);
  CHECK(reference.generation > generation);
  CHECK_FALSE(is_stale(reference, bodies));

  const auto at_rest = bodies;
  const double about = 1 - 1.0 / n;  // displacement of one particle about the mean of its grain
  bodies.position[7] += 0.89 / about * Vec<2>{0.6, 0.8};
  CHECK_FALSE(is_stale(reference, bodies));
  bodies.position[7] = at_rest.position[7] - 0.91 / about * Vec<2>{0.6, 0.8};
  CHECK(is_stale(reference, bodies));

  bodies = at_rest;
  bodies.walls[1].point[1] += 1.79;
  CHECK_FALSE(is_stale(reference, bodies));
  bodies.walls[1].point[1] += 0.02;
  CHECK(is_stale(reference, bodies));
}

TEST_CASE("grains that move as a whole need new lists only when they approach another or go far") {
  // two grains side by side, and a third far away
  auto bodies = rigid_particles<2>({{0, 0}, {2, 0}, {5, 0}, {7, 0}, {100, 0}, {102, 0}}, {1, 1, 1, 1, 1, 1},
                                   {1, 1, 1, 1, 1, 1}, {});
  bodies.grain = {0, 0, 1, 1, 2, 2};
  NeighbourReference<2> reference{.skin = 0.5, .position = {}, .wall_point = {}};
  set_reference(reference, bodies);
  const auto shifted = [&](std::initializer_list<int> particles, const Vec<2>& by) {
    auto moved = bodies;
    for (const int i : particles) moved.position[i] += by;
    return is_stale(reference, moved);
  };
  CHECK_FALSE(shifted({0, 1}, {0.44, 0}));
  CHECK(shifted({0, 1}, {0.46, 0}));
  CHECK_FALSE(shifted({0, 1, 2, 3}, {0, 1.9}));  // both alike
  auto facing = bodies;  // two primaries that approach each other, each out of the middle of its grain
  facing.position[1][0] += 0.3;
  facing.position[2][0] -= 0.3;
  CHECK(is_stale(reference, facing));
  facing.position[2][0] += 0.2;
  CHECK_FALSE(is_stale(reference, facing));
  CHECK_FALSE(shifted({4, 5}, {-1.9, 0}));  // nobody is near
  CHECK(shifted({4, 5}, {-2.1, 0}));        // but somebody might be now
  CHECK(shifted({0, 1, 2, 3, 4, 5}, {0, 2.1}));
}

TEST_CASE("only the lists that need it are made again, each from its own reference") {
  // three grains of two, in a row
  auto bodies = rigid_particles<2>({{0, 0}, {2, 0}, {4.6, 0}, {6.6, 0}, {9.2, 0}, {11.2, 0}},
                                   {1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}, {});
  bodies.grain = {0, 0, 1, 1, 2, 2};
  NeighbourReference<2> reference{.skin = 1, .position = {}, .wall_point = {}};
  CHECK(renew_stale_lists(reference, bodies));  // never made
  CHECK(reference.made == std::vector{1, 1, 1, 1});
  CHECK_FALSE(renew_stale_lists(reference, bodies));

  const auto start = bodies.position;
  const auto stretch = [&](int grain, double by) {  // each primary goes by / 2
    bodies.position[2 * grain][1] += by / 2, bodies.position[2 * grain + 1][1] -= by / 2;
  };
  stretch(0, 0.88);  // 2 d = 0.88 < 0.9
  stretch(1, 0.46);  // more than half way, 0.45
  stretch(2, 0.44);
  bodies.position[4][1] -= 0.44, bodies.position[5][1] += 0.44;  // and half back
  CHECK_FALSE(renew_stale_lists(reference, bodies));
  stretch(0, 0.04);
  CHECK(renew_stale_lists(reference, bodies));
  CHECK(reference.made[0] == 2);
  CHECK(reference.made[1] == 2);
  CHECK(reference.made[2] == 1);
  for (const int i : {0, 1, 2, 3}) CHECK(reference.position[i] == bodies.position[i]);
  for (const int i : {4, 5}) CHECK(reference.position[i] == start[i]);

  // a shift of a whole grain asks for the pairs between grains alone
  const std::vector<Vec<2>> inside = reference.position;
  for (const int i : {4, 5}) bodies.position[i][0] -= 1;
  CHECK(renew_stale_lists(reference, bodies));
  CHECK(reference.made == std::vector{2, 2, 1, 3});
  CHECK(reference.position == inside);
  CHECK(reference.between == bodies.position);
}

TEST_CASE_TEMPLATE("lists that are kept hold the same contacts, impulses and order as when made again",
                   Dimension, Plane, Space) {
  constexpr int Dim = Dimension::value;
  auto bodies = six_grains<Dim>();
  const int size = bodies.size() / 6;
  NeighbourReference<Dim> reference{.skin = 0.2, .position = {}, .wall_point = {}};
  set_reference(reference, bodies);
  auto old = candidate_contacts(bodies, reference, test::mixed_friction, {});
  test::RandomNumbers random(5);
  for (Vec<Dim>& p : old.impulse) p = random.vector<Dim>(1), p[0] = random.uniform(0.1, 1);
  for (int i = 2 * size; i < 3 * size; ++i) bodies.position[i] += random.vector<Dim>(0.3);
  REQUIRE(renew_stale_lists(reference, bodies));
  REQUIRE(reference.made[2] == 2);
  REQUIRE(reference.made[1] == 1);

  const auto kept = candidate_contacts(bodies, reference, test::mixed_friction, old);
  auto other = old;
  for (ContactBlock& block : other.blocks) block.made = -1;  // nothing to take over
  const auto fresh = candidate_contacts(bodies, reference, test::mixed_friction, other);
  CHECK(kept.body_a == fresh.body_a);
  CHECK(kept.body_b == fresh.body_b);
  CHECK(kept.inverse_mass_a == fresh.inverse_mass_a);
  CHECK(kept.inverse_mass_b == fresh.inverse_mass_b);
  CHECK(kept.inverse_delassus == fresh.inverse_delassus);
  CHECK(kept.friction == fresh.friction);
  CHECK((kept.impulse == fresh.impulse));
  REQUIRE(kept.blocks.size() == fresh.blocks.size());
  for (std::size_t k = 0; k < kept.blocks.size(); ++k) {
    CHECK(kept.blocks[k].list == fresh.blocks[k].list);
    CHECK(kept.blocks[k].made == fresh.blocks[k].made);
    CHECK(kept.blocks[k].frictionless.fours_end == fresh.blocks[k].frictionless.fours_end);
    CHECK(kept.blocks[k].frictional.begin == fresh.blocks[k].frictional.begin);
    CHECK(kept.blocks[k].end() == fresh.blocks[k].end());
  }
}

TEST_CASE("gaps and normals lead from a to b, and from a particle into its wall") {
  auto bodies = rigid_particles<2>({{0, 0}, {3, 4}}, {1, 2}, {1, 1},
                                   {{.point = {9, -1.5}, .normal = {0, 1}, .velocity = {}}});
  NeighbourReference<2> reference{.skin = 2.5, .position = {}, .wall_point = {}};
  set_reference(reference, bodies);
  auto contacts = candidate_contacts<2>(bodies, reference, [](int, int) { return 0.0; }, {});
  detect_contacts(bodies, contacts);
  REQUIRE(contacts.size() == 2);
  const int pair = contacts.body_b[0] == 1 ? 0 : 1, wall = 1 - pair;
  CHECK(contacts.gap[pair] == doctest::Approx(2).epsilon(1e-15));
  CHECK(contacts.normal[pair][0] == doctest::Approx(0.6).epsilon(1e-15));
  CHECK(contacts.normal[pair][1] == doctest::Approx(0.8).epsilon(1e-15));
  CHECK(contacts.body_b[wall] == bodies.wall_body(0));
  CHECK(contacts.gap[wall] == doctest::Approx(0.5).epsilon(1e-15));
  CHECK(contacts.normal[wall] == Vec<2>{0, -1});
}
