#include "softgrain/soft/explicit_step.hpp"

// Rigid grains in the explicit step (theory (72)).

namespace softgrain {
namespace {

double spin_of(const Wide& spin, int lane) { return spin[lane]; }
Vec<3> spin_of(const Vec<3, Wide>& spin, int lane) { return lane_of(spin, lane); }

void set_spin(Wide& spin, int lane, double value) { spin.set(lane, value); }
void set_spin(Vec<3, Wide>& spin, int lane, const Vec<3>& value) {
  for (int d = 0; d < 3; ++d) spin[d].set(lane, value[d]);
}

/// Does it take part by its centre? In the plane none does.
bool is_ball(const Topology&) { return false; }
bool is_ball(const SolidTopology& shape) { return shape.ball; }

}  // namespace

/// Where the outlines would be after dt without forces; bodies as contacts find them.
template <int Dim>
void ExplicitStep<Dim>::fly_rigid(double dt, const BatchOf<Dim>& batch) {
  const RigidTwistOf<Dim> twist = rigid_twist(grains, batch, batch.position, batch.velocity);
  const RigidMassOf<Dim> all = rigid_mass(grains, batch);
  WidePlaces<Dim> flown(batch.position.size());
  place_rigid(batch,
              moved(rigid_pose(batch, batch.position), Wide(dt) * twist.velocity, Wide(dt) * twist.spin),
              flown);
  const std::size_t c = centre_node(*batch.topology);
  const Vec<Dim, Wide> centre =
      batch.position[c] + Wide(outline_.normals_at) * (flown[c] - batch.position[c]);
  for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
    LumpedBodyOf<Dim>& body = bodies_.body[body_of_grain_[batch.grain[lane]]];
    for (int d = 0; d < Dim; ++d) body.centre[d] = centre[d][lane];
    body.inverse_mass = 1 / all.mass[lane];
    body.inverse_inertia = 1 / all.inertia[lane];
    body.radius = is_ball(*batch.topology) ? batch.radius[lane] : 0;
  }
  if constexpr (Dim == 3)
    if (!batch.topology->ball) {
      const Mat<3, Wide> inverse_tensor = inverse(inertia_tensor(grains, batch, batch.position));
      for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
        for (std::size_t k = 0; k < 9; ++k)
          bodies_.body[body_of_grain_[batch.grain[lane]]].inverse_tensor.c[k] = inverse_tensor.c[k][lane];
    }
  set_bodies(batch, twist);
  grains.for_each_vertex(batch, [&](int v, int i, int lane) {
    for (int d = 0; d < Dim; ++d) outline_.position[v][d] = flown[i][d][lane];
    outline_velocity_start_[v] =
        bodies_.body[body_of_grain_[batch.grain[lane]]].velocity_at(outline_.on_the_way(v));
  });
}

/// v_free = v + dt g and what damping changes.
template <int Dim>
void ExplicitStep<Dim>::kick_rigid(double dt, BatchOf<Dim>& batch, BatchStep& step) {
  step.twist = rigid_twist(grains, batch, batch.position, batch.velocity);
  WidePlaces<Dim> kicked = batch.velocity;
  for (std::size_t i = 0; i < kicked.size(); ++i) {
    if (options.damping > 0) kicked[i] += damping_.velocity_change(batch.position[i], batch.velocity[i]);
    for (int d = 0; d < Dim; ++d) kicked[i][d] += dt * options.gravity[d];
  }
  set_bodies(batch, rigid_twist(grains, batch, batch.position, kicked));
}

/// x_c+ = x_c + dt v_c+, and a turn by dt omega+; work as in drift_batch.
template <int Dim>
void ExplicitStep<Dim>::drift_rigid(double dt, BatchOf<Dim>& batch, BatchStep& step) {
  const RigidTwistOf<Dim> twist = twist_of_bodies(batch);
  const RigidMassOf<Dim> all = rigid_mass(grains, batch);
  const Vec<Dim, Wide> twice = step.twist.velocity + twist.velocity;
  step.internal = step.damping = 0.0;
  Wide fallen = options.gravity[0] * twice[0];
  for (int d = 1; d < Dim; ++d) fallen = fallen + options.gravity[d] * twice[d];
  step.gravity = Wide(dt / 2) * all.mass * fallen;
  step.flow = {};
  if (options.damping > 0) {
    WidePlaces<Dim> damped(batch.position.size());
    for (std::size_t i = 0; i < damped.size(); ++i)
      damped[i] = damping_.velocity_change(batch.position[i], batch.velocity[i]);
    const RigidTwistOf<Dim> change = rigid_twist(grains, batch, batch.position, damped);
    const SpinOf<Dim, Wide> twice_spin = step.twist.spin + twist.spin;
    Wide of_spins = all.of_spins(change.spin, twice_spin);
    if constexpr (Dim == 3)
      if (batch.topology->rigid_shape())
        of_spins = dot(change.spin, inertia_tensor(grains, batch, batch.position) * twice_spin);
    step.damping = -0.5 * (all.mass * dot(change.velocity, twice) + of_spins);
  }
  grains.for_each_vertex(batch, [&](int v, int, int lane) {
    outline_velocity_[v] =
        bodies_.body[body_of_grain_[batch.grain[lane]]].velocity_at(outline_.on_the_way(v));
  });
  if constexpr (Dim == 3) {
    if (batch.topology->rigid_shape()) {
      const Vec<3, Wide> spin =
          turn_freely(grains, batch, dt, Wide(dt) * twist.velocity, twist.spin, batch.position);
      return set_rigid_twist({twist.velocity, spin}, batch.position, batch.velocity);
    }
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      outline_.rolled[grains.outline_end(batch.grain[lane]) - 1] =
          (dt / 2 * batch.radius[lane]) * lane_of(step.twist.spin + twist.spin, lane);
  }
  place_rigid(batch,
              moved(rigid_pose(batch, batch.position), Wide(dt) * twist.velocity, Wide(dt) * twist.spin),
              batch.position);
  set_rigid_twist(twist, batch.position, batch.velocity);
}

template <int Dim>
void ExplicitStep<Dim>::set_bodies(const BatchOf<Dim>& batch, const RigidTwistOf<Dim>& twist) {
  for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
    LumpedBodyOf<Dim>& body = bodies_.body[body_of_grain_[batch.grain[lane]]];
    for (int d = 0; d < Dim; ++d) body.velocity[d] = twist.velocity[d][lane];
    body.spin = spin_of(twist.spin, lane);
  }
}

template <int Dim>
RigidTwistOf<Dim> ExplicitStep<Dim>::twist_of_bodies(const BatchOf<Dim>& batch) const {
  RigidTwistOf<Dim> twist;
  for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
    const LumpedBodyOf<Dim>& body = bodies_.body[body_of_grain_[batch.grain[lane]]];
    for (int d = 0; d < Dim; ++d) twist.velocity[d].set(lane, body.velocity[d]);
    set_spin(twist.spin, lane, body.spin);
  }
  return twist;
}

template class ExplicitStep<2>;
template class ExplicitStep<3>;

}  // namespace softgrain
