#include "softgrain/material/element_test.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "samples.hpp"
#include "softgrain/core/error.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

std::vector<ElementRow> drive(MaterialLaw law, ElementPath path, double strain, double rate = 1,
                              int steps = 100, MaterialParameters parameters = material) {
  return drive_point(make_law(law, parameters), {path, strain, rate, steps});
}

/// work = stored + dissipated at the end, the length of the steps aside.
void check_balance(const std::vector<ElementRow>& rows, double tolerance) {
  const ElementRow& end = rows.back();
  CHECK(end.work > 0);
  CHECK(end.stored + end.dissipated == doctest::Approx(end.work).epsilon(tolerance));
}

}  // namespace

TEST_CASE("a neo-Hookean point in simple shear has mu gamma, mu gamma^2 and no stress across the shear") {
  const double mu = 2 / 2.6;
  const auto rows = drive(MaterialLaw::neo_hookean, ElementPath::shear, 0.6);
  REQUIRE(rows.size() == 101);
  CHECK(rows.front().von_mises == 0);
  for (const ElementRow& row : rows) {
    const double gamma = row.strain;
    CHECK(std::abs(row.stress_xy - mu * gamma) < 1e-14);
    CHECK(std::abs(row.stress_xx - mu * gamma * gamma) < 1e-14);
    CHECK(std::abs(row.stress_yy) + std::abs(row.stress_zz) < 1e-14);
    CHECK(row.pressure == doctest::Approx(-mu * gamma * gamma / 3));
    CHECK(row.stored == doctest::Approx(mu * gamma * gamma / 2));
    CHECK(row.dissipated == 0);
  }
  CHECK(rows.back().strain == 0.6);
  CHECK(rows.back().time == doctest::Approx(0.6));
  check_balance(rows, 1e-3);
}

// Hencky: tau_a = 2 mu e_a + lambda ln J; free along y, e_y = -lambda e/(lambda + 2 mu).
TEST_CASE("a Hencky point pressed between smooth walls has Hooke's stress in logarithmic strains") {
  const double lambda = 2 * 0.3 / (1.3 * 0.4), mu = 2 / 2.6;
  for (const double strain : {-0.5, 0.3}) {
    const ElementRow row = drive(MaterialLaw::hencky, ElementPath::uniaxial, strain).back();
    const double across = -lambda * strain / (lambda + 2 * mu), J = std::exp(strain + across);
    CHECK(row.stretch == doctest::Approx(std::exp(across)).epsilon(1e-12));
    CHECK(row.stress_xx ==
          doctest::Approx((2 * mu * strain + lambda * (strain + across)) / J).epsilon(1e-12));
    CHECK(std::abs(row.stress_yy) < 1e-13);
    CHECK(row.stress_zz == doctest::Approx(lambda * (strain + across) / J).epsilon(1e-12));
    const ElementRow held = drive(MaterialLaw::hencky, ElementPath::confined, strain).back();
    CHECK(held.stress_xx == doctest::Approx((2 * mu + lambda) * strain / std::exp(strain)).epsilon(1e-12));
    CHECK(held.stress_yy == doctest::Approx(lambda * strain / std::exp(strain)).epsilon(1e-12));
    CHECK(held.stretch == 1);
  }
}

TEST_CASE("perfect plasticity in plane strain ends at two over root three times the yield stress") {
  MaterialParameters soft = material;
  soft.yield_stress = 0.002;  // E/1000
  const auto rows = drive(MaterialLaw::von_mises, ElementPath::uniaxial, 0.2, 1, 400, soft);
  const ElementRow& end = rows.back();
  const double J = std::exp(end.strain) * end.stretch;  // yield is in Kirchhoff's stress
  CHECK(J * end.stress_xx == doctest::Approx(2 / std::sqrt(3.0) * 0.002).epsilon(1e-4));
  CHECK(J * end.von_mises == doctest::Approx(0.002).epsilon(1e-10));
  CHECK(end.stress_zz == doctest::Approx(end.stress_xx / 2).epsilon(1e-3));
  CHECK(end.plastic_strain == doctest::Approx(2 / std::sqrt(3.0) * 0.2).epsilon(1e-2));
  CHECK(end.dissipated == doctest::Approx(0.002 * end.plastic_strain).epsilon(1e-10));
  check_balance(rows, 3e-3);
}

TEST_CASE("a point that creeps comes to Norton's stress for the rate at which it is sheared") {
  for (const double rate : {0.01, 1.0}) {
    const auto rows = drive(MaterialLaw::norton, ElementPath::uniaxial, 0.5, rate, 400);
    const ElementRow& end = rows.back();
    // flow at constant volume: alpha' = 2/root 3 of the rate along x
    const double expected = 0.1 * std::pow(2 / std::sqrt(3.0) * rate / 0.2, 0.25);
    const double J = std::exp(end.strain) * end.stretch;
    CHECK(J * end.von_mises == doctest::Approx(expected).epsilon(1e-3));
    check_balance(rows, 1e-2);
  }
}

TEST_CASE("a cycle goes there, back and there again: metal is left with stress, rubber without") {
  const auto metal = drive(MaterialLaw::von_mises, ElementPath::cycle, -0.2, 1, 50);
  REQUIRE(metal.size() == 151);
  CHECK(metal[50].strain == -0.2);
  CHECK(metal[100].strain == 0);
  CHECK(metal[150].strain == -0.2);
  CHECK(metal[50].stress_xx < -0.05);
  CHECK(metal[100].stress_xx > 0.05);  // it yields back
  CHECK(metal[150].plastic_strain > 2.5 * metal[50].plastic_strain);
  CHECK(metal[150].time == doctest::Approx(0.6));
  const auto rubber = drive(MaterialLaw::yeoh, ElementPath::cycle, -0.2, 1, 50);
  CHECK(std::abs(rubber[100].stress_xx) < 1e-12);
  CHECK(std::abs(rubber[100].work) < 1e-12);
  const auto gel = drive(MaterialLaw::prony, ElementPath::cycle, -0.2, 1, 50);
  CHECK(gel[100].stress_xx > 0.01);
  CHECK(gel[100].work > 0.01 * gel[50].work);
  check_balance(gel, 1e-3);
}

TEST_CASE("every law can be driven along every path, and its work is accounted for") {
  for (const LawChoice& choice : law_choices())
    for (const ElementPath path :
         {ElementPath::shear, ElementPath::uniaxial, ElementPath::confined, ElementPath::cycle}) {
      CAPTURE(choice.name);
      const auto rows = drive_point(choice.make(material), {path, -0.1, 1, 200});
      CHECK(std::isfinite(rows.back().stress_xx));
      check_balance(rows, 0.02);
    }
}

TEST_CASE("an element test that cannot be is refused, and a point that gives way is told") {
  const AnyLaw law = make_law(MaterialLaw::hencky, E, nu);
  CHECK_THROWS_WITH_AS(drive_point(law, {.strain = 0}), "the strain must be a number other than 0, got 0",
                       UsageError);
  CHECK_THROWS_WITH_AS(drive_point(law, {.rate = 0}), "the rate must be > 0 1/s, got 0", UsageError);
  CHECK_THROWS_AS(drive_point(law, {.steps = 0}), UsageError);
}
