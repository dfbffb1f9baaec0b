#include <doctest/doctest.h>

#include <span>
#include <vector>

#include "softgrain/contact/nlgs.hpp"
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
