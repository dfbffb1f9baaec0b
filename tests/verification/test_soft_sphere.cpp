#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/program_runs.hpp"
#include "support/solid_grains.hpp"

// One elastic sphere between two frictionless walls, and two spheres on each other, against converged
// axisymmetric solutions of the same law (Q2 and Q4 finite elements, 0.06 % apart): the force over
// E/(1 - nu^2) R^2 at the approach d of the centre to a wall, over R. Hertz's law is no reference: at d/R =
// 0.1 the neo-Hookean sphere is 16 % stiffer.

using namespace softgrain;

namespace {

struct Reference {
  double d, force;
};
const std::vector<Reference> at_45{{.05, .01634}, {.1, .04872}, {.15, .0943},
                                   {.2, .1530},   {.3, .3188},  {.4, .5788}};
const std::vector<Reference> at_30{{.05, .01673}, {.1, .0502}, {.15, .0975},
                                   {.2, .1584},   {.3, .3277}, {.4, .5843}};
const std::vector<Reference> at_49{{.05, .01625}, {.1, .04817}, {.15, .0931},
                                   {.2, .1510},   {.3, .3156},  {.4, .5785}};

/// Below d/R = 0.1 a column of two still swings.
const std::vector<Reference> from_a_tenth(at_45.begin() + 1, at_45.end());

struct Pressed {
  std::vector<double> errors;  ///< of the force at each approach, relative
  double volume = 0;           ///< over that at rest, at the end
  double energy_error = 0;     ///< over the work of the walls
  double momentum = 0;         ///< across the load, at the end
};

/// Columns of `high` grains between two walls, whose mean force is taken; approaches up to `last`, at v c_E.
Pressed press(SolidGrains grains, int columns, int high, double nu, double v, double last,
              const std::vector<Reference>& references) {
  ExplicitStep<3> dynamics(std::move(grains), test::walls_at(-1, 2 * high - 1), {.damping_share = 0.5});
  const double dt = 0.8 * longest_stable_step(dynamics.grains, 0.5), modulus = 1 / (1 - nu * nu);
  const double window = 2.2 * v;  // of d: a period of the slowest vibration
  Pressed pressed;
  double sum = 0, count = 0, time = 0;
  for (auto next = references.begin(); next != references.end() && next->d <= last; time += dt) {
    const double speed = high * v * std::min(1.0, time / 10);
    dynamics.box.walls[0].velocity = {0, 0, speed};
    dynamics.box.walls[1].velocity = {0, 0, -speed};
    dynamics.step(dt);
    const double d = (dynamics.box.walls[0].point[2] + 1) / high;
    if (std::abs(d - next->d) < window) {
      sum += (dynamics.box.impulse[1][2] - dynamics.box.impulse[0][2]) / (2 * dt * columns * modulus);
      count += 1;
    }
    if (d < next->d + window) continue;
    pressed.errors.push_back(sum / count / next->force - 1);
    sum = count = 0;
    ++next;
  }
  std::vector<Vec<3>> outline;
  dynamics.grains.gather_outline(outline);
  const SolidTopology& shape = dynamics.grains.topology(0);
  pressed.volume = measure_surface(shape.patches, outline.data()).volume / shape.volume;
  const WorkBudget& work = dynamics.work;
  pressed.energy_error =
      (work.walls - dynamics.grains.kinetic_energy() - work.internal - work.contacts) / work.walls;
  pressed.momentum = std::hypot(dynamics.grains.momentum()[0], dynamics.grains.momentum()[1]);
  return pressed;
}

Pressed press_one(int n, double nu, double v, double last, const std::vector<Reference>& references) {
  return press(test::balls(n, Wide::size, nu, nu > 0.475), Wide::size, 1, nu, v, last, references);
}

/// Four columns of two. Their grids are symmetric about the load, so that no column gives way to the side:
/// the cube's axis or its diagonal lies along z, and each grain is turned about it by its own angle.
SolidGrains columns_of_two(int n, double nu) {
  const auto shape = test::ball(n);
  const double quarter = std::atan(1.0), tilt = std::acos(1 / std::sqrt(3.0));
  std::vector<PlacementOf<3>> placed;
  for (int k = 0; k < 4; ++k)
    for (int level = 0; level < 2; ++level) {
      const Mat<3> spin = test::turn_in(0, 1, (k < 2 ? 0.45 : 0.2) * (2 * level - 1));
      const Mat<3> diagonal = test::turn_in(0, 2, tilt) * test::turn_in(0, 1, -quarter);
      placed.push_back({.topology = shape,
                        .radius = 1,
                        .centre = {3.5 * k, 0, 2.0 * level},
                        .angle = k % 2 == 0 ? spin : spin * diagonal,
                        .velocity = {}});
    }
  return {std::move(placed), {GrainMaterial{make_law(MaterialLaw::neo_hookean, 1, nu), 1}}};
}

void check_errors(const Pressed& pressed, const std::vector<double>& limits) {
  REQUIRE(pressed.errors.size() == limits.size());
  for (std::size_t k = 0; k < limits.size(); ++k) {
    CAPTURE(k);
    CAPTURE(pressed.errors[k]);
    CHECK(std::abs(pressed.errors[k]) < limits[k]);
  }
}

}  // namespace

TEST_CASE("a coarse elastic sphere between two walls bears the force of the converged solution within 6 %") {
  const Pressed pressed = press_one(4, 0.45, 0.005, 0.2, at_45);
  check_errors(pressed, {.06, .06, .06, .06});
  CHECK(std::abs(pressed.energy_error) < 1e-12);
}

TEST_CASE("two coarse spheres on each other bear what one bears, and gain no momentum") {
  const Pressed pressed = press(columns_of_two(4, 0.45), 4, 2, 0.45, 0.006, 0.15, from_a_tenth);
  check_errors(pressed, {.1, .05});
  CHECK(pressed.momentum < 1e-13);
}

TEST_CASE("finer spheres between two walls meet the converged force, for three Poisson's ratios") {
  if (!test::torture()) return;
  const Pressed six = press_one(6, 0.45, 0.005, 0.4, at_45), eight = press_one(8, 0.45, 0.005, 0.4, at_45);
  check_errors(six, {.1, .05, .05, .05, .05, .05});
  check_errors(eight, {.03, .015, .015, .015, .015, .015});
  check_errors(press_one(6, 0.3, 0.0025, 0.4, at_30), {.1, .05, .05, .05, .05, .05});
  check_errors(press_one(8, 0.3, 0.0025, 0.4, at_30), {.1, .03, .03, .03, .03, .03});
  check_errors(press_one(8, 0.49, 0.005, 0.4, at_49), {.1, .06, .06, .06, .06, .06});
  CHECK(six.volume == doctest::Approx(0.9716).epsilon(0.004));
}

TEST_CASE("two finer spheres on each other bear what one bears within 5 %") {
  if (!test::torture()) return;
  const Pressed pressed = press(columns_of_two(6, 0.45), 4, 2, 0.45, 0.004, 0.2, from_a_tenth);
  check_errors(pressed, {.05, .05, .05});
}
