#include "softgrain/experiment/advice.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/experiment/estimate.hpp"

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

TEST_CASE("how long a stress is kept is told in times of a wave through the box") {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::bpm};
  c.bpm.cohesive_pressure = 5e5;
  c.grain.density = 990;
  c.sample.grains = 300;
  c.sample.packing_fraction = 0.7;
  CHECK(std::isinf(advise(c).hold));
  c.loading.hold_stress = 5e5;
  c.loading.hold = 2e-3;
  const double bonded = advise(c).hold;
  CHECK(std::abs(bonded / (2e-3 * std::sqrt(5e6 / 990) / box_height(c)) - 1) < 1e-12);
  CHECK(bonded < Advice::least_hold);  // 300 bonded grains that are held for 2 ms
  c.experiment.model = GrainModel::mpm;
  c.mpm.law = MaterialLaw::neo_hookean;
  c.mpm.material = {.young_modulus = 1e7, .poisson_ratio = 0.45};
  const double modulus = 1e7 * 0.55 / (1.45 * 0.1);  // E (1 - nu)/((1 + nu)(1 - 2 nu))
  CHECK(std::abs(advise(c).hold / (2e-3 * std::sqrt(modulus / 990) / box_height(c)) - 1) < 1e-12);
  c.experiment.model = GrainModel::rigid;
  CHECK(std::isinf(advise(c).hold));
}

TEST_CASE("the inertial number is that of the fastest strain, along whichever axis it is, or of shear") {
  Case c;
  c.experiment = {.loading = LoadingPath::stages, .model = GrainModel::mpm};
  c.mpm.material = {.young_modulus = 1e7, .poisson_ratio = 0.45};
  c.grain.density = 1000;
  c.sample.smallest_diameter = c.sample.largest_diameter = 2e-3;
  c.sample.grains = 20;
  c.sample.aspect = 4;
  const double time = 2e-3 * std::sqrt(1000 / 1e5);  // d sqrt(rho/p), p a hundredth of E
  const auto number_of = [&](const Drive& drive) {
    c.stages = {{.drives = {drive}, .until = {.time = 1e-3}}};
    return advise(c).inertial_number;
  };
  const double height = box_height(c);
  CHECK(std::abs(number_of({Part::yy, Control::velocity, -0.4}) / (0.4 / height * time) - 1) < 1e-12);
  CHECK(std::abs(number_of({Part::xx, Control::velocity, 0.4}) / (0.4 / (4 * height) * time) - 1) < 1e-12);
  CHECK(std::abs(number_of({Part::xx, Control::rate, 30}) / (30 * time) - 1) < 1e-12);
  CHECK(std::abs(number_of({Part::xy, Control::rate, -50}) / (50 * time) - 1) < 1e-12);
  CHECK(number_of({Part::yy, Control::rest}) == 0);
  c.stages = {};
  c.experiment.loading = LoadingPath::shear;
  c.loading = {.wall_velocity = 1e-6, .confining_stress = 1e5, .shear_rate = 70, .max_shear = 1};
  CHECK(std::abs(advise(c).inertial_number / (70 * time) - 1) < 1e-12);
}
