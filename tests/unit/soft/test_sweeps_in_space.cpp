#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <vector>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/soft/contact_strips.hpp"
#include "softgrain/soft/lumped_contacts.hpp"
#include "support/random_numbers.hpp"
#include "support/solid_grains.hpp"

using namespace softgrain;

namespace {

/// Two balls pressed into each other along z, that come together at unit velocity.
struct PressedBalls {
  SolidGrains grains;
  OutlineStateOf<3> state;
  std::vector<SurfaceContact> contacts;
  std::vector<PaddedVec> velocity;
  std::vector<double> inverse_mass;
  LumpedBodiesOf<3> none;
  LumpedSystem<3>::Scratch scratch;

  PressedBalls() : grains(pair()), state() {
    grains.gather_outline(state.position);
    state.start = state.position;
    state.dt = 1;
    contacts = SurfaceNeighbours{}.detect(grains, state, 0.5);
    for (int v = 0; v < grains.outline_size(); ++v) {
      velocity.emplace_back(Vec<3>{0, 0, grains.grain_of_vertex(v) == 0 ? 0.5 : -0.5});
      inverse_mass.push_back(1 + 0.01 * v);
    }
  }
  static SolidGrains pair() {
    const auto shape = test::ball(4);
    return {{{.topology = shape, .radius = 1, .centre = {}, .velocity = {}},
             {.topology = shape,
              .radius = 1,
              .centre = {0, 0, 1.9},
              .angle = test::some_turn(1),
              .velocity = {}}},
            {GrainMaterial{make_law(MaterialLaw::neo_hookean, 1, 0.45), 1}}};
  }
  LumpedSystem<3> system() { return {contacts, state, velocity, inverse_mass, none, scratch}; }
};

}  // namespace

TEST_CASE("velocities go ahead of a sweep as their impulses do") {
  PressedBalls ahead, fresh;
  LumpedSystem<3> system = ahead.system(), other = fresh.system();
  REQUIRE(system.size() > 20);
  test::RandomNumbers random(3);
  std::vector<Vec<3>> first, change, sum;
  for (int c = 0; c < system.size(); ++c) {
    first.push_back(random.vector<3>(1));
    change.push_back(random.vector<3>(1));
    sum.push_back(first.back() + 1.5 * change.back());  // p_2 + 0.5 (p_2 - p_1)
  }
  system.apply_impulses(first);
  system.extrapolate(0);
  system.apply_impulses(change);
  system.extrapolate(0.5);
  other.apply_impulses(sum);
  for (int c = 0; c < system.size(); ++c)
    CHECK(norm(system.relative_velocity(c) - other.relative_velocity(c)) < 1e-11);
}

TEST_CASE("sweeps in space that start ahead find the velocities of those that do not") {
  std::vector<std::vector<PaddedVec>> velocity;
  for (const bool extrapolated : {false, true}) {
    PressedBalls balls;
    LumpedSystem<3> system = balls.system();
    std::vector<Vec<3>> impulse(balls.contacts.size());
    const std::vector<double> friction(balls.contacts.size(), 0.0);
    const SolverReport report = solve_nlgs<3>(
        system, std::span(impulse), friction,
        {.max_sweeps = 5000, .tolerance = 1e-9, .velocity_scale = 1, .extrapolated = extrapolated});
    CHECK(report.converged);
    velocity.push_back(balls.velocity);
  }
  for (std::size_t v = 0; v < velocity[0].size(); ++v) CHECK(norm(velocity[0][v] - velocity[1][v]) < 1e-6);
}

TEST_CASE("rows that are kept give the contacts the gaps that new ones would") {
  PressedBalls balls;
  balls.system();
  test::RandomNumbers random(7);
  for (std::size_t v = 0; v < balls.velocity.size(); ++v) {
    balls.state.start[v] += random.vector<3>(0.01);
    balls.state.position[v] = balls.state.start[v] + balls.state.dt * balls.velocity[v];
  }
  LumpedSystem<3>::Scratch fresh;
  LumpedSystem<3> anew(balls.contacts, balls.state, balls.velocity, balls.inverse_mass, balls.none, fresh);
  balls.scratch.kept = true;
  LumpedSystem<3> kept = balls.system();
  for (int c = 0; c < kept.size(); ++c) {
    CHECK(kept.relative_velocity(c) == anew.relative_velocity(c));
    // u_n is the gap at the end of the step over dt
    const double gap = gap_now(balls.contacts[static_cast<std::size_t>(c)], balls.state);
    CHECK(std::abs(kept.relative_velocity(c)[0] - gap / balls.state.dt) < 1e-12);
  }
}

TEST_CASE("contacts in space that the first sweep finds wide open close when impulses beside them fall") {
  PressedBalls balls;
  for (PaddedVec& v : balls.velocity) v = {};
  LumpedSystem<3> system = balls.system();
  std::vector<Vec<3>> impulse(balls.contacts.size());
  for (std::size_t c = 0; c < impulse.size(); c += 3) impulse[c][0] = 0.5;  // far too much
  system.apply_impulses(impulse);
  int wide = 0;
  for (int c = 0; c < system.size(); ++c)
    wide += impulse[static_cast<std::size_t>(c)][0] == 0 && system.relative_velocity(c)[0] > 0.01;
  REQUIRE(wide > 10);
  const std::vector<double> friction(balls.contacts.size(), 0.0);
  const SolverReport report =
      solve_nlgs<3>(system, std::span(impulse), friction,
                    {.max_sweeps = 20000, .tolerance = 1e-9, .velocity_scale = 1, .extrapolated = true});
  CHECK(report.converged);
  int closed = 0;
  for (int c = 0; c < system.size(); ++c) {  // 0 <= u_n _|_ p_n >= 0
    const double p = impulse[static_cast<std::size_t>(c)][0], u = system.relative_velocity(c)[0];
    CHECK(p >= 0);
    CHECK(u > -1e-6);
    CHECK(p * std::abs(u) < 1e-6);
    closed += c % 3 != 0 && p > 0;
  }
  CHECK(closed > 0);
}

TEST_CASE("weights in single precision still add up to 1") {
  test::RandomNumbers random(11);
  const auto shape = test::ball(4);
  for (const PatchNet& net : shape->patches) {
    const auto weights = patch_weights(net, random.uniform(0, 1), random.uniform(0, 1));
    const PatchWeights narrow = narrow_weights(weights);
    double sum = 0;
    for (std::size_t k = 0; k < 16; ++k) {
      sum += static_cast<double>(narrow[k]);
      CHECK(std::abs(static_cast<double>(narrow[k]) - weights[k]) < 1e-6);
    }
    CHECK(sum == 1);
  }
}

TEST_CASE("strips of contacts in space hold every contact once, and only neighbouring strips share grains") {
  std::vector<SurfaceContact> contacts;
  for (int g = 0; g < 12; ++g)  // a chain, each with 300 points at the next and at a wall
    for (int k = 0; k < 300; ++k)
      contacts.push_back({.point = 300 * g + k,
                          .wall = k % 2 == 0 ? 0 : -1,
                          .grain = g,
                          .facing = k % 2 == 0 || g == 11 ? -1 : g + 1});
  ContactStrips strips;
  strips.sort(contacts);
  REQUIRE(strips.count() >= 4);
  std::vector<std::set<int>> grains(static_cast<std::size_t>(strips.count()));
  std::vector<int> seen(contacts.size());
  for (int s = 0; s < strips.count(); ++s)
    for (int k = strips.begin[s]; k < strips.begin[s + 1]; ++k) {
      const int c = strips.order[k];
      CHECK(strips.place[c] == k);
      ++seen[static_cast<std::size_t>(c)];
      const SurfaceContact& contact = contacts[static_cast<std::size_t>(c)];
      grains[static_cast<std::size_t>(s)].insert(contact.grain);
      if (contact.facing >= 0) grains[static_cast<std::size_t>(s)].insert(contact.facing);
    }
  CHECK(std::count(seen.begin(), seen.end(), 1) == static_cast<std::ptrdiff_t>(contacts.size()));
  for (std::size_t a = 0; a < grains.size(); ++a)
    for (std::size_t b = a + 2; b < grains.size(); ++b)
      for (const int g : grains[a]) CHECK_FALSE(grains[b].contains(g));
}
