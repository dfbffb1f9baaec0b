#include "softgrain/model/model.hpp"

#include "softgrain/core/error.hpp"

namespace softgrain {

void Model::catch_problem() {
  throw UsageError("the steps of this model and integrator solve no contact problem that stands alone");
}

SolvedContactProblem Model::caught_problem(double) { return {}; }

}  // namespace softgrain
