#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/mixed/mixed_grains.hpp"
#include "softgrain/soft/rigid_outline.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, density = 1000, E = 1e6;
constexpr int primaries = 30;

/// A grain of bonded primaries about a place, or (1) a rigid disk.
BondedGrainsSetup bonded_grain(int count, const Vec<2>& centre, std::vector<Wall<2>> walls = {},
                               std::uint64_t seed = 3) {
  AggregateOf<2> aggregate{.position = {{}}, .radius = {1}, .mean_distance = 2};
  if (count > 1) aggregate = prepare_aggregate<2>({.primaries = count, .seed = seed});
  std::vector<Vec<2>> position;
  std::vector<double> radius, mass;
  double filled = 0;
  for (const double r : aggregate.radius) filled += r * r;
  for (const Vec<2>& x : aggregate.position) position.push_back(centre + R * x);
  for (const double r : aggregate.radius) {
    radius.push_back(R * r);
    mass.push_back(density * std::numbers::pi * R * R * r * r / filled);
  }
  const double a0 = R * aggregate.mean_distance;
  BondedGrainsSetup setup{
      .particles =
          rigid_particles<2>(std::move(position), std::move(radius), std::move(mass), std::move(walls)),
      .grain_radius = {R},
      .laws = {Attraction{}},
      .kind = {0},
      .friction = {.between = 0.3, .wall = 0.2},
      .options = {.solver = {.min_sweeps = 20, .max_sweeps = 500, .tolerance = 1e-9, .extrapolated = true},
                  .law = {}},
      .skin = 0.2 * a0,
      .density = density,
      .sigma_I = 1e6};
  setup.particles.grain.assign(setup.particles.position.size(), 0);
  setup.laws[0].F0 = 1e6 * a0;
  return setup;
}

AnyLaw law() { return make_law(MaterialLaw::neo_hookean, test::parameters(E, 0.4)); }

const ExplicitOptions explicit_options{.damping_share = 0.5,
                                       .solver = {.max_sweeps = 2000, .tolerance = 1e-10, .relaxation = 1.4},
                                       .friction = 0.3,
                                       .wall_friction = 0.2};

ExplicitDynamics elastic_disk(double radius, const Vec<2>& centre, const Vec<2>& velocity = {},
                              std::vector<Wall<2>> walls = {}) {
  return {SoftGrains({test::placed(test::disk(6), radius, centre, velocity, 0.1)}, law(), density),
          Box<2>(std::move(walls)), explicit_options};
}

/// Bottom and top, which come together.
std::vector<Wall<2>> closing_walls(double low, double high, double speed) {
  return {{.point = {0, low}, .normal = {0, 1}, .velocity = {0, speed}},
          {.point = {0, high}, .normal = {0, -1}, .velocity = {0, -speed}}};
}

MixedGrains mixed(ExplicitDynamics elastic, BondedGrainsSetup bonded) {
  return MixedGrains({.elastic = std::move(elastic),
                      .bonded = std::move(bonded),
                      .elastic_number = {0},
                      .bonded_number = {1},
                      .kind = {0, 1},
                      .kinds = 2});
}

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Of all grains.
struct Momenta {
  Vec<2> linear;
  double angular = 0;

  explicit Momenta(const MixedGrains& all) {
    const SoftGrains& grains = all.elastic().dynamics().grains;
    linear = grains.momentum();
    const GrainBatch& batch = grains.batches[0];
    for (int i = 0; i < batch.topology->grid.nodes(); ++i)
      angular +=
          grains.node_mass(batch, i)[0] * cross(lane_of(batch.position[i], 0), lane_of(batch.velocity[i], 0));
    const RigidParticles<2>& p = all.bonded().dynamics().particles;
    for (int i = 0; i < p.size(); ++i) {
      linear += p.mass[i] * p.velocity[i];
      angular +=
          p.mass[i] * (p.radius[i] / p.inertia_ratio * p.spin[i][0] + cross(p.position[i], p.velocity[i]));
    }
  }
};

}  // namespace

namespace {

/// What an oblique impact with friction, in steps of dt, changes and should not, over what there was.
struct Impact {
  double momentum = 0, angular_momentum = 0, energy = 0;
  Energies end;
};
Impact impact(double dt) {
  BondedGrainsSetup setup = bonded_grain(primaries, {0.4 * R, 2.05 * R});
  for (int i = 0; i < primaries; ++i) setup.particles.velocity[i] = {0.5, -2};
  MixedGrains grains = mixed(elastic_disk(R, {0, 0}, {0.1, 0.3}), std::move(setup));
  const Momenta before(grains);
  const double kinetic = grains.energies().kinetic;
  Box<2> box;
  bool met = false;
  for (int k = 0; k < static_cast<int>(1.2e-3 / dt); ++k) {
    REQUIRE(grains.step(box, dt).converged);
    met = met || !grains.contacts().empty();
  }
  REQUIRE(met);
  REQUIRE(grains.contacts().empty());  // they have parted
  const Momenta after(grains);
  Impact impact{.momentum = norm(after.linear - before.linear) / norm(before.linear),
                .angular_momentum = std::abs(after.angular / before.angular - 1),
                .energy = std::abs(grains.energies().error / kinetic + 1),  // its budget begins at rest
                .end = grains.energies()};
  impact.end.kinetic /= kinetic;
  return impact;
}

}  // namespace

TEST_CASE("a bonded grain that strikes an elastic one keeps both momenta, and the energy is accounted for") {
  const Impact coarse = impact(0.4e-6), fine = impact(0.1e-6);
  for (const Impact& each : {coarse, fine}) {
    CHECK(each.momentum < 1e-12);
    CHECK(each.energy < 1e-5);
    CHECK(each.end.kinetic < 0.9);
    CHECK(each.end.friction > 0);
    CHECK(each.end.contact > each.end.friction);
  }
  CHECK(coarse.angular_momentum < 1e-3);
  CHECK(fine.angular_momentum < coarse.angular_momentum / 3);  // of the first order
}

TEST_CASE("bonded grains under the joint step bear what they bear in their own model") {
  const double dt = 0.3e-6, speed = 0.2;
  const int steps = 3000;                 // to 0.18 of the diameter
  double joint_force = 0, own_force = 0;  // of one grain they differ by 17 %
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    BondedGrainsSetup setup = bonded_grain(primaries, {}, {}, seed);
    double low = 0, high = 0;
    for (int i = 0; i < primaries; ++i) {
      low = std::min(low, setup.particles.position[i][1] - setup.particles.radius[i]);
      high = std::max(high, setup.particles.position[i][1] + setup.particles.radius[i]);
    }
    const std::vector<Wall<2>> walls = closing_walls(low, high, speed);
    setup = bonded_grain(primaries, {}, walls, seed);
    BondedGrains alone(setup);
    MixedGrains grains = mixed(elastic_disk(0.4 * R, {10 * R, 0}, {}, walls), std::move(setup));
    Box<2> box(walls), box_alone(walls);
    double joint = 0, own = 0;
    for (int k = 0; k < steps; ++k) {
      grains.step(box, dt);
      alone.step(box_alone, dt);
      joint += box.impulse[1][1] / (steps * dt);
      own += box_alone.impulse[1][1] / (steps * dt);
    }
    const Energies energies = grains.energies();
    CHECK(std::abs(energies.error) < 1e-3 * energies.wall_work);
    joint_force += joint / 12;
    own_force += own / 12;
  }
  CHECK(own_force > 0);
  CHECK(std::abs(joint_force / own_force - 1) < 0.05);
}

TEST_CASE("an elastic grain under the joint step bears what it bears in its own model") {
  const double dt = 0.5e-6, speed = 0.5, half = 1.2 * R;
  const std::vector<Wall<2>> walls = closing_walls(-half, half, speed);
  ExplicitDynamics alone = elastic_disk(half, {}, {}, walls);
  MixedGrains grains = mixed(elastic_disk(half, {}, {}, walls), bonded_grain(primaries, {10 * R, 0}, walls));
  Box<2> box(walls);
  double furthest = 0, largest = 0;
  for (int k = 0; k < 600; ++k) {
    grains.step(box, dt);
    alone.step(dt);
    furthest = std::max(furthest, norm(box.impulse[1] - alone.wall_impulse(1)));
    largest = std::max(largest, norm(alone.wall_impulse(1)));
  }
  CHECK(furthest < 1e-6 * largest);
}

TEST_CASE("a rigid disk presses an elastic one as it does as an outline of the elastic engine") {
  const double dt = 0.5e-6, speed = 1;
  const std::vector<Wall<2>> walls{{.point = {0, 0}, .normal = {0, 1}, .velocity = {}},
                                   {.point = {0, 4 * R}, .normal = {0, -1}, .velocity = {0, -speed}}};
  MixedGrains grains = mixed(elastic_disk(R, {0, R}, {}, walls), bonded_grain(1, {0, 3 * R}, walls));
  const auto rigid = std::make_shared<const Topology>(rigid_disk(64));
  GrainPlacement upper = test::placed(rigid, R, {0, 3 * R});
  upper.kind = 1;
  ExplicitDynamics outlines(SoftGrains({test::placed(test::disk(6), R, {0, R}, {}, 0.1), upper},
                                       {{law(), density}, {.law = {}, .density = density, .rigid = true}}),
                            Box<2>(walls), explicit_options);
  Box<2> box(walls);
  double force = 0, of_outlines = 0;
  for (int k = 0; k < 600; ++k) {  // to 0.15 of the diameter
    grains.step(box, dt);
    outlines.step(dt);
    if (k < 500) continue;
    force -= box.impulse[0][1] / (100 * dt);
    of_outlines -= outlines.wall_impulse(0)[1] / (100 * dt);
  }
  CHECK(of_outlines > 0);
  CHECK(std::abs(force / of_outlines - 1) < 0.01);
  CHECK(grains.energies().contact > 0);
}

TEST_CASE("a press lies on an elastic and on a bonded grain with the force that it keeps") {
  const double dt = 0.3e-6, F = 0.1 * E * R;
  Box<2> box({{.point = {0, 0}, .normal = {0, 1}, .velocity = {}},
              {.point = {0, 2.1 * R}, .normal = {0, -1}, .velocity = {}}});
  box.presses = {{.share = {0, 1}, .force = F, .most = 1}};
  const PressBody body = critically_damped(density, std::sqrt(10 * E / density), 2 * R, dt);
  box.presses[0].mass = body.mass * 2 * R;
  box.presses[0].damper = body.damper * 2 * R;
  MixedGrains grains =
      mixed(elastic_disk(R, {0, R}, {}, box.walls), bonded_grain(primaries, {3 * R, R}, box.walls));
  double top = 0, bottom = 0, momentum = 0;
  const int steps = 8000, last = 2000;
  for (int k = 0; k < steps; ++k) {
    if (k == steps - last) momentum = Momenta(grains).linear[1];
    grains.step(box, dt);
    if (k < steps - last) continue;
    top += box.outward_impulse(1);
    bottom += box.outward_impulse(0);
  }
  CHECK(std::abs(top / (last * dt * F) - 1) < 0.01);
  CHECK(std::abs(box.presses[0].mean_force / F - 1) < 0.05);
  CHECK(std::abs(bottom - top - (Momenta(grains).linear[1] - momentum)) < 1e-9 * top);  // they still ring
  double on_bonded = 0, on_elastic = 0;
  for (const ContactPoint& point : grains.contacts())
    if (point.b == wall_index(1)) (point.a == 1 ? on_bonded : on_elastic) += dot(point.force, point.normal);
  CHECK(on_bonded > 0.05 * F);
  CHECK(on_elastic > 0.05 * F);
  const Energies energies = grains.energies();
  CHECK(std::abs(energies.error) < 1e-3 * energies.wall_work);
}

namespace {

/// Both grains in a cell of 8 R, whose lattice vectors change; `moved`: the bonded one is an image of the
/// other's neighbour. Velocities and their energies after they have met.
struct InCell {
  Momenta momenta;
  Energies energies;
  std::size_t images = 0;
};
InCell met_in_cell(const Vec<2>& moved, const Mat<2>& rate) {
  BondedGrainsSetup setup = bonded_grain(primaries, Vec<2>{0.4 * R, 2.05 * R} + moved);
  for (int i = 0; i < primaries; ++i) setup.particles.velocity[i] = {0.5, -2};
  Box<2> box;
  box.cell.repeats = {true, true};
  box.cell.edges = {{8 * R, 0, 0, 8 * R}};
  box.cell.rate = rate;
  setup.particles.cell = box.cell;
  ExplicitDynamics elastic = elastic_disk(R, {0, 0}, {0.1, 0.3});
  elastic.box.cell = box.cell;
  MixedGrains grains = mixed(std::move(elastic), std::move(setup));
  std::size_t images = 0;
  for (int k = 0; k < 1500; ++k) {
    grains.step(box, 0.4e-6);
    for (const ContactPoint& point : grains.contacts()) images += norm(point.image) > 0 ? 1 : 0;
  }
  return {Momenta(grains), grains.energies(), images};
}

}  // namespace

TEST_CASE("a bonded and an elastic grain meet across the edge of a cell as they do within") {
  const Vec<2> across{0, -8 * R};
  for (const Mat<2>& rate : {Mat<2>{}, Mat<2>{{-0.2, 0.3, 0, -0.4}}}) {
    const bool deforms = !(rate == Mat<2>{});
    const InCell within = met_in_cell({}, rate), crossing = met_in_cell(across, rate);
    CHECK(within.images == 0);
    CHECK(crossing.images > 0);
    const double kinetic = within.energies.kinetic;
    CHECK(std::abs(within.energies.error / crossing.energies.error - 1) < 1e-4);
    if (!deforms) {
      CHECK(norm(within.momenta.linear - crossing.momenta.linear) < 1e-12 * norm(within.momenta.linear));
      CHECK(std::abs(crossing.energies.kinetic / kinetic - 1) < 1e-6);
      CHECK(crossing.energies.wall_work == 0);
    } else {
      CHECK(std::abs(crossing.energies.wall_work) > 1e-3 * kinetic);  // the image goes with the cell
    }
  }
}
