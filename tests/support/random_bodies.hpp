#pragma once
#include <vector>

#include "softgrain/rigid/neighbours.hpp"
#include "softgrain/rigid/particles.hpp"
#include "softgrain/rigid/rigid_contact_system.hpp"
#include "support/dimensions.hpp"
#include "support/random_numbers.hpp"

namespace softgrain::test {

/// Bodies with random radii about 1, masses, velocities and spins on a jittered square (cubic) lattice of
/// spacing 2, so that some neighbours overlap and others do not, in a corner of Dim moving walls.
template <int Dim>
RigidParticles<Dim> random_bodies(int per_side, std::uint64_t seed) {
  RandomNumbers random(seed);
  int count = 1;
  for (int k = 0; k < Dim; ++k) count *= per_side;
  std::vector<Vec<Dim>> position;
  std::vector<double> radius, mass;
  for (int i = 0; i < count; ++i) {
    Vec<Dim> site;
    for (int k = 0, rest = i; k < Dim; ++k, rest /= per_side) site[k] = 2 * (rest % per_side) + 1;
    position.push_back(site + random.vector<Dim>(0.15));
    radius.push_back(random.uniform(0.8, 1.1));
    mass.push_back(random.uniform(0.5, 2));
  }
  std::vector<Wall<Dim>> walls(Dim);
  for (int k = 0; k < Dim; ++k) {
    walls[k].normal[k] = 1;
    walls[k].velocity = random.vector<Dim>(0.5);
  }
  auto bodies = rigid_particles<Dim>(position, radius, mass, walls);
  for (int i = 0; i < count; ++i) {
    bodies.velocity[i] = random.vector<Dim>(1);
    bodies.spin[i] = random.vector<spin_size<Dim>>(1);
  }
  return bodies;
}

/// A third of the contacts slide freely, the others have friction.
inline double mixed_friction(int a, int b) { return (a + b) % 3 == 0 ? 0 : 0.4; }

/// Random bodies with their candidate contacts and the offsets of a step.
template <int Dim>
struct ContactScene {
  RigidParticles<Dim> bodies;
  NeighbourReference<Dim> reference{.skin = 0.2, .position = {}, .wall_point = {}};
  RigidContacts<Dim> contacts;
  std::vector<double> offset;

  explicit ContactScene(int per_side, const FrictionRule& friction = mixed_friction, double dt = 0.1,
                        const ContactLaw& law = {})
      : bodies(random_bodies<Dim>(per_side, 11)) {
    set_reference(reference, bodies);
    contacts = candidate_contacts(bodies, reference, friction, {});
    detect_contacts(bodies, contacts);
    signorini_offset<Dim>(contacts, bodies.velocity, law, dt, offset);
  }
  RigidContactSystem<Dim> system() { return {bodies, contacts, offset}; }
};

}  // namespace softgrain::test
