#pragma once
#include "softgrain/observe/energy.hpp"
#include "softgrain/observe/observation.hpp"
#include "softgrain/state/field.hpp"

namespace softgrain {

/// Work since the start [J/m]. What the walls and gravity gave is kinetic energy, work of the internal
/// forces, what contacts took (impacts and friction), and what the time stepping took:
///   walls + gravity = dK + internal + contacts + inertia + damping,
/// as far as the equations of motion and the contact laws were solved.
struct WorkBudget {
  double walls = 0;     ///< by the walls on the grains
  double gravity = 0;   ///< sum of m g . dx
  double internal = 0;  ///< sum of f_int . dx: the elastic energy, `flow`, and what integration loses
  double flow = 0;      ///< of `internal`: dissipated by flow of the material
  double contacts = 0;  ///< -sum of p . u: taken by contacts
  double friction = 0;  ///< of `contacts`: by sliding
  double adhesion = 0;  ///< of `contacts`: what the energy of adhesion grew by, which is not dissipated
  double inertia = 0;   ///< backward Euler's sum of m (dv)^2/2
  double damping = 0;   ///< -sum of f_damping . dx, see MassDamping
};

/// Energies from what the work of a run was spent on; `elastic`: stored now [J/m].
Energies energies_of(const WorkBudget& work, double kinetic, double elastic);
/// The columns that split the dissipation of elastic grains, and their energy.
Numbers elastic_numbers(const WorkBudget& work, double elastic);

/// Declares what work was spent on, but `flow` and `adhesion`, which only some grains have.
void visit_work(WorkBudget& work, StateVisitor& visit);

}  // namespace softgrain
