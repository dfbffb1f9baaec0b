#include <algorithm>
#include <cmath>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/rigid/step.hpp"

// What contacts that exist only when closed need beside the solve, so that they make no energy.

namespace softgrain {

template <int Dim>
double RigidDynamics<Dim>::friction_work() const {
  double sum = 0;
  for (int c = 0; c < contacts.size(); ++c) {
    const Vec<Dim>& p = contacts.impulse[c];
    if (contacts.friction[c] == 0 || p[0] == 0) continue;
    const Vec<Dim> u = 0.5 * (relative_velocity<Dim>(contacts, c, velocity_start_, spin_start_) +
                              relative_velocity<Dim>(contacts, c, particles.velocity, particles.spin));
    sum += dot(p, u) - p[0] * u[0];
  }
  return sum;
}

/// Newton's restitution with friction can make energy where contacts meet (Kane & Levinson 1985). Then all
/// of them go back towards the solution without restitution, which makes none, until their work is 0:
///   p = p_0 + s (p_e - p_0),  W(s) = W_0 + s (W_e - W_0 - K) + s^2 K,  K = (v_e - v_0).M (v_e - v_0)/2.
template <int Dim>
void RigidDynamics<Dim>::temper_restitution(double dt) {
  const double W_e = work.contact, e = options.law.restitution;
  const std::vector<Vec<Dim>> v_e = particles.velocity, p_e = contacts.impulse;
  const std::vector<Spin<Dim>> s_e = particles.spin;
  for (int i = 0; i < particles.size(); ++i) {
    particles.velocity[i] = velocity_start_[i] + dt * particles.inverse_mass[i] * force_[i];
    particles.spin[i] = spin_start_[i];
  }
  options.law.restitution = 0;
  solve(dt);
  options.law.restitution = e;
  account_work(dt);
  const double W_0 = work.contact;
  double K = 0;
  for (int i = 0; i < particles.size(); ++i) {
    const Vec<Dim> v = v_e[i] - particles.velocity[i];
    const Spin<Dim> s = s_e[i] - particles.spin[i];
    K += 0.5 * particles.mass[i] * (dot(v, v) + dot(s, s) / particles.inertia_ratio);
  }
  const double b = W_e - W_0 - K;
  const double s = W_0 < 0 && K > 0 ? (-b + std::sqrt(b * b - 4 * K * W_0)) / (2 * K) : 0;
  for (int i = 0; i < particles.size(); ++i) {
    particles.velocity[i] += s * (v_e[i] - particles.velocity[i]);
    particles.spin[i] += s * (s_e[i] - particles.spin[i]);
  }
  for (int c = 0; c < contacts.size(); ++c) contacts.impulse[c] += s * (p_e[c] - contacts.impulse[c]);
  move_presses(dt);
  account_work(dt);
}

/// Moves overlapping particles by dt (v~ - v+), v~ the velocity nearest to v+ with u~_n + beta g/dt >= 0.
/// They keep v+: the way out adds no velocity.
template <int Dim>
void RigidDynamics<Dim>::push_out(double dt) {
  const double rate = options.law.push_out / dt;
  bool any = false;
  for (int c = 0; c < contacts.size(); ++c) {
    offset_[c] = contacts.gap[c] < 0 ? rate * contacts.gap[c] : inactive_offset;
    if (contacts.gap[c] >= 0) continue;
    const Vec<Dim> u = particles.velocity[contacts.body_b[c]] - particles.velocity[contacts.body_a[c]] +
                       contacts.image_velocity(c);
    any = any || dot(contacts.normal[c], u) + offset_[c] < 0;
  }
  if (!any) return;
  velocity_kept_ = particles.velocity;
  pushes_.assign(contacts.size(), {});
  frictionless_.assign(contacts.size(), 0);
  RigidContactSystem<Dim> system(particles, contacts, offset_);
  SolverOptions solver = options.solver;
  if (solver.velocity_scale == 0) solver.velocity_scale = 2 * mean_radius_ / dt;
  solve_nlgs<Dim>(system, std::span(pushes_), frictionless_, solver);
  const auto way = [&](int i) { return dt * (particles.velocity[i] - velocity_kept_[i]); };
  const double price = -parallel_sum<double>(particles.size(), [&](int begin, int end) {
    double part = 0;
    for (int i = begin; i < end; ++i) part += dot(force_[i], way(i));
    return part;
  });
  const double share = price > 0 ? std::clamp(-work.contact / price, 0.0, 1.0) : 1;
  work.push_out = share * price;
  parallel_ranges(particles.size(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) particles.position[i] += share * way(i);
  });
  particles.velocity.swap(velocity_kept_);
}

template double RigidDynamics<2>::friction_work() const;
template double RigidDynamics<3>::friction_work() const;
template void RigidDynamics<2>::temper_restitution(double);
template void RigidDynamics<3>::temper_restitution(double);
template void RigidDynamics<2>::push_out(double);
template void RigidDynamics<3>::push_out(double);

}  // namespace softgrain
