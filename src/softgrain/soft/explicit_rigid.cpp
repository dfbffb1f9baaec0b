#include "softgrain/soft/explicit_step.hpp"

// Rigid grains in the explicit step (theory (72)).

namespace softgrain {

/// Where the outlines would be after dt without forces; bodies as contacts find them.
template <>
void ExplicitDynamics::fly_rigid(double dt, const GrainBatch& batch) {
  const RigidTwist twist = rigid_twist(grains, batch, batch.position, batch.velocity);
  const RigidMass all = rigid_mass(grains, batch);
  WideVectors flown(batch.position.size());
  place_rigid(batch,
              moved(rigid_pose(batch, batch.position), Wide(dt) * twist.velocity, Wide(dt) * twist.spin),
              flown);
  const Vec<2, Wide> centre = batch.position[0] + Wide(outline_.normals_at) * (flown[0] - batch.position[0]);
  for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
    LumpedBody& body = bodies_.body[body_of_grain_[batch.grain[lane]]];
    for (int d = 0; d < 2; ++d) body.centre[d] = centre[d][lane];
    body.inverse_mass = 1 / all.mass[lane];
    body.inverse_inertia = 1 / all.inertia[lane];
  }
  set_bodies(batch, twist);
  grains.for_each_vertex(batch, [&](int v, int i, int lane) {
    for (int d = 0; d < 2; ++d) outline_.position[v][d] = flown[i][d][lane];
    outline_velocity_start_[v] =
        bodies_.body[body_of_grain_[batch.grain[lane]]].velocity_at(outline_.on_the_way(v));
  });
}

/// v_free = v + dt g and what damping changes.
template <>
void ExplicitDynamics::kick_rigid(double dt, GrainBatch& batch, BatchStep& step) {
  step.twist = rigid_twist(grains, batch, batch.position, batch.velocity);
  WideVectors kicked = batch.velocity;
  for (std::size_t i = 0; i < kicked.size(); ++i) {
    if (options.damping > 0) kicked[i] += damping_.velocity_change(batch.position[i], batch.velocity[i]);
    for (int d = 0; d < 2; ++d) kicked[i][d] += dt * options.gravity[d];
  }
  set_bodies(batch, rigid_twist(grains, batch, batch.position, kicked));
}

/// x_c+ = x_c + dt v_c+, and a turn by dt w+; work as in drift_batch.
template <>
void ExplicitDynamics::drift_rigid(double dt, GrainBatch& batch, BatchStep& step) {
  const RigidTwist twist = twist_of_bodies(batch);
  const RigidMass all = rigid_mass(grains, batch);
  const Vec<2, Wide> twice = step.twist.velocity + twist.velocity;
  step.internal = step.damping = 0.0;
  step.gravity = Wide(dt / 2) * all.mass * (options.gravity[0] * twice[0] + options.gravity[1] * twice[1]);
  step.flow = {};
  if (options.damping > 0) {
    WideVectors damped(batch.position.size());
    for (std::size_t i = 0; i < damped.size(); ++i)
      damped[i] = damping_.velocity_change(batch.position[i], batch.velocity[i]);
    const RigidTwist change = rigid_twist(grains, batch, batch.position, damped);
    step.damping = -0.5 * (all.mass * dot(change.velocity, twice) +
                           all.inertia * change.spin * (step.twist.spin + twist.spin));
  }
  grains.for_each_vertex(batch, [&](int v, int, int lane) {
    outline_velocity_[v] =
        bodies_.body[body_of_grain_[batch.grain[lane]]].velocity_at(outline_.on_the_way(v));
  });
  place_rigid(batch,
              moved(rigid_pose(batch, batch.position), Wide(dt) * twist.velocity, Wide(dt) * twist.spin),
              batch.position);
  set_rigid_twist(twist, batch.position, batch.velocity);
}

template <>
void ExplicitDynamics::set_bodies(const GrainBatch& batch, const RigidTwist& twist) {
  for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
    LumpedBody& body = bodies_.body[body_of_grain_[batch.grain[lane]]];
    for (int d = 0; d < 2; ++d) body.velocity[d] = twist.velocity[d][lane];
    body.spin = twist.spin[lane];
  }
}

template <>
RigidTwist ExplicitDynamics::twist_of_bodies(const GrainBatch& batch) const {
  RigidTwist twist;
  for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
    const LumpedBody& body = bodies_.body[body_of_grain_[batch.grain[lane]]];
    for (int d = 0; d < 2; ++d) twist.velocity[d].set(lane, body.velocity[d]);
    twist.spin.set(lane, body.spin);
  }
  return twist;
}

}  // namespace softgrain
