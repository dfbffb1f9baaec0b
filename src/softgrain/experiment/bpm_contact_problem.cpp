#include <algorithm>

#include "softgrain/contact/assemble.hpp"
#include "softgrain/experiment/bpm_simulation.hpp"

namespace softgrain {
namespace {

/// Those that the law can answer: all candidates, or only the closed ones.
RigidContacts<2> active_contacts(const RigidContacts<2>& all, Activation activation) {
  RigidContacts<2> active;
  for (int c = 0; c < all.size(); ++c) {
    if (activation == Activation::closed_at_mid_step && all.gap[c] > 0) continue;
    active.body_a.push_back(all.body_a[c]);
    active.body_b.push_back(all.body_b[c]);
    active.inverse_mass_a.push_back(all.inverse_mass_a[c]);
    active.inverse_mass_b.push_back(all.inverse_mass_b[c]);
    active.friction.push_back(all.friction[c]);
    active.normal.push_back(all.normal[c]);
    active.gap.push_back(all.gap[c]);
    active.impulse.push_back(all.impulse[c]);
  }
  return active;
}

}  // namespace

SolvedContactProblem BpmSimulation::step_and_catch_problem() {
  std::vector<Vec<2>> velocity_start = dynamics_.particles.velocity;
  step();
  RigidParticles<2> particles = dynamics_.particles;
  const int n = particles.size();
  std::copy(particles.velocity.begin() + n, particles.velocity.end(), velocity_start.begin() + n);  // walls
  const ContactLaw& law = dynamics_.options.law;
  const RigidContacts<2> contacts = active_contacts(dynamics_.contacts, law.activation);
  std::vector<double> offset;
  signorini_offset<2>(contacts, velocity_start, law, case_.time.step, offset);
  RigidContactSystem<2> system(particles, contacts, offset);
  for (int c = 0; c < system.size(); ++c) system.apply_impulse(c, -contacts.impulse[c]);  // v_free again
  return {contact_problem_of<2>(system, contacts.friction), flat<2>(contacts.impulse)};
}

}  // namespace softgrain
