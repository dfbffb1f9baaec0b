#include "softgrain/soft/contact_strips.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/soft/lumped_contacts.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

/// Square lattice of disks that touch, on a floor; all vertices are moved, and move, at random.
struct Packing {
  Packing() : grains(placed_grains(), make_law(MaterialLaw::neo_hookean, 1, 0.3), 1) {
    grains.gather_outline(outline.position);
    test::RandomNumbers random(5);
    for (Vec<2>& x : outline.position) x += random.vector<2>(0.01);
    outline.start = outline.position;
    outline.walls = {test::floor_at(-1)};
    outline.dt = 0.1;
    contacts = OutlineNeighbours().detect(grains, outline);
    for (int v = 0; v < grains.outline_size(); ++v) {
      velocity.push_back(random.vector<2>(1));
      inverse_mass.push_back(random.uniform(1, 3));
    }
  }
  static std::vector<GrainPlacement> placed_grains() {
    const auto shape = test::disk(6);
    std::vector<GrainPlacement> placed;
    for (int g = 0; g < 60; ++g) placed.push_back(test::placed(shape, 1, {2.0 * (g % 4), 2.0 * (g / 4)}));
    return placed;
  }
  SoftGrains grains;
  OutlineState outline;
  std::vector<OutlineContact> contacts;
  std::vector<Vec<2>> velocity;
  std::vector<double> inverse_mass;
};

std::set<int> vertices_of(const Packing& packing, const ContactStrips& strips, int strip) {
  std::set<int> vertices;
  for (int k = strips.begin[strip]; k < strips.begin[strip + 1]; ++k) {
    const OutlineContact& c = packing.contacts[strips.order[k]];
    vertices.insert(c.vertex);
    if (c.wall < 0) vertices.insert(c.master.begin(), c.master.end());
  }
  return vertices;
}

/// The contacts of a system in another order, without its own sweep.
struct Reordered {
  LumpedContacts& system;
  std::vector<int> order;
  int size() const { return system.size(); }
  Mat<2> delassus_block(int c) const { return system.delassus_block(order[c]); }
  Vec<2> relative_velocity(int c) const { return system.relative_velocity(order[c]); }
  void apply_impulse(int c, const Vec<2>& dp) { system.apply_impulse(order[c], dp); }
};

}  // namespace

TEST_CASE("strips hold every contact once, and only neighbouring strips share vertices") {
  const Packing packing;
  ContactStrips strips;
  strips.sort(packing.contacts, packing.outline);
  REQUIRE(strips.count() >= 4);
  CHECK(strips.count() < static_cast<int>(packing.contacts.size()) / 64);  // no narrower than contacts reach
  std::vector<int> sorted = strips.order;
  std::ranges::sort(sorted);
  REQUIRE(sorted.size() == packing.contacts.size());
  for (int c = 0; c < static_cast<int>(sorted.size()); ++c) CHECK(sorted[c] == c);
  bool neighbours_share = false;
  for (int a = 0; a < strips.count(); ++a)
    for (int b = a + 1; b < strips.count(); ++b) {
      const std::set<int> in_a = vertices_of(packing, strips, a), in_b = vertices_of(packing, strips, b);
      const bool share = std::ranges::any_of(in_a, [&](int v) { return in_b.contains(v); });
      if (b > a + 1)
        CHECK_FALSE(share);
      else
        neighbours_share = neighbours_share || share;
    }
  CHECK(neighbours_share);
}

TEST_CASE("no contact, or contacts of one place, make one strip") {
  const Packing packing;
  ContactStrips strips;
  strips.sort({}, packing.outline);
  CHECK(strips.count() == 1);
  CHECK(strips.order.empty());
  const std::vector<OutlineContact> same(1000, {.vertex = 7, .wall = 0});
  strips.sort(same, packing.outline);
  CHECK(strips.begin.back() == 1000);
}

TEST_CASE(
    "a sweep of lumped contacts is one of any contact system, in the order of the even strips, then the "
    "odd") {
  Packing packing;
  const std::size_t n = packing.contacts.size();
  REQUIRE(n > 512);  // on threads
  const SolverOptions options{.relaxation = 1.4};
  const std::vector<double> friction(n, 0.3);
  const std::vector<Vec<2>> start = packing.velocity;
  LumpedContacts::Scratch scratch;
  LumpedBodies none;
  LumpedContacts system(packing.contacts, packing.outline, packing.velocity, packing.inverse_mass, none,
                        scratch);
  for (std::size_t c = 0; c < n; ++c)
    CHECK(system.relative_velocity(static_cast<int>(c))[0] ==
          doctest::Approx(packing.contacts[c].gap / packing.outline.dt));
  std::vector<Vec<2>> impulse(n), expected(n);
  Violation by_strips;
  for (int sweep = 0; sweep < 3; ++sweep) by_strips = system.sweep(impulse, friction, options);
  const std::vector<Vec<2>> velocity = packing.velocity;

  packing.velocity = start;
  Reordered reordered{system, {}};
  const ContactStrips& strips = scratch.strips;
  for (const int first : {0, 1})
    for (int s = first; s < strips.count(); s += 2)
      reordered.order.insert(reordered.order.end(), strips.order.begin() + strips.begin[s],
                             strips.order.begin() + strips.begin[s + 1]);
  Violation in_order;
  for (int sweep = 0; sweep < 3; ++sweep)
    in_order = nlgs_sweep<2>(reordered, std::span(expected), friction, options.relaxation);
  CHECK(by_strips.sum_of_squares == doctest::Approx(in_order.sum_of_squares));
  CHECK(by_strips.contacts == in_order.contacts);
  CHECK(by_strips.contacts > 100);
  for (std::size_t c = 0; c < n; ++c) CHECK(norm(impulse[reordered.order[c]] - expected[c]) < 1e-12);
  for (std::size_t v = 0; v < start.size(); ++v) CHECK(norm(velocity[v] - packing.velocity[v]) < 1e-12);

  // and impulses given at once do the same
  packing.velocity = start;
  system.apply_impulses(impulse);
  for (std::size_t v = 0; v < start.size(); ++v) CHECK(norm(velocity[v] - packing.velocity[v]) < 1e-12);
}
