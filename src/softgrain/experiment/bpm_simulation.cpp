#include "softgrain/experiment/bpm_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/arrays.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/observe/clusters.hpp"
#include "softgrain/observe/stress.hpp"

namespace softgrain {
namespace {

/// Two primaries of a grain hold together while their gap is below this share of a0 (F > 0.7 F0 for gamma =
/// 7).
constexpr double link_gap = 0.05;

/// Beyond this overlap over the mean radius, in the mean or of one contact, primaries have no solution.
constexpr double largest_mean_overlap = 0.05, largest_overlap = 0.5;

void refuse_overlaps(const StepReport& report) {
  if (report.overlap_mean <= largest_mean_overlap && report.overlap_max <= largest_overlap) return;
  throw NumericalError(fmt::format(
      "primaries overlap by {:.2g} of their radius in the mean, the deepest by {:.2g}, so the contact "
      "problem has no solution; use a smaller time.step or more solver.max_sweeps, or stop at a smaller "
      "loading.max_strain",
      report.overlap_mean, report.overlap_max));
}

/// The first step starts without a guess of the impulses and may take this many times the sweeps.
constexpr int first_step_factor = 200;

}  // namespace

RigidStepOptions rigid_step_options(const Case& c) {
  return {.solver = {.min_sweeps = c.solver.min_sweeps,
                     .max_sweeps = c.solver.max_sweeps,
                     .tolerance = c.solver.tolerance,
                     .relaxation = c.solver.relaxation},
          .law = {.restitution = c.contact.restitution,
                  .push_out = c.contact.push_out,
                  .activation = c.contact.activation},
          .precision = c.solver.precision};
}

BpmSimulation::BpmSimulation(const Case& the_case, std::unique_ptr<PlatePath> path,
                             std::vector<Attraction> laws, RigidParticles<2> particles, FrictionRule friction,
                             double skin)
    : case_(with_bonded_time_step(the_case)),
      drive_(case_.loading, std::move(path), case_.time.step),
      attraction_(std::move(laws)),
      dynamics_(std::move(particles), std::move(friction), rigid_step_options(the_case), skin) {
  height_start_ = plate_distance();
  set_reference(dynamics_.reference, dynamics_.particles);
  dynamics_.rebuild_contacts();
  attraction_.update(dynamics_.particles, dynamics_.reference);
  sums_.energy_start = attraction_.energy(dynamics_.particles);
}

double BpmSimulation::plate_distance() const {
  const auto& walls = dynamics_.particles.walls;
  return walls[top_wall].point[1] - walls[bottom_wall].point[1];
}

StepReport BpmSimulation::step() {
  const double dt = case_.time.step;
  const bool over = finished();  // whoever goes on then has been told why
  const double approach = drive_.approach_speed(step_, height_start_ - plate_distance());
  for (int w = 0; w < static_cast<int>(dynamics_.particles.walls.size()); ++w)
    set_wall_velocity(dynamics_.particles, w, drive_.velocity(dynamics_.particles.walls[w], w, approach));
  dynamics_.options.solver.max_sweeps = case_.solver.max_sweeps * (step_ == 0 ? first_step_factor : 1);
  StepReport report = dynamics_.step(
      [&](const RigidParticles<2>& particles, std::span<Vec<2>> force) {
        attraction_.update(particles, dynamics_.reference);
        attraction_.add_forces(particles, force);
      },
      dt);
  report.residual_limit = dynamics_.options.solver.worst_factor * dynamics_.options.solver.tolerance;
  ++step_;
  const auto& walls = dynamics_.particles.walls;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    wall_impulse_[w] = -dot(dynamics_.wall_impulse(static_cast<int>(w)), walls[w].normal);
    sums_.impulse[w] += wall_impulse_[w];
  }
  sums_.duration += dt;
  sums_.wall_work += dynamics_.work.wall;
  sums_.dissipation -= dynamics_.work.contact + dynamics_.work.push_out;
  sums_.between -= dynamics_.work.between;
  sums_.friction -= dynamics_.work.friction;
  if (!over) refuse_overlaps(report);
  judge(report);
  return report;
}

double BpmSimulation::wall_force(int wall) const {
  return sums_.impulse[wall] / (sums_.duration > 0 ? sums_.duration : case_.time.step);
}

void BpmSimulation::start_new_row() {
  sums_.impulse = {};
  sums_.duration = 0;
}

EnergyBudget BpmSimulation::energy_budget() const {
  return {.wall_work = sums_.wall_work,
          .kinetic = kinetic_energy(dynamics_.particles),  // at rest before the first step
          .stored = attraction_.energy(dynamics_.particles) - sums_.energy_start,
          .dissipation = sums_.dissipation};
}

int BpmSimulation::clusters() const {
  const auto& p = dynamics_.particles;
  std::vector<std::pair<int, int>> links;
  attraction_.for_each_pair([&](int i, int j) {
    const double a0 = p.radius[i] + p.radius[j];
    if (norm(p.position[j] - p.position[i]) < (1 + link_gap) * a0) links.emplace_back(i, j);
  });
  return count_clusters(p.size(), links);
}

std::vector<Quantity> BpmSimulation::row_of(std::vector<Quantity> own) const {
  const auto& particles = dynamics_.particles;
  int contacts = 0, inner = 0;
  for (int c = 0; c < dynamics_.contacts.size(); ++c) {
    if (!(dynamics_.contacts.impulse[c][0] > 0)) continue;
    ++contacts;
    inner += dynamics_.contacts.body_b[c] < particles.size() ? 1 : 0;
  }
  const EnergyBudget energy = energy_budget();
  std::vector<Quantity> row{
      {"step", "", static_cast<double>(step_)},
      {"time", "s", time()},
      {"strain", "", strain()},
      {"leg", "", static_cast<double>(drive_.leg(std::max<std::int64_t>(step_ - 1, 0)))},
      {"wall_height", "m", plate_distance()},
  };
  row.insert(row.end(), own.begin(), own.end());
  const std::vector<Quantity> rest{
      {"contacts", "", static_cast<double>(contacts)},
      {"z_primaries", "", 2.0 * inner / particles.size()},
      {"clusters", "", static_cast<double>(clusters())},
      {"kinetic_energy", "J/m", energy.kinetic},
      {"attraction_energy", "J/m", energy.stored + sums_.energy_start},
      {"wall_work", "J/m", energy.wall_work},
      {"dissipation", "J/m", energy.dissipation},
      {"dissipation_rearrangement", "J/m", energy.dissipation - sums_.between},
      {"dissipation_contact", "J/m", sums_.between},
      {"dissipation_friction", "J/m", sums_.friction},
      {"energy_error", "J/m", energy.error()},
  };
  row.insert(row.end(), rest.begin(), rest.end());
  return row;
}

std::vector<double> BpmSimulation::pressures() const {
  const auto& particles = dynamics_.particles;
  const auto& contacts = dynamics_.contacts;
  const int n = particles.size();
  std::vector<BranchForce> forces;
  for (int c = 0; c < contacts.size(); ++c) {
    if (!(contacts.impulse[c][0] > 0)) continue;
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    const Vec<2>& normal = contacts.normal[c];
    const Vec<2> impulse = contacts.impulse[c][0] * normal + contacts.impulse[c][1] * perpendicular(normal);
    const bool wall = b >= n;
    forces.push_back({.a = a,
                      .b = wall ? -1 : b,
                      .force = (1 / case_.time.step) * impulse,
                      .branch_a = particles.radius[a] * normal,
                      .branch_b = wall ? Vec<2>{} : -particles.radius[b] * normal});
  }
  attraction_.for_each_pair([&](int i, int j) {
    const Vec<2> d = particles.position[j] - particles.position[i];
    const double r = norm(d);
    const double F = attraction_.law(particles.grain[i]).force(r, particles.radius[i] + particles.radius[j]);
    forces.push_back({.a = i, .b = j, .force = (-F / r) * d, .branch_a = 0.5 * d, .branch_b = -0.5 * d});
  });
  // a primary's share of its grain's area, pores included
  std::vector<double> squares(particles.grain.back() + 1, 0), area(n);
  for (int i = 0; i < n; ++i) squares[particles.grain[i]] += particles.radius[i] * particles.radius[i];
  for (int i = 0; i < n; ++i)
    area[i] = grain_area(particles.grain[i]) * particles.radius[i] * particles.radius[i] /
              squares[particles.grain[i]];
  return virial_pressure(forces, area);
}

Scene BpmSimulation::scene() const {
  const auto& particles = dynamics_.particles;
  const auto& contacts = dynamics_.contacts;
  const int n = particles.size();
  std::vector<double> coordination(n, 0), force;
  std::vector<std::int64_t> pairs;
  for (int c = 0; c < contacts.size(); ++c) {
    if (!(contacts.impulse[c][0] > 0)) continue;
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    ++coordination[a];
    if (b < n) ++coordination[b];
    pairs.insert(pairs.end(), {a, b});  // from n on: walls
    force.push_back(contacts.impulse[c][0] / case_.time.step);
  }
  Scene scene;
  scene.particles["position"] = to_array<2>(particles.position);
  scene.particles["velocity"] = to_array<2>(std::span(particles.velocity).first(n));
  scene.particles["radius"] = {1, particles.radius};
  scene.particles["pressure"] = {1, pressures()};
  scene.particles["coordination"] = {1, std::move(coordination)};
  scene.contacts["pair"] = {2, std::move(pairs)};
  scene.contacts["force"] = {1, std::move(force)};
  complete_scene(scene);
  return scene;
}

std::vector<GrainView> BpmSimulation::grains() const {
  const auto& particles = dynamics_.particles;
  std::vector<GrainView> views;
  for (int i = 0; i < particles.size(); ++i) {  // the primaries of a grain lie one after the other
    if (particles.grain[i] == static_cast<int>(views.size()))
      views.push_back({.position = {.begin = particles.position[i].c.data()},
                       .velocity = {.begin = particles.velocity[i].c.data()},
                       .outline = {}});
    views.back().velocity.rows = ++views.back().position.rows;
  }
  return views;
}

Checkpoint BpmSimulation::checkpoint() const {
  const auto& particles = dynamics_.particles;
  Checkpoint state{.step = step_, .time = time(), .arrays = {}};
  state.arrays["position"] = to_array<2>(particles.position);
  state.arrays["velocity"] = to_array<2>(particles.velocity);
  state.arrays["spin"] = to_array<1>(particles.spin);
  state.arrays["contact_impulse"] = to_array<2>(dynamics_.contacts.impulse);
  state.arrays["list_position"] = to_array<2>(dynamics_.reference.position);
  state.arrays["list_between"] = to_array<2>(dynamics_.reference.between);
  state.arrays["list_wall_point"] = to_array<2>(dynamics_.reference.wall_point);
  std::vector<Vec<2>> wall_point;
  for (const Wall<2>& wall : particles.walls) wall_point.push_back(wall.point);
  state.arrays["wall_point"] = to_array<2>(wall_point);
  std::vector<double> sums(sums_.impulse.begin(), sums_.impulse.end());
  sums.insert(sums.end(),
              {sums_.duration, sums_.wall_work, sums_.dissipation, sums_.energy_start, drive_.state.stress,
               static_cast<double>(drive_.state.ended), sums_.between, sums_.friction});
  state.arrays["sums"] = {1, std::move(sums)};
  drive_.save(state);
  return state;
}

void BpmSimulation::restore(const Checkpoint& state) {
  RigidParticles<2>& particles = dynamics_.particles;
  from_array<2>(state, "position", particles.position);
  from_array<2>(state, "velocity", particles.velocity);
  from_array<1>(state, "spin", particles.spin);
  std::vector<Vec<2>> list_position(particles.position.size()), list_wall_point(particles.walls.size());
  from_array<2>(state, "list_position", list_position);
  std::vector<Vec<2>> list_between = list_position;  // 0.1.0 before its release had one reference
  if (state.arrays.contains("list_between")) from_array<2>(state, "list_between", list_between);
  from_array<2>(state, "list_wall_point", list_wall_point);
  std::vector<Vec<2>> wall_point(particles.walls.size());
  from_array<2>(state, "wall_point", wall_point);
  for (std::size_t w = 0; w < wall_point.size(); ++w) particles.walls[w].point = wall_point[w];
  // the lists are a function of the reference, so they come back in the same order
  restore_reference(dynamics_.reference, particles, std::move(list_position), std::move(list_between),
                    std::move(list_wall_point));
  dynamics_.rebuild_contacts();
  detect_contacts(particles, dynamics_.contacts);
  attraction_.update(particles, dynamics_.reference);
  from_array<2>(state, "contact_impulse", dynamics_.contacts.impulse);
  std::vector<Vec<1>> sums(12);
  from_array<1>(state, "sums", sums, 10);  // 0.1.0 before its release did not split the dissipation
  for (std::size_t w = 0; w < 4; ++w) sums_.impulse[w] = sums[w][0];
  sums_.duration = sums[4][0];
  sums_.wall_work = sums[5][0];
  sums_.dissipation = sums[6][0];
  sums_.energy_start = sums[7][0];
  drive_.state.stress = sums[8][0];
  drive_.state.ended = static_cast<WallDrive::End>(sums[9][0]);
  sums_.between = sums[10][0];
  sums_.friction = sums[11][0];
  drive_.restore(state);
  step_ = state.step;
}

}  // namespace softgrain
