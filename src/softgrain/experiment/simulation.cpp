#include "softgrain/experiment/simulation.hpp"

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/core/error.hpp"

namespace softgrain {

SolvedContactProblem Simulation::step_and_catch_problem() {
  throw UsageError(
      "this way of integrating solves no contact problem that could be written down; bonded grains and "
      "implicit elastic ones (mpm.formulation = \"total_lagrangian\", mpm.integrator = \"implicit\") do");
}

}  // namespace softgrain
