#include "softgrain/rigid/step_problem.hpp"

#include <algorithm>
#include <utility>

#include "softgrain/contact/assemble.hpp"

namespace softgrain {
namespace {

/// Those that the law can answer; `offset` is of all, and then of these.
RigidContacts<2> active_contacts(const RigidContacts<2>& all, std::vector<double>& offset) {
  RigidContacts<2> active;
  active.cell = all.cell;
  std::vector<double> kept;
  for (int c = 0; c < all.size(); ++c) {
    if (offset[c] == inactive_offset) continue;
    kept.push_back(offset[c]);
    active.body_a.push_back(all.body_a[c]);
    active.body_b.push_back(all.body_b[c]);
    active.inverse_mass_a.push_back(all.inverse_mass_a[c]);
    active.inverse_mass_b.push_back(all.inverse_mass_b[c]);
    active.friction.push_back(all.friction[c]);
    active.normal.push_back(all.normal[c]);
    active.gap.push_back(all.gap[c]);
    active.impulse.push_back(all.impulse[c]);
    if (c >= all.first_crossing()) active.image.push_back(all.image[c - all.first_crossing()]);
  }
  offset = std::move(kept);
  return active;
}

}  // namespace

SolvedContactProblem problem_of_step(const RigidDynamics<2>& dynamics, std::vector<Vec<2>> velocity_start,
                                     double dt) {
  RigidParticles<2> particles = dynamics.particles;
  const int n = particles.size();
  std::copy(particles.velocity.begin() + n, particles.velocity.end(), velocity_start.begin() + n);  // walls
  std::vector<double> offset;
  signorini_offset<2>(dynamics.contacts, velocity_start, dynamics.options.law, dt, offset);
  const RigidContacts<2> contacts = active_contacts(dynamics.contacts, offset);
  RigidContactSystem<2> system(particles, contacts, offset);
  for (int c = 0; c < system.size(); ++c) system.apply_impulse(c, -contacts.impulse[c]);  // v_free again
  return {contact_problem_of<2>(system, contacts.friction), flat<2>(contacts.impulse)};
}

}  // namespace softgrain
