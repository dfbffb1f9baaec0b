#include <algorithm>
#include <cmath>

#include "softgrain/contact/assemble.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/contact_work.hpp"
#include "softgrain/soft/implicit_step.hpp"

namespace softgrain {
namespace {

/// In a slow step the outline of a grain that touches others turns at most so much faster than walls move.
constexpr double turn_over_walls = 3;

}  // namespace

/// Before the contacts are found anew: the system of the last iteration, free of impulses but attractions.
void ImplicitDynamics::catch_problem(double dt) {
  ElasticContacts system(grains, contacts, compliance_, outline_increment_, dt, scratch_);
  for (std::size_t c = 0; c < attraction.size(); ++c)
    if (attraction[c] > 0) system.apply_impulse(static_cast<int>(c), {-attraction[c], 0});
  caught = {contact_problem_of<2>(system, friction_of_contacts()), flat<2>(impulse)};
}

/// What Newton's tolerance left of the momentum is given back to each grain as a whole, and to a grain that
/// touches none what backward Euler took of its angular momentum about the centre:
///   sum_i m_i (v - v_n)_i = dt f_ext + H p,   L = L_n + dt sum_i (x - x_c)_i x f_i.
/// A step whose inertia A does not have gives a grain that touches others no more than one more correction
/// would, and no spin. A slow step, sub-steps of it included, ends faster spins of touching grains: without
/// friction nothing else does, and a grain that turns by a good part of itself in a step lets none converge
/// (docs/decisions/0031). What this changes of the kinetic energy, backward Euler had taken.
void ImplicitDynamics::balance_momentum(double dt, std::span<const Vec<2>> contact_force) {
  const double t = step_of_matrix(dt);
  double fastest = 0;
  for (const Wall<2>& wall : box.walls) fastest = std::max(fastest, turn_over_walls * norm(wall.velocity));
  fastest = std::max(fastest, turn_over_walls * std::sqrt(contract(box.cell.rate, box.cell.rate)));
  std::vector<Wide> given(batches());  // kinetic energy
  const auto balance = [&](int b) {
    GrainBatch& batch = grains.batches[b];
    WideVectors outer(batch.position.size());
    grains.scatter_outline(contact_force, batch, outer);
    const auto cross = [](const Vec<2, Wide>& u, const Vec<2, Wide>& v) { return u[0] * v[1] - u[1] * v[0]; };
    const int nodes = batch.topology->grid.nodes();
    Wide mass = 0.0, inertia = 0.0, spin = 0.0, kept_spin = 0.0, load = 0.0, kinetic = 0.0;
    Vec<2, Wide> sum{}, first{}, first_start{};
    for (int i = 0; i < nodes; ++i) {
      const Wide m = grains.node_mass(batch, i);
      mass += m;
      first += m * batch.position[i];
      first_start += m * start_[b][i];
    }
    const Vec<2, Wide> centre = (1.0 / mass) * first, centre_start = (1.0 / mass) * first_start;
    for (int i = 0; i < nodes; ++i) {
      const Wide m = grains.node_mass(batch, i);
      const Vec<2, Wide> flight = flight_velocity(b, i), x = batch.position[i] - centre;
      Vec<2, Wide> change;  // dt f
      for (int d = 0; d < 2; ++d) {
        change[d] = dt * (outer[i][d] + m * Wide(options.gravity[d]));
        sum[d] += change[d] - m * (batch.velocity[i][d] - flight[d]);
        change[d] -= dt * force_[b][i][d];
      }
      inertia += m * dot(x, x);
      load += dot(outer[i], outer[i]);
      kept_spin += m * cross(x, batch.velocity[i]);
      spin +=
          m * (cross(start_[b][i] - centre_start, flight) - cross(x, batch.velocity[i])) + cross(x, change);
      kinetic -= 0.5 * m * dot(batch.velocity[i], batch.velocity[i]);
    }
    const Wide touching = t * t / (dt * dt), share = touching + flying_[b] * (Wide(1) - touching);
    const Vec<2, Wide> dv = (share / mass) * sum;
    Wide turn = t < dt ? Wide(0) : select(load <= 0.0, spin / inertia, Wide(0));
    for (int lane = 0; slow_ && lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
      const double rate = kept_spin[lane] / inertia[lane];
      if (load[lane] > 0 && std::abs(rate) * batch.radius[lane] > fastest) turn.set(lane, -rate);
    }
    for (int i = 0; i < nodes; ++i) {
      Vec<2, Wide>& v = batch.velocity[i];
      v += dv + turn * Vec<2, Wide>{-(batch.position[i][1] - centre[1]), batch.position[i][0] - centre[0]};
      kinetic += 0.5 * grains.node_mass(batch, i) * dot(v, v);
    }
    given[b] = kinetic;
  };
  share(balance, [&](int b, Message& message) {
    message(given[b]), pass_known(b, grains.batches[b].velocity, message);
  });
  for (int b = 0; b < batches(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane)
      work.inertia -= given[b][lane];
}

void ImplicitDynamics::add_work(std::span<const Vec<2>> contact_force) {
  struct Share {
    Wide internal = 0.0, inertia = 0.0, gravity = 0.0, damping = 0.0;
  };
  std::vector<Share> shares(grains.batches.size());
  const auto add_up = [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    auto& [internal, inertia, gravity, damping] = shares[b];
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      const Wide m = grains.node_mass(batch, i);
      const Vec<2, Wide> moved = batch.position[i] - start_[b][i];
      const Vec<2, Wide> dv = Wide(1 / outline_.dt) * moved - velocity_start_[b][i];
      internal += dot(force_[b][i], moved);
      inertia += 0.5 * m * dot(dv, dv);
      if (options.damping > 0)  // - f . dx = m (v_n - flight)/dt . dx
        damping += m * Wide(1 / outline_.dt) * dot(velocity_start_[b][i] - flight_velocity(b, i), moved);
      gravity += m * (options.gravity[0] * moved[0] + options.gravity[1] * moved[1]);
    }
    if (batch.topology->rigid()) inertia = inertia_work_of_rigid(b, contact_force);
  };
  share(add_up, [&](int b, Message& message) {
    message(shares[b]), message(held_[b].couple), message(held_[b].wanted);
  });
  for (std::size_t b = 0; b < grains.batches.size(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane) {
      work.internal += shares[b].internal[lane];
      work.inertia += shares[b].inertia[lane];
      work.gravity += shares[b].gravity[lane];
      work.damping += shares[b].damping[lane];
      work.contacts += held_[b].couple[lane] * held_[b].wanted[lane];
    }
  add_contact_work(contacts, felt(), outline_, work, box.impulse);
}

}  // namespace softgrain
