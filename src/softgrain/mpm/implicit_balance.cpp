#include "softgrain/contact/assemble.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/mpm/contact_work.hpp"
#include "softgrain/mpm/implicit_step.hpp"

namespace softgrain {

/// Before the contacts are found anew: the system of the last iteration, free of impulses.
void ImplicitDynamics::catch_problem(double dt) {
  ElasticContacts system(grains, contacts, compliance_, outline_increment_, dt, scratch_);
  caught = {contact_problem_of<2>(system, friction_of_contacts()), flat<2>(impulse)};
}

/// What Newton's tolerance left of sum_i m_i (v - v_n)_i = dt f_ext + H p is given back to each grain as a
/// whole; in a quasi-static step to a grain that touches others, no more than one more correction would.
void ImplicitDynamics::balance_momentum(double dt) {
  const std::vector<Vec<2>> force = contact_forces(grains, contacts, impulse, dt);
  const double t = step_of_matrix(dt);
  parallel_for(batches(), [&](int b) {
    GrainBatch& batch = grains.batches[b];
    WideVectors missing(batch.position.size());
    grains.scatter_outline(force, batch, missing);
    Wide mass = 0.0;
    Vec<2, Wide> sum{};
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      const Wide m = grains.node_mass(batch, i);
      mass += m;
      const Vec<2, Wide> flight = flight_velocity(b, i);
      for (int d = 0; d < 2; ++d)
        sum[d] +=
            dt * (missing[i][d] + m * Wide(options.gravity[d])) - m * (batch.velocity[i][d] - flight[d]);
    }
    const Wide touching = t * t / (dt * dt);
    const Wide share = (touching + flying_[b] * (Wide(1) - touching)) / mass;
    for (Vec<2, Wide>& v : batch.velocity) v += share * sum;
  });
}

void ImplicitDynamics::add_work() {
  struct Share {
    Wide internal = 0.0, inertia = 0.0, gravity = 0.0, damping = 0.0;
  };
  std::vector<Share> shares(grains.batches.size());
  parallel_for(batches(), [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    auto& [internal, inertia, gravity, damping] = shares[b];
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      const Wide m = grains.node_mass(batch, i);
      const Vec<2, Wide> moved = batch.position[i] - start_[b][i];
      const Vec<2, Wide> dv = batch.velocity[i] - velocity_start_[b][i];
      internal += dot(force_[b][i], moved);
      inertia += 0.5 * m * dot(dv, dv);
      if (options.damping > 0)  // - f . dx = m (v_n - flight)/dt . dx
        damping += m * Wide(1 / outline_.dt) * dot(velocity_start_[b][i] - flight_velocity(b, i), moved);
      gravity += m * (options.gravity[0] * moved[0] + options.gravity[1] * moved[1]);
    }
  });
  for (std::size_t b = 0; b < grains.batches.size(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane) {
      work.internal += shares[b].internal[lane];
      work.inertia += shares[b].inertia[lane];
      work.gravity += shares[b].gravity[lane];
      work.damping += shares[b].damping[lane];
    }
  add_contact_work(contacts, impulse, outline_, work, wall_impulse_);
}

}  // namespace softgrain
