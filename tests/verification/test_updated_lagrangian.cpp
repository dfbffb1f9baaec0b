#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "softgrain/lattice/updated_lagrangian.hpp"

using namespace softgrain;

namespace {

struct Choice {
  std::string name;
  ShapeFunction shape;
  ContactOn contact_on = ContactOn::outline;
};
const Choice choices[] = {
    {"bilinear outline", ShapeFunction::bilinear, ContactOn::outline},
    {"gimp outline", ShapeFunction::gimp, ContactOn::outline},
    {"bspline outline", ShapeFunction::bspline, ContactOn::outline},
    {"bilinear grid_nodes", ShapeFunction::bilinear, ContactOn::grid_nodes},
    {"gimp grid_nodes", ShapeFunction::gimp, ContactOn::grid_nodes},
    {"bspline grid_nodes", ShapeFunction::bspline, ContactOn::grid_nodes},
};

/// A disk of unit radius with cells of 0.118, that vibrates: it starts round, stretching in x and shrinking
/// in y.
UpdatedLagrangianDynamics vibrating(ShapeFunction shape, const Vec<2>& velocity) {
  constexpr double cell = 0.118;
  PointGrain grain = disk_of_points(1, {}, cell, 64);
  for (int p = 0; p < grain.points(); ++p)
    grain.velocity[p] = velocity + 0.1 * Vec<2>{grain.position[p][0], -grain.position[p][1]};
  return {
      {std::move(grain)}, {}, make_law(MaterialLaw::neo_hookean, 1, 0.45), 1, {.shape = shape, .cell = cell}};
}

/// rms difference of the stress of a grain that flies ten cells while it vibrates, from the stress of one
/// that vibrates where it is, over the rms stress of the latter, at the largest stretch.
double stress_noise(ShapeFunction shape) {
  const Vec<2> velocity{0.24, 0.13};
  UpdatedLagrangianDynamics at_rest = vibrating(shape, {}), flying = vibrating(shape, velocity);
  const double dt = stable_time_step(at_rest.law, 1, at_rest.options.cell);
  const std::vector<Vec<2>> start = at_rest.grains[0].position;
  double difference_max = 0, size_max = 0;
  for (double flown = 0; flown < 10 * at_rest.options.cell; flown += velocity[0] * dt) {
    at_rest.step(dt), flying.step(dt);
    double difference = 0, size = 0;
    for (int p = 0; p < at_rest.grains[0].points(); ++p) {
      if (norm(start[p]) > 0.75) continue;
      const Mat<2> a = at_rest.stress(0, p), b = flying.stress(0, p);
      size += at_rest.grains[0].volume[p] * contract(a, a);
      difference += at_rest.grains[0].volume[p] * contract(b - a, b - a);
    }
    difference_max = std::max(difference_max, difference), size_max = std::max(size_max, size);
  }
  return std::sqrt(difference_max / size_max);
}

constexpr double R = 5e-3, E = 1e7, nu = 0.45, rho = 990;

/// Force over E* R at the approaches d/R of the centre to one wall, means over 5 % of d on both sides and
/// over both walls; the top wall comes down at `speed`.
std::vector<double> force_at(const Choice& choice, double cell, double speed,
                             const std::vector<double>& approach) {
  PointGrain grain = disk_of_points(R, {}, cell, 64);
  double reach = 0;
  for (const Vec<2>& x : grain.outline) reach = std::max(reach, x[1]);
  UpdatedLagrangianDynamics dynamics({grain},
                                     {{.point = {0, -reach}, .normal = {0, 1}, .velocity = {}},
                                      {.point = {0, reach}, .normal = {0, -1}, .velocity = {0, -speed}}},
                                     make_law(MaterialLaw::neo_hookean, E, nu), rho,
                                     {.shape = choice.shape, .contact_on = choice.contact_on, .cell = cell});
  const double dt = stable_time_step(dynamics.law, rho, cell);
  std::vector<double> force;
  int step = 0;
  const auto steps_to = [&](double d) { return static_cast<int>(2 * d * R / (speed * dt)); };
  for (const double d : approach) {
    while (step < steps_to(0.95 * d)) dynamics.step(dt), ++step;
    double impulse = 0, time = 0;
    for (; step < steps_to(1.05 * d); ++step, time += dt) {
      dynamics.step(dt);
      impulse += (dynamics.wall_impulse(1)[1] - dynamics.wall_impulse(0)[1]) / 2;
    }
    force.push_back(impulse / time * (1 - nu * nu) / (E * R));
  }
  return force;
}

/// Distance of a wall from a grain at rest when force first acts, in cells; the grain lies `offset` cells
/// above a node.
double first_force(const Choice& choice, double offset, double wall_reach = -1) {
  const double cell = 0.118 * R;
  PointGrain grain = disk_of_points(R, {0, offset * cell}, cell, 64);
  const double top = offset * cell + R, dt = 1e-9, speed = 0.01 * cell / dt;
  UpdatedLagrangianDynamics dynamics(
      {grain}, {{.point = {0, top + 3 * cell}, .normal = {0, -1}, .velocity = {0, -speed}}},
      make_law(MaterialLaw::neo_hookean, E, nu), rho,
      {.shape = choice.shape, .contact_on = choice.contact_on, .cell = cell, .wall_reach = wall_reach});
  while (dynamics.step(dt).contacts == 0)
    if (dynamics.box.walls[0].point[1] < top) break;
  return (dynamics.box.walls[0].point[1] - top) / cell;
}

/// Least and largest over ten places of the grain on the lattice.
std::pair<double, double> gap_range(const Choice& choice, double wall_reach = -1) {
  double least = 10, largest = -10;
  for (int k = 0; k < 10; ++k) {
    const double gap = first_force(choice, 0.1 * k, wall_reach);
    least = std::min(least, gap), largest = std::max(largest, gap);
  }
  return {least, largest};
}

}  // namespace

TEST_CASE("a vibrating grain of points that flies across ten cells feels them: smoother shapes, less noise") {
  const double bilinear = stress_noise(ShapeFunction::bilinear), gimp = stress_noise(ShapeFunction::gimp),
               bspline = stress_noise(ShapeFunction::bspline);
  MESSAGE("stress noise: bilinear ", bilinear, ", gimp ", gimp, ", bspline ", bspline);
  CHECK(gimp < 0.6 * bilinear);
  CHECK(bspline < 0.3 * bilinear);
}

TEST_CASE("the force of a wall begins at the outline, on nodes one to two cells early") {
  for (const Choice& choice : choices) {
    CAPTURE(choice.name);
    const auto [least, largest] = gap_range(choice);
    MESSAGE("first force: ", choice.name, " ", least, " ", largest);
    if (choice.contact_on == ContactOn::outline) {
      CHECK(std::abs(least) < 0.02);
      CHECK(std::abs(largest) < 0.02);
    } else {
      // grain and wall reach a node from both sides, points a quarter of a cell below their surfaces
      const double reach = 2 * (support(choice.shape) - point_side / 2);
      CHECK(least == doctest::Approx(reach - 0.75).epsilon(0.15));
      CHECK(largest == doctest::Approx(reach + 0.15).epsilon(0.15));
    }
  }
  const auto [least, largest] = gap_range(choices[3], 0);
  MESSAGE("first force: bilinear nodes_in_the_wall ", least, " ", largest);
  CHECK(least >= 0);
  CHECK(largest < 1);
}

TEST_CASE(
    "a grain of points between walls: smooth shapes with outlines are right, bilinear lags, nodes lead") {
  const std::vector<double> approach{0.05, 0.1, 0.2, 0.3},
      reference{.03168, .07839, .21604, .43801};  // converged finite elements
  for (const Choice& choice : choices) {
    CAPTURE(choice.name);
    const auto force = force_at(choice, 0.118 * R, 0.5, approach);
    std::vector<double> error;
    for (std::size_t k = 0; k < force.size(); ++k) error.push_back(force[k] / reference[k] - 1);
    if (choice.contact_on == ContactOn::grid_nodes) {
      CHECK(error[0] > 0.7);
      CHECK(error[3] > 0.1);
      CHECK(error[3] < 0.5 * error[0]);
    } else if (choice.shape == ShapeFunction::bilinear) {
      CHECK(error[3] < -0.05);
      CHECK(error[3] > -0.2);
    } else {
      for (const double e : error) CHECK(std::abs(e) < 0.06);
    }
  }
}
