#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/geometry/ball.hpp"
#include "support/dimensions.hpp"
#include "support/simulations.hpp"

using namespace softgrain;
using test::Plane;
using test::Space;

namespace {

constexpr double R = 1e-3, density = 1000;

/// A grain of `primaries` primaries of radius R about the origin, and rigid grains.
template <int Dim>
BondedGrainsSetupOf<Dim> bonded_and_rigid(int primaries, const std::vector<Vec<Dim>>& place,
                                          double radius_of_rigid, double density_of_rigid) {
  const auto aggregate = prepare_aggregate<Dim>({.primaries = primaries, .seed = 3});
  std::vector<Vec<Dim>> position = aggregate.position;
  std::vector<double> radius = aggregate.radius, mass;
  for (Vec<Dim>& x : position) x *= R;
  for (double& r : radius) mass.push_back(times_power<Dim>(density * unit_ball<Dim>, r *= R));
  std::vector<int> grain(radius.size(), 0);
  for (const Vec<Dim>& x : place) {
    position.push_back(x);
    radius.push_back(radius_of_rigid);
    mass.push_back(times_power<Dim>(density_of_rigid * unit_ball<Dim>, radius_of_rigid));
    grain.push_back(grain.back() + 1);
  }
  const double a0 = aggregate.mean_distance * R;
  BondedGrainsSetupOf<Dim> setup{
      .particles = rigid_particles<Dim>(std::move(position), std::move(radius), std::move(mass), {}),
      .grain_radius = std::vector<double>(place.size() + 1, radius_of_rigid),
      .laws = std::vector<Attraction>(place.size() + 1),
      .kind = std::vector<int>(place.size() + 1, 0),
      .friction = {.between = 0.3},
      .options = {.solver = {.min_sweeps = 20, .max_sweeps = 500, .tolerance = 1e-9}, .law = {}},
      .skin = 0.2 * a0,
      .density = density,
      .sigma_I = 1e6};
  setup.particles.grain = std::move(grain);
  setup.grain_radius[0] = R;
  setup.laws[0].F0 = times_power<Dim - 1>(1e6, a0);
  return setup;
}

/// I omega, with s = R omega and I = m R^2/kappa.
double spin_momentum(const RigidParticles<2>& p, int i) {
  const Vec<2>&x = p.position[i], &v = p.velocity[i];
  return p.mass[i] * (p.radius[i] / p.inertia_ratio * p.spin[i][0] + x[0] * v[1] - x[1] * v[0]);
}
double spin_momentum(const RigidParticles<3>& p, int i) {
  return (p.mass[i] * p.radius[i] / p.inertia_ratio * p.spin[i] +
          p.mass[i] * cross(p.position[i], p.velocity[i]))[1];
}

template <int Dim>
struct Momenta {
  Vec<Dim> linear;
  double angular = 0;

  explicit Momenta(const RigidParticles<Dim>& p) {
    for (int i = 0; i < p.size(); ++i) {
      linear += p.mass[i] * p.velocity[i];
      angular += spin_momentum(p, i);
    }
  }
};

}  // namespace

TEST_CASE_TEMPLATE(
    "a rigid grain that strikes a bonded one keeps both momenta, and the energy is accounted for", Dimension,
    Plane, Space) {
  constexpr int Dim = Dimension::value;
  Vec<Dim> place;
  place[0] = 0.3 * R, place[Dim - 1] = 2.1 * R;
  auto setup = bonded_and_rigid<Dim>(20, {place}, R, 3 * density);
  setup.particles.velocity[20][Dim - 1] = -4;
  setup.particles.velocity[20][0] = 1;
  const Momenta<Dim> before(setup.particles);
  const double kinetic = kinetic_energy(setup.particles);
  BondedGrainsOf<Dim> grains(std::move(setup));
  Box<Dim> box;
  bool met = false;
  for (int k = 0; k < 2000; ++k) {
    grains.step(box, 0.4e-6);
    met = met || !grains.contacts().empty();
  }
  const RigidParticles<Dim>& p = grains.dynamics().particles;
  const Momenta<Dim> after(p);
  REQUIRE(met);
  CHECK(grains.contacts().empty());                                               // they have parted
  CHECK(std::abs(p.spin[20][0]) + std::abs(p.spin[20][spin_size<Dim> - 1]) > 0);  // it was turned by friction
  CHECK(norm(after.linear - before.linear) < 1e-12 * norm(before.linear));
  CHECK(std::abs(after.angular - before.angular) < 1e-5 * std::abs(before.angular));
  CHECK(std::abs(grains.energies().error + kinetic) < 1e-4 * kinetic);  // its budget begins at rest
  CHECK(grains.energies().kinetic < 0.95 * kinetic);
}

TEST_CASE(
    "among bonded grains a rigid one has the mass and the area of its circle, and its kind's friction") {
  Case c;
  c.experiment.loading = LoadingPath::compaction;
  c.sample.grains = 8;
  c.sample.packing_fraction = 0.5;
  c.bpm.primaries = 30;
  c.contact.friction = 0.2;
  Case::Kind soft = kind_of(c), hard = soft;
  soft.grains = hard.grains = 4;
  hard.model = GrainModel::rigid;
  hard.grain.density = 4000;
  c.kinds = {soft, hard};
  c.pairs = {{.kind = 1, .other = 1, .friction = 0.6}};
  Simulation simulation = test::simulation_of(c);
  const RigidParticles<2>& p = test::bonded(simulation).particles;
  const BoxSample places = sample_box(c);
  REQUIRE(p.size() == 4 * 30 + 4);
  std::vector<int> rigid;
  for (int i = 0; i < p.size(); ++i)
    if (places.grains[p.grain[i]].kind == 1) rigid.push_back(i);
  REQUIRE(rigid.size() == 4);
  for (const int i : rigid) {
    const double R = places.grains[p.grain[i]].radius;
    CHECK(p.radius[i] == R);
    CHECK(std::abs(p.mass[i] / (4000 * unit_ball<2> * R * R) - 1) < 1e-12);
  }
  const auto& contacts = test::bonded(simulation).contacts;
  for (int k = 0; k < contacts.size(); ++k) {
    const int a = contacts.body_a[k], b = contacts.body_b[k];
    if (b >= p.size() || p.grain[a] == p.grain[b]) continue;
    const bool both = std::ranges::count(rigid, a) > 0 && std::ranges::count(rigid, b) > 0;
    CHECK(contacts.friction[k] == (both ? 0.6 : 0.2));
  }
}
