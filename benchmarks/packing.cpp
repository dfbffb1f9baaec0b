#include "packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "softgrain/math/random.hpp"
#include "softgrain/rigid/rigid_contact_system.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain::bench {
namespace {

enum Stream : std::uint32_t { diameters, jitter, noise };
constexpr std::uint64_t seed = 1;
constexpr double size_ratio = 1.625;
constexpr double skin = 0.15;  // of the mean diameter, as of one bonded grain between walls

double uniform_between(double low, double high, Stream stream, int index) {
  return low + (high - low) * random_uniform(seed, stream, index);
}

/// Walls of a box from the origin to `corner`.
std::vector<Wall<2>> box_walls(const Vec<2>& corner) {
  return {{{0, 0}, {1, 0}, {}}, {{0, 0}, {0, 1}, {}}, {corner, {-1, 0}, {}}, {corner, {0, -1}, {}}};
}
Vec<2> corner(const RigidParticles<2>& particles) { return particles.walls[2].point; }

RigidParticles<2> disks_in_box(std::vector<Vec<2>> position, std::vector<double> radius, const Vec<2>& size) {
  std::vector<double> mass;
  for (const double r : radius) mass.push_back(4 * r * r);
  return rigid_particles<2>(std::move(position), std::move(radius), std::move(mass), box_walls(size));
}

RigidParticles<2> loose_disks(int count) {
  const double smallest = 2 / (1 + size_ratio), largest = size_ratio * smallest, spacing = 1.1 * largest;
  const int columns = static_cast<int>(std::ceil(std::sqrt(count))), rows = (count + columns - 1) / columns;
  std::vector<Vec<2>> position;
  std::vector<double> radius;
  for (int i = 0; i < count; ++i) {
    const auto shift = [&](int k) { return uniform_between(-0.05, 0.05, Stream::jitter, 2 * i + k); };
    position.push_back({spacing * (i % columns + 0.5) + shift(0), spacing * (i / columns + 0.5) + shift(1)});
    radius.push_back(uniform_between(smallest, largest, Stream::diameters, i) / 2);
  }
  return disks_in_box(std::move(position), std::move(radius), {spacing * columns, spacing * rows});
}

/// v = -rate (x - centre), with noise as large as the closing speed of two neighbours.
void compress(RigidParticles<2>& particles, const Vec<2>& centre, double rate, int draw) {
  const int n = particles.size();
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 2; ++k)
      particles.velocity[i][k] = -rate * (particles.position[i][k] - centre[k]) +
                                 uniform_between(-rate, rate, Stream::noise, 2 * (n * draw + i) + k);
}

/// Compresses uniformly, without inertia, until the contacts suffice for rigidity (two per disk), then lets
/// overlaps go.
RigidParticles<2> jammed(RigidParticles<2> loose) {
  constexpr double rate = 2e-4, push_out = 0.5;  // per step
  constexpr int settling_steps = 200;
  RigidDynamics<2> dynamics(
      std::move(loose), [](int, int) { return 0.0; },
      {.solver = {.min_sweeps = 20, .max_sweeps = 20, .relaxation = 1.3}, .law = {.push_out = push_out}},
      0.25);
  RigidParticles<2>& particles = dynamics.particles;
  const ForceField<2> none = [](const RigidParticles<2>&, std::span<Vec<2>>) {};
  const auto step = [&](double compression, int draw) {
    compress(particles, {}, compression, draw);
    set_wall_velocity(particles, 2, {-compression * corner(particles)[0], 0});
    set_wall_velocity(particles, 3, {0, -compression * corner(particles)[1]});
    return dynamics.step(none, 1.0);
  };
  for (int k = 0; step(rate, k).contacts < 2 * particles.size();) ++k;
  for (int k = 0; k < settling_steps; ++k) step(0, 0);
  // both walls' points move along their own normals only
  return disks_in_box(particles.position, particles.radius,
                      {particles.walls[2].point[0], particles.walls[3].point[1]});
}

/// Interleaves the bits of the cell's column and row: neighbours in space become neighbours in memory.
std::uint32_t morton(const Vec<2>& x) {
  std::uint32_t code = 0;
  for (int bit = 0; bit < 16; ++bit)
    for (int k = 0; k < 2; ++k) code |= (static_cast<std::uint32_t>(x[k]) >> bit & 1u) << (2 * bit + k);
  return code;
}

}  // namespace

RigidParticles<2> dense_packing(const PackingSize& size) {
  const RigidParticles<2> box = jammed(loose_disks(size.disks_per_box));
  const Vec<2> edge = corner(box);
  const auto reflected = [](double x, double length, int image) {
    return image % 2 == 0 ? x + image * length : (image + 1) * length - x;
  };
  std::vector<std::pair<Vec<2>, double>> disks;
  for (int row = 0; row < size.rows; ++row)
    for (int column = 0; column < size.columns; ++column) {
      for (int i = 0; i < box.size(); ++i)
        disks.push_back(
            {{reflected(box.position[i][0], edge[0], column), reflected(box.position[i][1], edge[1], row)},
             box.radius[i]});
      std::stable_sort(disks.end() - box.size(), disks.end(),
                       [](const auto& a, const auto& b) { return morton(a.first) < morton(b.first); });
    }
  std::vector<Vec<2>> position;
  std::vector<double> radius;
  for (const auto& [x, r] : disks) position.push_back(x), radius.push_back(r);
  return disks_in_box(std::move(position), std::move(radius), {size.columns * edge[0], size.rows * edge[1]});
}

int ContactProblem::active() const {
  return static_cast<int>(std::ranges::count_if(contacts.impulse, [](const Vec<2>& p) { return p[0] > 0; }));
}

ContactProblem collapse_problem(const PackingSize& size, double mu) {
  constexpr double compression = 1e-2;  // per step: closes the gaps that the packing has left
  ContactProblem problem{.particles = dense_packing(size), .contacts = {}, .offset = {}};
  for (int i = 0; i < size.disks(); ++i) problem.particles.grain[i] = i / size.disks_per_box;
  NeighbourReference<2> reference{.skin = skin, .position = {}, .wall_point = {}};
  set_reference(reference, problem.particles);
  problem.contacts = candidate_contacts(problem.particles, reference, [=](int, int) { return mu; }, {});
  detect_contacts(problem.particles, problem.contacts);
  signorini_offset<2>(problem.contacts, problem.particles.velocity, {}, 1.0, problem.offset);
  const Vec<2> centre = 0.5 * corner(problem.particles);
  compress(problem.particles, centre, compression, 0);
  return problem;
}

void warm_up(ContactProblem& problem, int sweeps) {
  RigidContactSystem<2> system(problem.particles, problem.contacts, problem.offset);
  for (int k = 0; k < sweeps; ++k) system.sweep(problem.contacts.impulse, problem.contacts.friction, {});
}

FullProblem full_problem(const ContactProblem& problem) {
  const RigidContacts<2>& contacts = problem.contacts;
  const int m = contacts.size(), n = problem.particles.size();
  std::vector<std::vector<int>> of_disk(n);
  for (int c = 0; c < m; ++c)
    for (const int body : {contacts.body_a[c], contacts.body_b[c]})
      if (body < n) of_disk[body].push_back(c);

  // H of contact c, seen by a disk: columns of (v_x, v_y, s) by rows of (u_n, u_t)
  struct Columns {
    Vec<3> normal, tangential;
  };
  const auto columns = [&](int c, int disk) {
    const double side = contacts.body_a[c] == disk ? -1 : 1;
    const Vec<2> normal = contacts.normal[c], t = perpendicular(normal);
    return Columns{{side * normal[0], side * normal[1], 0}, {side * t[0], side * t[1], -1}};
  };
  FullProblem full;
  for (int disk = 0; disk < n; ++disk) {
    const double inverse_mass = problem.particles.inverse_mass[disk];
    const double inverse_inertia = problem.particles.inertia_ratio * inverse_mass;  // s = R omega
    const auto product = [&](const Vec<3>& a, const Vec<3>& b) {
      return inverse_mass * (a[0] * b[0] + a[1] * b[1]) + inverse_inertia * a[2] * b[2];
    };
    for (const int c : of_disk[disk])
      for (const int d : of_disk[disk]) {
        const Columns H_c = columns(c, disk), H_d = columns(d, disk);
        full.W.push_back({2 * c, 2 * d, product(H_c.normal, H_d.normal)});
        full.W.push_back({2 * c, 2 * d + 1, product(H_c.normal, H_d.tangential)});
        full.W.push_back({2 * c + 1, 2 * d, product(H_c.tangential, H_d.normal)});
        full.W.push_back({2 * c + 1, 2 * d + 1, product(H_c.tangential, H_d.tangential)});
      }
  }
  RigidParticles<2> particles = problem.particles;
  const RigidContactSystem<2> system(particles, contacts, problem.offset);
  for (int c = 0; c < m; ++c) full.q.push_back(system.relative_velocity(c));
  return full;
}

}  // namespace softgrain::bench
