#include "softgrain/rigid/step.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/core/shared_sum.hpp"
#include "softgrain/rigid/contact_blocks.hpp"

namespace softgrain {

template <int Dim>
RigidDynamics<Dim>::RigidDynamics(RigidParticles<Dim> bodies, FrictionRule friction,
                                  RigidStepOptions step_options, double skin)
    : particles(std::move(bodies)), options(step_options), friction_(std::move(friction)) {
  const ContactLaw& law = options.law;
  require(law.restitution >= 0 && law.restitution <= 1, "restitution must be in [0, 1], got {}",
          law.restitution);
  require(law.push_out >= 0 && law.push_out <= 1, "push-out must be in [0, 1], got {}", law.push_out);
  require(
      law.restitution == 0 || law.activation != Activation::anticipated,
      "contact.restitution = {} requires contact.activation = \"closed_at_mid_step\": an anticipated contact "
      "stops the particles before they touch",
      law.restitution);
  require(skin > 0, "skin must be > 0, got {} m", skin);
  reference.skin = skin;
  pressed_.resize(particles.walls.size());
  if (particles.size() > 0)
    mean_radius_ = std::accumulate(particles.radius.begin(), particles.radius.end(), 0.0) / particles.size();
}

template <int Dim>
StepReport RigidDynamics<Dim>::step(const ForceField<Dim>& field, double dt) {
  begin_step(field, dt, dt / 2);
  // gaps and frames at x_m
  const SolverReport solver = solve(dt);  // v+ = v_free + M^-1 H p,  0 <= u_n + q_n _|_ p_n >= 0
  return end_step(solver, dt, dt / 2);
}

template <int Dim>
void RigidDynamics<Dim>::begin_step(const ForceField<Dim>& field, double dt, double lead) {
  take_own_contacts();
  list_pressed_walls();
  for (const Press& press : particles.presses) set_press_speed(particles, press, press.speed);
  drift(particles, lead);  // x_m = x + dt/2 v
  if (renew_stale_lists(reference, particles, [&] { know_all(); })) rebuild_contacts();
  kick(field, dt);  // v_free = v + dt M^-1 F(x_m)
}

template <int Dim>
StepReport RigidDynamics<Dim>::end_step(const SolverReport& solver, double dt, double lead) {
  if (options.precision == Precision::full)
    parallel_for(static_cast<int>(contacts.blocks.size()),
                 [&](int k) { overlaps_[k] = overlaps_of(contacts.blocks[k]); });
  account_work(dt);
  if (options.law.restitution > 0 && work.contact > 0 && friction_work() > 0) temper_restitution(dt);
  drift(particles, dt - lead);  // x = x_m + dt/2 v+
  if (options.law.push_out > 0 && options.law.activation != Activation::anticipated) push_out(dt);
  end_step_of_presses(dt);
  return report(solver);
}

template <int Dim>
void RigidDynamics<Dim>::rebuild_contacts() {
  take_own_contacts();
  RigidContacts<Dim> made =
      candidate_contacts(particles, reference, friction_, contacts, std::move(replaced_));
  replaced_ = std::exchange(contacts, std::move(made));
  if (!reference.shares.alone()) follow_others();
}

/// Contacts with and without friction are listed apart, so that the list is made again.
template <int Dim>
void RigidDynamics<Dim>::set_friction(FrictionRule friction) {
  friction_ = std::move(friction);
  list_between_again();
}

template <int Dim>
void RigidDynamics<Dim>::list_between_again() {
  if (reference.made.empty()) return;
  reference.made.back() = ++reference.generation;
  rebuild_contacts();
}

/// Their contacts are listed apart, so that the list is made again when other walls are pressed.
template <int Dim>
void RigidDynamics<Dim>::list_pressed_walls() {
  std::vector<bool> pressed;
  for (int w = 0; w < static_cast<int>(particles.walls.size()); ++w)
    pressed.push_back(particles.press_share(particles.wall_body(w)) != 0);
  if (pressed == pressed_) return;
  pressed_ = std::move(pressed);
  list_between_again();
}

/// Keeps the velocities of the start.
template <int Dim>
void RigidDynamics<Dim>::kick(const ForceField<Dim>& field, double dt) {
  force_.resize(particles.velocity.size());
  velocity_start_.resize(particles.velocity.size());
  spin_start_.resize(particles.spin.size());
  const Followed& followed = particles.followed;
  followed.for_each_range(particles.size(), [&](int begin, int end) {
    std::fill(force_.begin() + begin, force_.begin() + end, Vec<Dim>{});
  });
  std::fill(force_.begin() + particles.size(), force_.end(), Vec<Dim>{});  // of walls
  field(particles, force_);
  const auto keep = [&](int begin, int end) {
    std::copy(particles.velocity.begin() + begin, particles.velocity.begin() + end,
              velocity_start_.begin() + begin);
    std::copy(particles.spin.begin() + begin, particles.spin.begin() + end, spin_start_.begin() + begin);
  };
  followed.for_each_range(particles.size(), [&](int begin, int end) {
    keep(begin, end);
    for (int i = begin; i < end; ++i) particles.velocity[i] += dt * particles.inverse_mass[i] * force_[i];
  });
  keep(particles.size(), static_cast<int>(particles.velocity.size()));
}

/// Gaps, frames, offsets and warm start of the contacts begin .. end - 1.
template <int Dim>
void RigidDynamics<Dim>::prepare(int begin, int end, double dt) {
  detect_contacts(particles, begin, end, contacts);
  signorini_offset<Dim>(contacts, velocity_start_, options.law, dt, begin,
                        std::span(offset_).subspan(begin, end - begin));
  if (options.law.activation != Activation::anticipated)
    for (int c = begin; c < end; ++c)
      if (offset_[c] == inactive_offset) contacts.impulse[c] = {};
}

template <int Dim>
SolverReport RigidDynamics<Dim>::solve(double dt) {
  SolverOptions solver = options.solver;
  if (solver.velocity_scale == 0) solver.velocity_scale = 2 * mean_radius_ / dt;
  for (const Press& press : particles.presses) set_press_speed(particles, press, press.speed);
  RigidContactSystem<Dim> system = contact_system(dt);
  if (options.precision == Precision::single) return solve_in_single_precision(system, solver, dt);
  PushedBodies pressed = pressed_walls(dt);
  system.push(pressed);
  system.apply_impulses(contacts.impulse);
  const SolverReport report = solve_nlgs<Dim>(system, contacts.impulse, contacts.friction, solver);
  move_presses(dt);
  return report;
}

/// In single precision the sweeps prepare the contacts, block by block.
template <int Dim>
RigidContactSystem<Dim> RigidDynamics<Dim>::contact_system(double dt) {
  offset_.resize(contacts.size());
  overlaps_.resize(contacts.blocks.size());
  contacts.cell = particles.cell;
  if (options.precision == Precision::full)
    parallel_ranges(contacts.size(), [&](int begin, int end) { prepare(begin, end, dt); });
  return {particles, contacts, offset_};
}

/// (grains + 1) of each grain.
template <int Dim>
std::vector<int> RigidDynamics<Dim>::first_particles() const {
  std::vector<int> first;
  for (const GrainRange& grain : reference.grains) first.push_back(grain.begin);
  first.push_back(particles.size());
  return first;
}

/// With v_m = (v + v+)/2, also of a wall: m/2 (v+^2 - v^2) = v_m . (dt F + H p); a wall's share is p against
/// its own velocity.
template <int Dim>
void RigidDynamics<Dim>::account_work(double dt) {
  const auto middle = [&](int body) { return 0.5 * (velocity_start_[body] + particles.velocity[body]); };
  // by the forces, and by all
  const auto add = [&](int begin, int end, Vec<2> part) {
    for (int i = begin; i < end; ++i) {
      const Spin<Dim> spin_middle = 0.5 * (spin_start_[i] + particles.spin[i]);
      part[0] += dt * dot(force_[i], middle(i));
      part[1] += particles.mass[i] *
                 (dot(middle(i), particles.velocity[i] - velocity_start_[i]) +
                  dot(spin_middle, particles.spin[i] - spin_start_[i]) / particles.inertia_ratio);
    }
    return part;
  };
  const auto sum = shared_sum<Vec<2>>(reference.shares, first_particles(), add);
  if (!std::isfinite(sum[1])) throw_not_finite();
  work = {.force = sum[0]};
  add_up_wall_impulses();
  for (int w = 0; w < static_cast<int>(particles.walls.size()); ++w) {
    const int wall = particles.wall_body(w);
    work.force += dt * dot(force_[wall], middle(wall));
    wall_impulse_[w] += dt * force_[wall];
    work.wall -= dot(wall_impulse_[w], middle(wall));
  }
  work.wall += work_of_cell();
  work.contact = sum[1] - work.force - work.wall;
  account_contacts();
}

/// Images go faster than their bodies by (dH/dt) n: -sum P . (dH/dt) n.
template <int Dim>
double RigidDynamics<Dim>::work_of_cell() const {
  double sum = 0;
  for (int c = contacts.first_crossing(); c < contacts.size(); ++c) {
    const Vec<Dim> v = contacts.image_velocity(c);
    sum -= contacts.impulse[c][0] * dot(contacts.normal[c], v);
    const auto t = tangents(contacts.normal[c]);
    for (int k = 1; k < Dim; ++k) sum -= contacts.impulse[c][k] * dot(t[k - 1], v);
  }
  return sum;
}

template <int Dim>
void RigidDynamics<Dim>::add_up_wall_impulses() {
  wall_impulse_.assign(particles.walls.size(), {});
  const int first_wall = particles.wall_body(0);
  for (int c = contacts.blocks.back().begin(); c < contacts.size(); ++c) {
    if (contacts.body_b[c] < first_wall) continue;
    Vec<Dim>& sum = wall_impulse_[contacts.body_b[c] - first_wall];
    sum += contacts.impulse[c][0] * contacts.normal[c];
    const auto t = tangents(contacts.normal[c]);
    for (int k = 1; k < Dim; ++k) sum += contacts.impulse[c][k] * t[k - 1];
  }
}

/// A contact does p . (u + u+)/2.
template <int Dim>
void RigidDynamics<Dim>::account_contacts() {
  for (int c = contacts.blocks.back().begin(); c < contacts.size(); ++c) {
    const Vec<Dim>& p = contacts.impulse[c];
    if (p[0] == 0) continue;
    const Vec<Dim> u = 0.5 * (relative_velocity<Dim>(contacts, c, velocity_start_, spin_start_) +
                              relative_velocity<Dim>(contacts, c, particles.velocity, particles.spin));
    work.between += dot(p, u);
    work.friction += dot(p, u) - p[0] * u[0];
  }
}

/// Names the first particle that is not finite, whichever rank has it.
template <int Dim>
void RigidDynamics<Dim>::throw_not_finite() const {
  const auto broken = [](const auto& v) { return !std::isfinite(dot(v, v)); };
  const auto first_of = [&](int begin, int end) {
    int i = begin;
    while (i < end && !broken(particles.velocity[i]) && !broken(particles.spin[i])) ++i;
    return i;
  };
  std::vector<int> first(reference.grains.size());
  shared_for(
      reference.shares, reference.between_list(),
      [&](int g) { first[g] = first_of(reference.grains[g].begin, reference.grains[g].end); },
      [&](int g, Message& message) { message(first[g]); });
  int particle = particles.size() - 1;
  for (int g = reference.between_list() - 1; g >= 0; --g)
    if (first[g] < reference.grains[g].end) particle = first[g];
  throw NumericalError(
      fmt::format("the velocity of particle {} is not finite; use a smaller time step", particle));
}

template class RigidDynamics<2>;
template class RigidDynamics<3>;

}  // namespace softgrain
