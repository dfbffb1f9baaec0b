#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

/// Sulsky, Chen & Schreyer 1994: two disks fly at each other along the diagonal, at +-0.1 m/s along both
/// axes. Here they start close.
SoftGrains two_disks(int cells = 8, double v = 0.1) {
  constexpr double R = 0.2;
  const auto shape = test::disk(cells);
  return {{test::placed(shape, R, {0.5 - 0.15, 0.5 - 0.15}, {v, v}),
           test::placed(shape, R, {0.5 + 0.15, 0.5 + 0.15}, {-v, -v})},
          make_law(MaterialLaw::neo_hookean, 1000, 0.3),
          1000};
}

/// Smallest distance of a vertex of one outline to an edge of the other.
double distance_of(const SoftGrains& grains) {
  std::vector<Vec<2>> x;
  grains.gather_outline(x);
  double least = std::numeric_limits<double>::infinity();
  for (const int a : {0, 1}) {
    const int b = 1 - a, begin = grains.outline_begin(b), end = grains.outline_end(b);
    for (int v = grains.outline_begin(a); v < grains.outline_end(a); ++v)
      for (int w = begin; w < end; ++w) {
        const Vec<2> along = x[w + 1 < end ? w + 1 : begin] - x[w];
        const double share = std::clamp(dot(x[v] - x[w], along) / dot(along, along), 0.0, 1.0);
        least = std::min(least, norm(x[v] - (x[w] + share * along)));
      }
  }
  return least;
}

struct Collision {
  double kinetic = 0;   // of what there was
  double total = 0;     // kinetic and elastic
  double momentum = 0;  // [kg m/s per m]
  double gap = -1;      // when force first acts, in cells
  bool parted = false;
};

template <class Dynamics>
Collision collide(Dynamics dynamics, double dt, double duration) {
  const double start = dynamics.grains.kinetic_energy();
  const double cell = 2 * 3.14159 * 0.2 / dynamics.grains.topology(0).grid.outline_nodes();
  Collision result;
  for (int k = 0; k * dt < duration; ++k)
    if (dynamics.step(dt).contacts > 0 && result.gap < 0) result.gap = distance_of(dynamics.grains) / cell;
  const Wide elastic = elastic_energy(dynamics.grains, dynamics.grains.batches[0]);
  result.kinetic = dynamics.grains.kinetic_energy() / start;
  result.total = result.kinetic + (elastic[0] + elastic[1]) / start;
  result.momentum = norm(dynamics.grains.momentum());
  result.parted = distance_of(dynamics.grains) > 0.02;
  return result;
}

/// A row of the table in experiments/diametral_mpm.
void show(const std::string& integrator, int cells, double v, double dt, const Collision& c) {
  MESSAGE("collision: integrator=", integrator, " cells=", cells, " v=", v, " dt_ms=", 1e3 * dt,
          " kinetic=", c.kinetic, " total=", c.total, " momentum=", c.momentum, " gap=", c.gap);
}

/// A square on a plane tilted by `slope` [rad]: velocity down the plane after 0.1 s.
double slide(double slope, double mu) {
  constexpr double g = 9.81, side = 0.01;
  ImplicitDynamics dynamics(
      {{test::placed(test::square(3), side, {0, side / 2})},
       make_law(MaterialLaw::neo_hookean, 1e6, 0.3),
       1000},
      {test::floor_at(0)},
      {.tolerance = 1e-6, .wall_friction = mu, .gravity = {g * std::sin(slope), -g * std::cos(slope)}});
  for (int k = 0; k < 100; ++k) dynamics.step(1e-3);
  return dynamics.grains.momentum()[0] / dynamics.grains.mass(0);
}

}  // namespace

TEST_CASE("two soft disks collide and part: no early contact, and the motion comes back") {
  for (const int cells : {8, 16})
    for (const double safety : {0.4, 0.1}) {
      const double dt = stable_time_step(two_disks(cells), safety);
      const Collision c = collide(ExplicitDynamics(two_disks(cells), {}, {}), dt, 1.6);
      show("explicit", cells, 0.1, dt, c);
      CHECK(c.parted);
      CHECK(c.momentum < 1e-13);
      CHECK(c.gap >= 0);
      CHECK(c.gap < 0.1);
      CHECK(c.total > 0.98);
      CHECK(c.total < 1.001);
      CHECK(c.kinetic > 0.8);  // the rest vibrates: they met at a quarter of the speed of sound
    }
}

TEST_CASE("two soft disks that meet slowly hardly vibrate: 98 % of the motion comes back") {
  constexpr double v = 0.0125;
  const double dt = stable_time_step(two_disks(), 0.4);
  const Collision c = collide(ExplicitDynamics(two_disks(8, v), {}, {}), dt, 1.6 * 0.1 / v);
  show("explicit", 8, v, dt, c);
  CHECK(c.parted);
  CHECK(c.kinetic > 0.98);
  CHECK(c.total < 1.001);
}

TEST_CASE("what backward Euler loses in a collision goes to zero with the step") {
  double last = 1;
  for (const double dt : {0.04, 0.02, 0.01}) {
    const Collision c = collide(ImplicitDynamics(two_disks(), {}, {}), dt, 1.6);
    show("implicit", 8, 0.1, dt, c);
    CHECK(c.parted);
    CHECK(1 - c.total < 0.75 * last);
    last = 1 - c.total;
  }
}

TEST_CASE(
    "a block on an incline sticks below the angle of friction and slides with g (sin a - mu cos a) above") {
  constexpr double mu = 0.5, limit = 0.4636476090008061;
  CHECK(std::abs(slide(limit - 0.05, mu)) < 1e-4);
  for (const double slope : {limit + 0.05, limit + 0.2}) {
    const double v = 0.1 * 9.81 * (std::sin(slope) - mu * std::cos(slope));
    CHECK(slide(slope, mu) == doctest::Approx(v).epsilon(0.02));
  }
}

TEST_CASE("a column of three soft blocks carries its weight at the bottom, and that of two above the first") {
  constexpr double g = 9.81, rho = 1000, dt = 1e-2;
  const auto shape = test::square(3);
  const std::array<double, 3> side{0.01, 0.008, 0.006};
  std::vector<GrainPlacement> placed;
  double height = 0;
  for (const double a : side) {
    placed.push_back(test::placed(shape, a, {0, height + a / 2}));
    height += a;
  }
  ImplicitDynamics dynamics({placed, make_law(MaterialLaw::neo_hookean, 1e5, 0.3), rho}, {test::floor_at(0)},
                            {.tolerance = 1e-6, .friction = 0.5, .wall_friction = 0.5, .gravity = {0, -g}});
  for (int k = 0; k < 100; ++k) dynamics.step(dt);
  const auto weight_from = [&](int first) {
    double sum = 0;
    for (int k = first; k < 3; ++k) sum += rho * g * side[k] * side[k];
    return sum;
  };
  CHECK(-dynamics.wall_impulse(0)[1] / dt == doctest::Approx(weight_from(0)).epsilon(0.01));
  for (const int below : {0, 1}) {
    double carried = 0;
    for (std::size_t c = 0; c < dynamics.contacts.size(); ++c) {
      const OutlineContact& contact = dynamics.contacts[c];
      if (contact.wall >= 0) continue;
      const int slave = dynamics.grains.grain_of_vertex(contact.vertex);
      const int master = dynamics.grains.grain_of_vertex(contact.master[0]);
      if (std::min(slave, master) != below) continue;
      const double force = impulse_vector(contact, dynamics.impulse[c])[1] / dt;
      carried += slave > master ? force : -force;
    }
    CHECK(carried == doctest::Approx(weight_from(below + 1)).epsilon(0.01));
  }
}

TEST_CASE("a stressed grain that is carried across ten cells keeps its stress: it has its own grid") {
  SoftGrains grains({test::placed(test::disk(8), 1, {0, 0})}, make_law(MaterialLaw::neo_hookean, 1, 0.45), 1);
  test::move_nodes(grains, [](int, const Vec<2>& x) {
    return Vec<2>{1.2 * x[0] + 0.1 * x[1] * x[1], 0.8 * x[1]};
  });
  const auto before = point_states(grains, 0);
  for (int step = 0; step < 100; ++step)
    test::move_nodes(grains, [](int, const Vec<2>& x) {
      return x + Vec<2>{0.0117, 0.0231};
    });  // 0.12 R a cell
  const auto after = point_states(grains, 0);
  double worst = 0, largest = 0;
  for (std::size_t p = 0; p < before.size(); ++p)
    for (std::size_t k = 0; k < 4; ++k) {
      worst = std::max(worst, std::abs(after[p].stress.c[k] - before[p].stress.c[k]));
      largest = std::max(largest, std::abs(before[p].stress.c[k]));
    }
  CHECK(largest > 0.1);
  CHECK(worst < 1e-12);
}

TEST_CASE("a free grain keeps its spin and the energy of it, in implicit steps too") {
  constexpr double R = 1e-3, omega = 300, dt = 1e-4;  // 0.03 rad a step: backward Euler loses 1e-3 of it
  SoftGrains grains({test::placed(test::disk(4), R, {0, 0}, {1, 0})},
                    make_law(MaterialLaw::neo_hookean, 1e7, 0.3), 1000);
  for (GrainBatch& batch : grains.batches)
    for (std::size_t i = 0; i < batch.position.size(); ++i) {
      const Vec<2, Wide> x = batch.position[i];
      batch.velocity[i] += Vec<2, Wide>{Wide(-omega) * x[1], Wide(omega) * x[0]};
    }
  ImplicitDynamics dynamics(std::move(grains), {}, {.quasi_static_from = 1e3, .inertia_of_at_most = 1e3});
  const auto spin = [&] {  // about the origin, through which no centre line leads astray: it flies along x
    double L = 0;
    for (int i = 0; i < dynamics.grains.topology(0).grid.nodes(); ++i) {
      const GrainBatch& batch = dynamics.grains.batches[0];
      const double m = dynamics.grains.node_mass(batch, i)[0];
      L += m * (batch.position[i][0][0] * batch.velocity[i][1][0] -
                batch.position[i][1][0] * batch.velocity[i][0][0]);
    }
    return L;
  };
  const double L = spin(), energy = dynamics.grains.kinetic_energy();
  for (int k = 0; k < 200; ++k) dynamics.step(dt);
  CHECK(spin() == doctest::Approx(L).epsilon(1e-3));
  const WorkBudget& work = dynamics.work;
  const double kinetic = dynamics.grains.kinetic_energy();
  CHECK(kinetic == doctest::Approx(energy).epsilon(2e-3));
  CHECK(std::abs(energy - kinetic - work.internal - work.inertia) < 1e-3 * energy);
}

TEST_CASE("an implicit step that moves a grain by more than half its radius is divided, and arrives") {
  constexpr double R = 1e-3, speed = 2;
  ImplicitDynamics dynamics({{test::placed(test::disk(4), R, {0, 0}, {speed, 0})},
                             make_law(MaterialLaw::neo_hookean, 1e7, 0.45),
                             990},
                            {}, {});
  const double dt = 2 * R / speed;
  const SoftStepReport report = dynamics.step(dt);
  CHECK(report.rejected >= 1);
  const Vec<2> x = dynamics.grains.node_position(0, 0);
  ImplicitDynamics start(
      {{test::placed(test::disk(4), R, {0, 0})}, make_law(MaterialLaw::neo_hookean, 1e7, 0.45), 990}, {}, {});
  CHECK(x[0] - start.grains.node_position(0, 0)[0] == doctest::Approx(2 * R).epsilon(1e-9));
}
