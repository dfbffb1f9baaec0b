#include "softgrain/model/model.hpp"

#include <algorithm>

#include "softgrain/core/error.hpp"

namespace softgrain {

template <int Dim>
void ModelOf<Dim>::catch_problem() {
  throw UsageError("the steps of this model and integrator solve no contact problem that stands alone");
}

template <int Dim>
SolvedContactProblem ModelOf<Dim>::caught_problem(double) {
  return {};
}

template class ModelOf<2>;
template class ModelOf<3>;

PressBody critically_damped(double density, double wave_speed, double length, double dt) {
  const double stiffness = density * wave_speed * wave_speed / length;
  const double tau = std::max(length / wave_speed, dt / 10);
  return {.mass = stiffness * tau * tau, .damper = 2 * stiffness * tau};
}

}  // namespace softgrain
