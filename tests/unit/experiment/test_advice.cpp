#include "softgrain/experiment/advice.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace softgrain;

TEST_CASE(
    "the tolerance of Newton's method is told as a stress over the yield stress, of metals in implicit "
    "steps") {
  Case c;
  c.experiment.model = GrainModel::mpm;
  c.mpm.law = MaterialLaw::von_mises;
  c.mpm.material = {.young_modulus = 1e8, .poisson_ratio = 0.3, .yield_stress = 1e5};
  c.mpm.tolerance = 1e-4;
  CHECK(std::abs(advise(c).imbalance / 0.1 - 1) < 1e-12);
  c.mpm.tolerance = 1e-6;
  CHECK(std::abs(advise(c).imbalance / 1e-3 - 1) < 1e-12);
  c.mpm.integrator = Integrator::symplectic_euler;
  CHECK(advise(c).imbalance == 0);
  c.mpm.integrator = Integrator::backward_euler;
  c.mpm.law = MaterialLaw::neo_hookean;
  CHECK(advise(c).imbalance == 0);
}
