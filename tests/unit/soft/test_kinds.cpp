#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/friction_by_kind.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "softgrain/soft/soft_view.hpp"
#include "softgrain/soft/stable_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3;

std::vector<GrainMaterial> rubber_and_lead() {
  return {
      {make_law(MaterialLaw::neo_hookean, 1e6, 0.3), 1000},
      {make_law(MaterialLaw::von_mises, {.young_modulus = 1e8, .poisson_ratio = 0.3, .yield_stress = 1e5}),
       4000}};
}

/// Grains of kinds 0, 1, 0, 1, ... in a row.
SoftGrains row_of_grains(int count) {
  const auto shape = test::disk(3);
  std::vector<GrainPlacement> placed;
  for (int g = 0; g < count; ++g) {
    placed.push_back(test::placed(shape, R, {2 * g * R, R}));
    placed.back().kind = g % 2;
  }
  return {std::move(placed), rubber_and_lead()};
}

}  // namespace

TEST_CASE("all grains of a batch are of one kind, and weigh what it weighs") {
  const SoftGrains grains = row_of_grains(6);
  CHECK(grains.batches.size() == 2);
  for (const GrainBatch& batch : grains.batches) {
    CHECK(batch.history.empty() == (batch.kind == 0));
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      CHECK(grains.kind(batch.grain[lane]) == batch.kind);
  }
  CHECK(grains.mass(1) == doctest::Approx(4 * grains.mass(0)));
  CHECK(grains.mean_density() == doctest::Approx(2500));
  CHECK(grains.undeformed_area() == doctest::Approx(6 * std::acos(-1) * R * R).epsilon(0.02));
  const auto shape = test::disk(3);
  GrainPlacement stray = test::placed(shape, R, {0, 0});
  stray.kind = 2;
  CHECK_THROWS_WITH_AS(SoftGrains({stray}, rubber_and_lead()), "grain 0: there is no kind 2", UsageError);
}

TEST_CASE("the stable step of a mixture is that of the kind with the fastest waves") {
  const auto shape = test::disk(3);
  const auto step_of = [&](int kind, auto step) {
    return step(SoftGrains({test::placed(shape, R, {0, R})}, {rubber_and_lead()[kind]}));
  };
  const auto quick = [](const SoftGrains& grains) { return stable_time_step(grains); };
  const auto longest = [](const SoftGrains& grains) { return longest_stable_step(grains, 0.5); };
  CHECK(quick(row_of_grains(4)) == step_of(1, quick));
  CHECK(step_of(1, quick) == doctest::Approx(step_of(0, quick) / 5));  // c^2 = M/rho: 100/4
  CHECK(longest(row_of_grains(4)) == doctest::Approx(step_of(1, longest)).epsilon(1e-12));
}

TEST_CASE("named pairs have their own friction, whichever side comes first, others the common one") {
  const std::vector<PairFriction> named{{0, 1, 0.5}, {1, PairFriction::wall, 0.7}};
  const FrictionByKind friction(2, 0.1, 0.2, named);
  CHECK(friction.between(0, 0) == 0.1);
  CHECK(friction.between(0, 1) == 0.5);
  CHECK(friction.between(1, 0) == 0.5);
  CHECK(friction.between(1, 1) == 0.1);
  CHECK(friction.at_walls(0) == 0.2);
  CHECK(friction.at_walls(1) == 0.7);
  CHECK_THROWS_AS(FrictionByKind(2, 0, 0, std::vector<PairFriction>{{0, 2, 0.5}}), UsageError);
  CHECK_THROWS_AS(FrictionByKind(2, 0, 0, std::vector<PairFriction>{{0, 1, -0.5}}), UsageError);
}

namespace {

/// Momentum along the floor that a grain of kind 1 loses over the impulse with which the floor pressed it,
/// while one of kind 0 flies far above.
template <class Dynamics, class Options>
double friction_felt(Options options, double dt, int steps) {
  const auto shape = test::disk(3);
  std::vector<GrainPlacement> placed{test::placed(shape, R, {0, 9 * R}),
                                     test::placed(shape, R, {0, R}, {1, -0.1})};
  placed[1].kind = 1;
  options.wall_friction = 3;
  options.pair_friction = {{1, PairFriction::wall, 0.05}};
  Dynamics dynamics({std::move(placed), rubber_and_lead()}, Box<2>({test::floor_at(0)}), options);
  const double start = dynamics.grains.momentum()[0];
  double pressed = 0;
  for (int k = 0; k < steps; ++k) {
    dynamics.step(dt);
    pressed += std::abs(dynamics.wall_impulse(0)[1]);
  }
  return (start - dynamics.grains.momentum()[0]) / pressed;
}

}  // namespace

TEST_CASE("what slides along a wall loses the friction of its kind times the impulse of the wall") {
  CHECK(friction_felt<ImplicitDynamics>(ImplicitOptions{.tolerance = 1e-8}, 1e-6, 30) ==
        doctest::Approx(0.05).epsilon(1e-6));
  const double dt = stable_time_step(row_of_grains(2));
  CHECK(friction_felt<ExplicitDynamics>(ExplicitOptions{}, dt, static_cast<int>(3e-5 / dt)) ==
        doctest::Approx(0.05).epsilon(1e-6));
}

TEST_CASE("the friction of a point is limited where two walls of a corner pressed it") {
  const auto disk = test::disk(3);
  const SoftGrains grains({test::placed(disk, R, {R, R})}, make_law(MaterialLaw::neo_hookean, 1e7, 0.3),
                          1000);
  const FrictionByKind friction(1, 0.1, 2, {});
  const auto at = [](int vertex, int wall) { return OutlineContact{.vertex = vertex, .wall = wall}; };
  const std::vector<OutlineContact> contacts{at(0, 0), at(0, 2), at(1, 0), at(2, 0), at(2, 1), at(3, 0)};
  const auto with = [&](std::vector<Vec<2>> impulse) {
    return friction.of<2>(grains, contacts, contacts, impulse);
  };
  constexpr double most = FrictionByKind::most_in_corners;
  using Values = std::vector<double>;
  CHECK(with({{1, 0}, {1, 0}, {1, 0}, {1, 0}, {1, 0}, {0, 0}}) == Values{most, most, 2, 2, 2, 2});
  CHECK(with({{1, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 0}, {0, 0}}) == Values(6, 2));
}
