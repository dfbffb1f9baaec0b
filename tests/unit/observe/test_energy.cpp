#include "softgrain/observe/energy.hpp"

#include <doctest/doctest.h>

using namespace softgrain;

TEST_CASE("the paper's packing at 5 m/s has an inertial number of about 0.01 at 0.5 MPa") {
  // 35.3 mm high, grains of 1.9 mm and 990 kg/m^3
  const double I = inertial_number(-5 / 35.3e-3, 1.9e-3, 990, 0.5e6);
  CHECK(I == doctest::Approx(0.012).epsilon(0.01));
  // a tenth of the pressure: sqrt(10) times
  CHECK(inertial_number(5 / 35.3e-3, 1.9e-3, 990, 0.05e6) == doctest::Approx(I * std::sqrt(10.0)));
  CHECK(inertial_number(1, 1e-3, 1000, 0) == 0);  // a number, whatever reads the table
}
