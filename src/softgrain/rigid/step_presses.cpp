#include "softgrain/rigid/step.hpp"

// Walls that keep a stress in a step of rigid particles.

namespace softgrain {

/// Of the force field on the walls of a press, along their normals [N/m].
template <int Dim>
double RigidDynamics<Dim>::pull_on(const Press& press) const {
  double pull = 0;
  for (std::size_t w = 0; w < particles.walls.size(); ++w)
    if (press.share[w] != 0)
      pull +=
          press.share[w] * dot(force_[particles.wall_body(static_cast<int>(w))], particles.walls[w].normal);
  return pull;
}

template <int Dim>
PushedBodies RigidDynamics<Dim>::pressed_walls(double dt) const {
  PushedBodies pushed;
  if (particles.presses.empty()) return pushed;
  for (const Press& press : particles.presses)
    pushed.bodies.push_back({.free = press.free_speed(dt) + dt * press.mobility(dt) * pull_on(press),
                             .mobility = press.mobility(dt),
                             .most = press.most,
                             .assumed = press.speed});
  const ContactBatch& listed = contacts.blocks.back().pressed;
  for (int c = listed.begin; c < listed.end; ++c) {
    const std::size_t wall = contacts.body_b[c] - particles.size();
    for (std::size_t k = 0; k < particles.presses.size(); ++k)
      if (const double share = particles.presses[k].share[wall]; share != 0)
        pushed.add({.contact = c, .body = static_cast<int>(k), .share = share}, contacts.impulse[c][0],
                   contacts.size());
  }
  return pushed;
}

template <int Dim>
void RigidDynamics<Dim>::move_presses(double dt) {
  const PushedBodies pushed = pressed_walls(dt);
  for (std::size_t k = 0; k < particles.presses.size(); ++k)
    set_press_speed(particles, particles.presses[k], pushed.bodies[k].velocity());
}

template <int Dim>
void RigidDynamics<Dim>::end_step_of_presses(double dt) {
  const PushedBodies pushed = pressed_walls(dt);
  for (std::size_t k = 0; k < particles.presses.size(); ++k)
    particles.presses[k].end_step(pushed.bodies[k].velocity(),
                                  pushed.bodies[k].push - dt * pull_on(particles.presses[k]), dt);
}

template double RigidDynamics<2>::pull_on(const Press&) const;
template PushedBodies RigidDynamics<2>::pressed_walls(double) const;
template void RigidDynamics<2>::move_presses(double);
template void RigidDynamics<2>::end_step_of_presses(double);
template double RigidDynamics<3>::pull_on(const Press&) const;
template PushedBodies RigidDynamics<3>::pressed_walls(double) const;
template void RigidDynamics<3>::move_presses(double);
template void RigidDynamics<3>::end_step_of_presses(double);

}  // namespace softgrain
