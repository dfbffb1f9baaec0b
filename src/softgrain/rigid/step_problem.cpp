#include "softgrain/rigid/step_problem.hpp"

#include <algorithm>
#include <utility>

#include "softgrain/contact/assemble.hpp"

namespace softgrain {
namespace {

/// Those that the law can answer; `offset` is of all, and then of these.
template <int Dim>
RigidContacts<Dim> active_contacts(const RigidContacts<Dim>& all, std::vector<double>& offset) {
  RigidContacts<Dim> active;
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

template <int Dim>
SolvedContactProblem problem_of_step(const RigidDynamics<Dim>& dynamics, std::vector<Vec<Dim>> velocity_start,
                                     double dt) {
  RigidParticles<Dim> particles = dynamics.particles;
  const int n = particles.size();
  std::copy(particles.velocity.begin() + n, particles.velocity.end(), velocity_start.begin() + n);  // walls
  std::vector<double> offset;
  signorini_offset<Dim>(dynamics.contacts, velocity_start, dynamics.options.law, dt, offset);
  const RigidContacts<Dim> contacts = active_contacts(dynamics.contacts, offset);
  RigidContactSystem<Dim> system(particles, contacts, offset);
  for (int c = 0; c < system.size(); ++c) system.apply_impulse(c, -contacts.impulse[c]);  // v_free again
  return {contact_problem_of<Dim>(system, contacts.friction), flat<Dim>(contacts.impulse)};
}

template SolvedContactProblem problem_of_step<2>(const RigidDynamics<2>&, std::vector<Vec<2>>, double);
template SolvedContactProblem problem_of_step<3>(const RigidDynamics<3>&, std::vector<Vec<3>>, double);

}  // namespace softgrain
