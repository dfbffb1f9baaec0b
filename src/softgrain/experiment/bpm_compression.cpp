#include "softgrain/experiment/bpm_compression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/arrays.hpp"
#include "softgrain/observe/clusters.hpp"
#include "softgrain/observe/stress.hpp"

namespace softgrain {
namespace {

enum WallIndex : int { bottom, top };

/// Two primaries of a grain hold together while their gap is below this share of a0 (F > 0.7 F0 for gamma =
/// 7).
constexpr double link_gap = 0.05;

/// Beyond this mean overlap of the contacts, over the mean radius, the rigid primaries have no solution.
constexpr double largest_overlap = 0.05;

/// The first step starts without a guess of the impulses and may take this many times the sweeps.
constexpr int first_step_factor = 200;

RigidParticles<2> grain_between_plates(const Case& c, const Aggregate& aggregate) {
  std::vector<Vec<2>> position = aggregate.position;
  std::vector<double> radius = aggregate.radius, mass;
  double area = 0;  // of the disks over pi
  for (const double r : radius) area += r * r;
  const double grain_mass = c.grain.density * std::numbers::pi * c.grain.radius * c.grain.radius;
  for (const double r : radius) mass.push_back(grain_mass * r * r / area);
  for (Vec<2>& x : position) x *= c.grain.radius;
  for (double& r : radius) r *= c.grain.radius;
  const double low = -support(position, radius, {0, -1}), high = support(position, radius, {0, 1});
  std::vector<Wall<2>> walls(2);
  walls[bottom] = {.point = {0, low}, .normal = {0, 1}, .velocity = {}};
  walls[top] = {.point = {0, high}, .normal = {0, -1}, .velocity = {}};
  return rigid_particles<2>(std::move(position), std::move(radius), std::move(mass), std::move(walls));
}

double plate_distance(const RigidParticles<2>& particles) {
  return particles.walls[top].point[1] - particles.walls[bottom].point[1];
}

Activation activation_of(const std::string& name) {
  if (name == "closed_at_mid_step") return Activation::closed_at_mid_step;
  require(name == "anticipated", "contact.activation must be 'anticipated' or 'closed_at_mid_step', got '{}'",
          name);
  return Activation::anticipated;
}

RigidStepOptions step_options(const Case& c) {
  return {.solver = {.min_sweeps = c.solver.min_sweeps,
                     .max_sweeps = c.solver.max_sweeps,
                     .tolerance = c.solver.tolerance,
                     .relaxation = c.solver.relaxation},
          .law = {.restitution = c.contact.restitution,
                  .push_out = c.contact.push_out,
                  .activation = activation_of(c.contact.activation)}};
}

FrictionRule friction_rule(const Case& c) {
  const int primaries = c.bpm.primaries;
  const double inner = c.contact.friction, wall = c.contact.wall_friction;
  return [=](int, int b) { return b < primaries ? inner : wall; };
}

}  // namespace

BpmCompression::BpmCompression(const Case& the_case)
    : case_(the_case),
      path_(the_case.loading, the_case.grain.radius, the_case.time.step),
      attraction_({.F0 = the_case.bpm.attraction, .gamma = the_case.bpm.exponent}),
      aggregate_(prepare_aggregate({.primaries = the_case.bpm.primaries,
                                    .size_ratio = the_case.bpm.size_ratio,
                                    .gamma = the_case.bpm.exponent,
                                    .seed = static_cast<std::uint64_t>(the_case.sample.seed)})),
      dynamics_(grain_between_plates(the_case, aggregate_), friction_rule(the_case), step_options(the_case),
                0.15 * aggregate_.mean_distance * the_case.grain.radius) {
  height_start_ = plate_distance(dynamics_.particles);
  set_reference(dynamics_.reference, dynamics_.particles);
  dynamics_.rebuild_contacts();
  attraction_.update(dynamics_.particles, dynamics_.reference);
  sums_.energy_start = attraction_.energy(dynamics_.particles);
}

double BpmCompression::sigma_I() const {
  return case_.bpm.attraction / (aggregate_.mean_distance * case_.grain.radius);
}

StepReport BpmCompression::step() {
  const double dt = case_.time.step;
  set_wall_velocity(dynamics_.particles, top, {0, path_.plate_velocity(step_)});
  dynamics_.options.solver.max_sweeps = case_.solver.max_sweeps * (step_ == 0 ? first_step_factor : 1);
  const StepReport report = dynamics_.step(
      [&](const RigidParticles<2>& particles, std::span<Vec<2>> force) {
        attraction_.update(particles, dynamics_.reference);
        attraction_.add_forces(particles, force);
      },
      dt);
  ++step_;
  if (report.overlap_mean > largest_overlap) {
    throw NumericalError(
        fmt::format("step {}: primaries overlap by {:.2g} of their radius in the mean, so the contact "
                    "problem has no solution; use a "
                    "smaller time.step or more solver.max_sweeps, or stop at a smaller loading.max_strain",
                    step_, report.overlap_mean));
  }
  sums_.force_bottom -= dynamics_.wall_impulse(bottom)[1];
  sums_.force_top += dynamics_.wall_impulse(top)[1];
  sums_.duration += dt;
  sums_.wall_work += dynamics_.work.wall;
  sums_.dissipation -= dynamics_.work.contact;
  return report;
}

double BpmCompression::width() const {
  const auto& p = dynamics_.particles;
  return support(p.position, p.radius, {1, 0}) + support(p.position, p.radius, {-1, 0});
}

int BpmCompression::clusters() const {
  const auto& p = dynamics_.particles;
  std::vector<std::pair<int, int>> links;
  attraction_.for_each_pair([&](int i, int j) {
    const double a0 = p.radius[i] + p.radius[j];
    if (norm(p.position[j] - p.position[i]) < (1 + link_gap) * a0) links.emplace_back(i, j);
  });
  return count_clusters(p.size(), links);
}

std::vector<Quantity> BpmCompression::observe() {
  const auto& particles = dynamics_.particles;
  const double duration = sums_.duration > 0 ? sums_.duration : case_.time.step;
  const double force_bottom = sums_.force_bottom / duration, force_top = sums_.force_top / duration;
  const double height = plate_distance(particles);
  const double kinetic = kinetic_energy(particles), attraction = attraction_.energy(particles);
  int contacts = 0, inner = 0;
  for (int c = 0; c < dynamics_.contacts.size(); ++c) {
    if (!(dynamics_.contacts.impulse[c][0] > 0)) continue;
    ++contacts;
    inner += dynamics_.contacts.body_b[c] < particles.size() ? 1 : 0;
  }
  const double stored = kinetic + attraction - sums_.energy_start;
  std::vector<Quantity> row{
      {"step", "", static_cast<double>(step_)},
      {"time", "s", time()},
      {"strain", "", grain_strain(height_start_ - height, case_.grain.radius)},
      {"leg", "", static_cast<double>(path_.leg(std::max<std::int64_t>(step_ - 1, 0)))},
      {"wall_height", "m", height},
      {"width", "m", width()},
      {"stress_bottom", "Pa", force_bottom / width()},
      {"stress_top", "Pa", force_top / width()},
      {"force_bottom", "N/m", force_bottom},
      {"force_top", "N/m", force_top},
      {"sigma_I", "Pa", sigma_I()},
      {"contacts", "", static_cast<double>(contacts)},
      {"z_primaries", "", 2.0 * inner / particles.size()},
      {"clusters", "", static_cast<double>(clusters())},
      {"kinetic_energy", "J/m", kinetic},
      {"attraction_energy", "J/m", attraction},
      {"wall_work", "J/m", sums_.wall_work},
      {"dissipation", "J/m", sums_.dissipation},
      {"energy_error", "J/m", sums_.wall_work - sums_.dissipation - stored},
  };
  sums_.force_bottom = sums_.force_top = sums_.duration = 0;
  return row;
}

std::vector<BranchForce> BpmCompression::branch_forces() const {
  const auto& particles = dynamics_.particles;
  const auto& contacts = dynamics_.contacts;
  std::vector<BranchForce> forces;
  for (int c = 0; c < contacts.size(); ++c) {
    if (!(contacts.impulse[c][0] > 0)) continue;
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    const Vec<2>& n = contacts.normal[c];
    const Vec<2> impulse = contacts.impulse[c][0] * n + contacts.impulse[c][1] * perpendicular(n);
    const bool wall = b >= particles.size();
    forces.push_back({.a = a,
                      .b = wall ? -1 : b,
                      .force = (1 / case_.time.step) * impulse,
                      .branch_a = particles.radius[a] * n,
                      .branch_b = wall ? Vec<2>{} : -particles.radius[b] * n});
  }
  attraction_.for_each_pair([&](int i, int j) {
    const Vec<2> d = particles.position[j] - particles.position[i];
    const double r = norm(d), F = attraction_.law().force(r, particles.radius[i] + particles.radius[j]);
    forces.push_back({.a = i, .b = j, .force = (-F / r) * d, .branch_a = 0.5 * d, .branch_b = -0.5 * d});
  });
  return forces;
}

Scene BpmCompression::scene() const {
  const auto& particles = dynamics_.particles;
  const auto& contacts = dynamics_.contacts;
  const int n = particles.size();
  // a primary's share of the grain's area, pores included
  double squares = 0;
  for (const double r : particles.radius) squares += r * r;
  std::vector<double> area(n), coordination(n, 0), force;
  for (int i = 0; i < n; ++i)
    area[i] = std::numbers::pi * case_.grain.radius * case_.grain.radius * particles.radius[i] *
              particles.radius[i] / squares;
  std::vector<std::int64_t> pairs;
  for (int c = 0; c < contacts.size(); ++c) {
    if (!(contacts.impulse[c][0] > 0)) continue;
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    ++coordination[a];
    if (b >= n) continue;
    ++coordination[b];
    pairs.insert(pairs.end(), {a, b});
    force.push_back(contacts.impulse[c][0] / case_.time.step);
  }
  Scene scene;
  scene.particles["position"] = to_array<2>(particles.position);
  scene.particles["velocity"] = to_array<2>(std::span(particles.velocity).first(n));
  scene.particles["radius"] = {1, particles.radius};
  scene.particles["pressure"] = {1, virial_pressure(branch_forces(), area)};
  scene.particles["coordination"] = {1, std::move(coordination)};
  scene.contacts["pair"] = {2, std::move(pairs)};
  scene.contacts["force"] = {1, std::move(force)};
  const double reach = 1.1 * case_.grain.radius + width() / 2;
  for (const Wall<2>& wall : particles.walls)
    scene.wall_segments.insert(scene.wall_segments.end(), {-reach, wall.point[1], reach, wall.point[1]});
  return scene;
}

Checkpoint BpmCompression::checkpoint() const {
  const auto& particles = dynamics_.particles;
  Checkpoint state{.step = step_, .time = time(), .arrays = {}};
  state.arrays["position"] = to_array<2>(particles.position);
  state.arrays["velocity"] = to_array<2>(particles.velocity);
  state.arrays["spin"] = to_array<1>(particles.spin);
  state.arrays["contact_impulse"] = to_array<2>(dynamics_.contacts.impulse);
  state.arrays["list_position"] = to_array<2>(dynamics_.reference.position);
  state.arrays["list_wall_point"] = to_array<2>(dynamics_.reference.wall_point);
  std::vector<Vec<2>> wall_point;
  for (const Wall<2>& wall : particles.walls) wall_point.push_back(wall.point);
  state.arrays["wall_point"] = to_array<2>(wall_point);
  state.arrays["sums"] = {1, std::vector<double>{sums_.force_bottom, sums_.force_top, sums_.duration,
                                                 sums_.wall_work, sums_.dissipation, sums_.energy_start}};
  return state;
}

void BpmCompression::restore(const Checkpoint& state) {
  RigidParticles<2>& particles = dynamics_.particles;
  from_array<2>(state, "position", particles.position);
  from_array<2>(state, "velocity", particles.velocity);
  from_array<1>(state, "spin", particles.spin);
  from_array<2>(state, "list_position", dynamics_.reference.position);
  from_array<2>(state, "list_wall_point", dynamics_.reference.wall_point);
  std::vector<Vec<2>> wall_point(particles.walls.size());
  from_array<2>(state, "wall_point", wall_point);
  for (std::size_t w = 0; w < wall_point.size(); ++w) particles.walls[w].point = wall_point[w];
  // the lists are a function of the reference, so they come back in the same order
  ++dynamics_.reference.generation;
  dynamics_.rebuild_contacts();
  detect_contacts(particles, dynamics_.contacts);
  attraction_.update(particles, dynamics_.reference);
  from_array<2>(state, "contact_impulse", dynamics_.contacts.impulse);
  std::vector<Vec<1>> sums(6);
  from_array<1>(state, "sums", sums);
  sums_ = {sums[0][0], sums[1][0], sums[2][0], sums[3][0], sums[4][0], sums[5][0]};
  step_ = state.step;
}

}  // namespace softgrain
