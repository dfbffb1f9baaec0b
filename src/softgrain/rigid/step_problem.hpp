#pragma once
#include <vector>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// The contact problem that the last step of dt [s] solved, with its impulses: of the contacts that the law
/// can answer. velocity_start: of all bodies before the step [m/s].
template <int Dim>
SolvedContactProblem problem_of_step(const RigidDynamics<Dim>& dynamics, std::vector<Vec<Dim>> velocity_start,
                                     double dt);

}  // namespace softgrain
