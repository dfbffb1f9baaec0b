#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "softgrain/soft/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, E = 1e7, nu = 0.3, rho = 1000;

/// E/(1 - nu^2) of plane strain.
double plane(double modulus) { return modulus / (1 - nu * nu); }

/// Grains on top of one another, pressed by the top wall: the force, and how much nearer the centres of mass
/// have come, from the bottom wall up to the top one [m].
struct Pile {
  double top = 0, bottom = 0;
  std::vector<double> approach;
};

double height_of(const SoftGrains& grains, int grain) {
  double mass = 0, first = 0;
  const auto [batch, lane] = grains.batch_of(grain);
  for (int i = 0; i < grains.topology(grain).grid.nodes(); ++i) {
    const double m = grains.node_mass(*batch, i)[lane];
    mass += m;
    first += m * grains.node_position(grain, i)[1];
  }
  return first / mass;
}

/// moduli: of each grain, from below. The wall comes down by `way` in so many steps.
Pile press(const std::vector<double>& moduli, double way, int steps) {
  const auto shape = test::disk(16);
  std::vector<GrainPlacement> placed;
  std::vector<GrainMaterial> materials;
  for (int k = 0; k < static_cast<int>(moduli.size()); ++k) {
    placed.push_back(test::placed(shape, R, {0, (2 * k + 1) * R}));
    placed.back().kind = k;
    materials.push_back({make_law(MaterialLaw::hencky, moduli[k], nu), rho});
  }
  const double height = 2 * R * static_cast<double>(moduli.size()), speed = 0.02, dt = way / steps / speed;
  ImplicitDynamics dynamics(
      {std::move(placed), std::move(materials)},
      {test::floor_at(0), {.point = {0, height}, .normal = {0, -1}, .velocity = {0, -speed}}},
      {.tolerance = 1e-7});
  std::vector<double> start;
  for (int g = 0; g < dynamics.grains.size(); ++g) start.push_back(height_of(dynamics.grains, g));
  for (int k = 0; k < steps; ++k) dynamics.step(dt);
  Pile pile{
      .top = dynamics.wall_impulse(1)[1] / dt, .bottom = -dynamics.wall_impulse(0)[1] / dt, .approach = {}};
  double below = 0;
  for (int g = 0; g < dynamics.grains.size(); ++g) {
    const double sunk = start[g] - height_of(dynamics.grains, g);
    pile.approach.push_back(sunk - below);
    below = sunk;
  }
  pile.approach.push_back(way - below);
  return pile;
}

/// How much nearer the centre of a disk comes to a contact of half-width a (Johnson, Contact
/// Mechanics, 5.56).
double johnson(double F, double modulus, double a) {
  return F / (std::numbers::pi * plane(modulus)) * (2 * std::log(4 * R / a) - 1);
}
/// a^2 = 4 F R*/(pi E*)
double half_width(double F, double radius, double contact_modulus) {
  return std::sqrt(4 * F * radius / (std::numbers::pi * contact_modulus));
}
/// Of two disks of radius R whose moduli differ.
double between(double F, double one, double other) {
  const double a = half_width(F, R / 2, 1 / (1 / plane(one) + 1 / plane(other)));
  return johnson(F, one, a) + johnson(F, other, a);
}
double at_wall(double F, double modulus) { return johnson(F, modulus, half_width(F, R, plane(modulus))); }

}  // namespace

TEST_CASE(
    "two grains of different stiffness in series bear one force, and each contact gives way as Johnson "
    "says") {
  const Pile pile = press({E, 5 * E}, 0.03 * R, 30);
  const double F = pile.top;
  CHECK(pile.bottom == doctest::Approx(F).epsilon(5e-3));  // the grains still move
  CHECK(pile.approach[0] == doctest::Approx(at_wall(F, E)).epsilon(0.03));
  CHECK(pile.approach[1] == doctest::Approx(between(F, E, 5 * E)).epsilon(0.03));
  CHECK(pile.approach[2] == doctest::Approx(at_wall(F, 5 * E)).epsilon(0.05));
}

TEST_CASE("two grains touch as two equal ones whose compliance is the mean of theirs") {
  const Pile unlike = press({E, 5 * E}, 0.03 * R, 30);
  // 1/E* = (1 - nu^2)/E1 + (1 - nu^2)/E2 = 2 (1 - nu^2)/E
  const double equivalent = 2 / (1 / E + 1 / (5 * E));
  const Pile alike = press({equivalent, equivalent}, 0.03 * R, 30);
  // Johnson's law leads from the force of one run to that of the other
  const double by_law = between(unlike.top, E, 5 * E) / between(alike.top, equivalent, equivalent);
  CHECK(unlike.approach[1] / alike.approach[1] == doctest::Approx(by_law).epsilon(0.01));
}

TEST_CASE("between two far stiffer grains a soft one is pressed as by rigid disks") {
  double before = 1;
  for (const double ratio : {10.0, 100.0, 1000.0}) {
    CAPTURE(ratio);
    const Pile pile = press({ratio * E, E, ratio * E}, 0.06 * R, 30);
    const double F = pile.top;
    const double rigid = johnson(F, E, half_width(F, R / 2, plane(E)));  // of a disk on a rigid one
    const double excess = (pile.approach[1] + pile.approach[2]) / 2 / rigid - 1;
    CHECK(pile.approach[1] == doctest::Approx(pile.approach[2]).epsilon(0.01));
    CHECK(excess < before);
    before = excess;
  }
  CHECK(std::abs(before) < 0.01);
}

TEST_CASE("identical materials that are declared as two kinds press as one kind") {
  const auto press_pair = [](int kinds) {
    const auto shape = test::disk(8);
    std::vector<GrainPlacement> placed;
    for (int g = 0; g < 4; ++g) {
      placed.push_back(test::placed(shape, R, {(1 + 2 * (g % 2)) * R, (1 + 2 * (g / 2)) * R}, {}, 0.3 * g));
      placed.back().kind = g % kinds;
    }
    const std::vector<GrainMaterial> materials(kinds, {make_law(MaterialLaw::neo_hookean, E, nu), rho});
    ImplicitDynamics dynamics({std::move(placed), materials}, test::box_walls(4 * R, 1),
                              {.tolerance = 1e-8, .friction = 0.3, .wall_friction = 0.2});
    for (int k = 0; k < 40; ++k) dynamics.step(1e-5);
    return std::pair(dynamics.wall_impulse(1)[1] / 1e-5, height_of(dynamics.grains, 2));
  };
  const auto [one_force, one_height] = press_pair(1);
  const auto [two_force, two_height] = press_pair(2);
  CHECK(one_force > 0.05 * E * R);
  CHECK(two_force == doctest::Approx(one_force).epsilon(1e-5));
  CHECK(std::abs(two_height - one_height) < 1e-7 * R);
}
