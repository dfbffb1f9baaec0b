#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/experiment/sample.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

TEST_CASE("iterations of grains that flow do not run away: no step of a packing is taken back") {
  constexpr double young = 1e7, yield = 1e5, speed = 1, dt = 1e-5, last = 0.25;
  constexpr int count = 16;
  const auto shape = test::disk(6);
  const AnyLaw law =
      make_law(MaterialLaw::von_mises, {.young_modulus = young, .poisson_ratio = 0.3, .yield_stress = yield});
  const BoxSample sample = sample_box({.grains = count});
  std::vector<GrainPlacement> placed;
  for (const PlacedGrain& grain : sample.grains)
    placed.push_back(test::placed(shape, grain.radius, grain.centre, {}, grain.angle));
  ImplicitDynamics dynamics(SoftGrains(std::move(placed), law, 1000), test::box_walls(sample.width, speed),
                            ImplicitOptions{});
  const int steps = static_cast<int>(sample.width * (1 - std::exp(-last)) / (speed * dt));
  int rejected = 0, iterations = 0;
  for (int k = 0; k < steps; ++k) {
    const SoftStepReport report = dynamics.step(dt);
    rejected += report.rejected;
    iterations += report.iterations;
  }
  MESSAGE("iterations a step: " << iterations / static_cast<double>(steps) << ", taken back: " << rejected);
  CHECK(rejected == 0);
  CHECK(iterations < 4 * steps);
}
