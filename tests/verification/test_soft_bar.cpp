#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

// Acary's bar of steel; with nu = 0 its waves have the speed sqrt(E/rho), whatever its width
constexpr double E = 210e9, rho = 7800, L = 1, width = 0.1, speed = 0.1;
const double contact_time = 2 * L * std::sqrt(rho / E);  // a wave there and back

/// The bar along x from the origin, `cells` by two, in units of L.
std::shared_ptr<const Topology> bar(int cells) {
  constexpr int across = 2;
  ReferenceGrid grid;
  std::vector<int> number((cells + 1) * (across + 1));
  const auto at = [&](int i, int j) -> int& { return number[j * (cells + 1) + i]; };
  const auto add = [&](int i, int j) {
    at(i, j) = grid.nodes();
    grid.node.push_back({static_cast<double>(i) / cells, width * (static_cast<double>(j) / across - 0.5)});
  };
  for (int i = 1; i < cells; ++i)
    for (int j = 1; j < across; ++j) add(i, j);
  grid.outline_begin = grid.nodes();
  for (int i = 0; i < cells; ++i) add(i, 0);
  for (int j = 0; j < across; ++j) add(cells, j);
  for (int i = cells; i > 0; --i) add(i, across);
  for (int j = across; j > 0; --j) add(0, j);
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < across; ++j)
      grid.cell.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return std::make_shared<const Topology>(grid);
}

struct Impact {
  double duration = 0;  // until the last impulse of the wall, over 2 L/c
  double lost = 0;      // of the energy
  double velocity = 0;  // of the centre of mass afterwards, over the speed before
};

/// Throws the bar at a wall; `courant` is the time step over the time that a wave needs across a cell.
template <class Dynamics, class Options>
Impact throw_bar(int cells, double courant, const Options& options) {
  Dynamics dynamics(
      {{test::placed(bar(cells), L, {0, 0}, {-speed, 0})}, make_law(MaterialLaw::neo_hookean, E, 0), rho},
      {{.point = {0, 0}, .normal = {1, 0}, .velocity = {}}}, options);
  const double dt = courant * contact_time / (2 * cells), start = dynamics.grains.kinetic_energy();
  Impact impact;
  for (int k = 1; k * dt < 1.3 * contact_time; ++k)
    if (dynamics.step(dt).contacts > 0) impact.duration = k * dt / contact_time;
  const double elastic = elastic_energy(dynamics.grains, dynamics.grains.batches[0])[0];
  impact.lost = 1 - (dynamics.grains.kinetic_energy() + elastic) / start;
  impact.velocity = dynamics.grains.momentum()[0] / (dynamics.grains.mass(0) * speed);
  return impact;
}

/// An impact, and a row of the table in experiments/diametral_mpm.
template <class Dynamics, class Options>
Impact shown(const std::string& integrator, int cells, double courant, const Options& options) {
  const Impact i = throw_bar<Dynamics>(cells, courant, options);
  MESSAGE("bar: integrator=", integrator, " cells=", cells, " courant=", courant, " duration=", i.duration,
          " lost=", i.lost, " velocity=", i.velocity);
  return i;
}

// the bar moves by 1e-8 of its length in a step
const ExplicitOptions tight_explicit{.solver = {.max_sweeps = 200, .tolerance = 1e-14}};
const ImplicitOptions tight_implicit{.tolerance = 1e-13};

}  // namespace

TEST_CASE("an elastic bar on a wall stays 2 L/c, and the energy lost at impact goes to zero with the cells") {
  for (const int cells : {25, 50, 100, 200}) {
    const Impact i = shown<ExplicitDynamics>("explicit", cells, 0.5, tight_explicit);
    CHECK(i.duration == doctest::Approx(1).epsilon(0.5 / cells + 0.01));
    CHECK(i.lost == doctest::Approx(0.5 / cells).epsilon(0.15));  // the wall stops half a cell
    CHECK(i.velocity == doctest::Approx(1).epsilon(1.5 / cells));
  }
}

TEST_CASE("an elastic bar on a wall stays 2 L/c by backward Euler, too, and loses less with smaller steps") {
  double last = 1;
  for (const double courant : {0.5, 0.125, 0.03125}) {
    const Impact i = shown<ImplicitDynamics>("implicit", 25, courant, tight_implicit);
    CHECK(i.duration == doctest::Approx(1).epsilon(0.02));
    CHECK(i.lost > 0);
    CHECK(i.lost < 0.65 * last);
    last = i.lost;
  }
}
