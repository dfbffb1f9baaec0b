#pragma once
#include <vector>

#include "softgrain/contact/delassus_system.hpp"
#include "softgrain/rigid/contacts.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain::bench {

/// How many disks, and how they are laid out: a compacted box of disks, repeated by reflection in its walls,
/// which keeps every contact and makes new ones across the walls.
struct PackingSize {
  int columns, rows, disks_per_box;
  int disks() const { return columns * rows * disks_per_box; }
};

inline constexpr PackingSize small_packing{1, 1, 1750}, middle_packing{2, 2, 1500}, large_packing{8, 5, 1500};

/// A jammed, frictionless random packing between four walls: mean diameter 1, diameters uniform with
/// largest/smallest = 1.625, a mass of diameter^2, box by box, in each sorted in space (Morton order). At
/// rest.
RigidParticles<2> dense_packing(const PackingSize& size);

/// One step's contact problem, frozen, in units of the mean diameter and the step.
struct ContactProblem {
  RigidParticles<2> particles;
  RigidContacts<2> contacts;
  std::vector<double> offset;  ///< of the Signorini condition

  int active() const;  ///< contacts that carry impulse
  double friction() const { return contacts.friction.empty() ? 0 : contacts.friction[0]; }
};

/// The disks of a dense packing move towards its centre and collide in the step, with friction mu at every
/// contact: v_free is a uniform compression with 20 % noise, p = 0. Each box is a grain, so that contacts are
/// swept box by box.
ContactProblem collapse_problem(const PackingSize& size, double mu);

/// Relaxes a problem by sweeps, so that p is what a step starts from (warm start).
void warm_up(ContactProblem& problem, int sweeps);

/// The same problem with the matrix W = H^T M^-1 H in full, as codes that keep W solve it.
struct FullProblem {
  std::vector<MatrixEntry> W;
  std::vector<Vec<2>> q;
};
FullProblem full_problem(const ContactProblem& problem);

}  // namespace softgrain::bench
