#include <doctest/doctest.h>

#include <limits>
#include <utility>

#include "samples.hpp"
#include "softgrain/core/error.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

/// Stress along x in uniaxial strain of stretch s.
template <class Law>
double pressing(const Law& law, double s) {
  return law.stress(Mat<2>::diagonal({s, 1}))(0, 0);
}

std::string message_of(double young, double poisson) {
  try {
    (void)lame(young, poisson);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

template <int Dim, class Law>
void check_split(const Law& law) {
  const auto deviatoric = law.deviatoric();
  const auto U = law.volume();
  const auto theta = law.dilatation();
  for (const Mat<Dim>& F : sample_deformations<Dim>()) {
    const double J = theta.value(F);
    const Mat<Dim> dJ = theta.gradient(F);
    CHECK(deviatoric.energy(F) + U.energy(J) == doctest::Approx(law.energy(F)).epsilon(1e-12));
    CHECK(difference(deviatoric.stress(F) + U.derivative(J) * dJ, law.stress(F)) < 1e-13 * 20);
    Mat<Dim* Dim> A = deviatoric.tangent(F);
    add_outer(A, U.second_derivative(J), dJ, dJ);
    theta.add_second_derivative(A, U.derivative(J), F);
    CHECK(difference(A, law.tangent(F)) < 1e-13 * largest_entry(A));
    CHECK(U.derivative(J) ==
          doctest::Approx(derivative([&](double by) { return U.energy(J + by); })).epsilon(1e-9));
    CHECK(U.second_derivative(J) ==
          doctest::Approx(derivative([&](double by) { return U.derivative(J + by); })).epsilon(1e-9));
  }
}

}  // namespace

TEST_CASE("St Venant-Kirchhoff's stress is largest at a stretch of one over root three, then falls") {
  const auto law = st_venant_kirchhoff(E, nu);
  const double peak = 1 / std::sqrt(3.0);
  for (double s = 0.05; s < 1; s += 0.05) CHECK(pressing(law, s) >= pressing(law, peak));
  // P = M s (s^2 - 1) / 2 with the uniaxial strain modulus M.
  CHECK(pressing(law, peak) == doctest::Approx(-E * 0.7 / (1.3 * 0.4) / (3 * std::sqrt(3.0))).epsilon(1e-13));
  CHECK(law.tangent(Mat<2>::diagonal({peak - 0.01, 1}))(0, 0) < 0);
  CHECK(law.tangent(Mat<2>::diagonal({peak + 0.01, 1}))(0, 0) > 0);
  CHECK(pressing(law, 0) == 0);  // flat, and nothing resists
}

TEST_CASE("the other laws resist more the more they are pressed") {
  for_each_law([](const std::string& name, const auto& law) {
    if (name == "st_venant_kirchhoff") return;
    CAPTURE(name);
    for (double s = 0.1; s < 1; s += 0.05) CHECK(pressing(law, s) < pressing(law, s + 0.05));
  });
}

TEST_CASE("to flatten a neo-Hookean or Hencky point takes a stress without bound") {
  CHECK(pressing(neo_hookean(E, nu), 1e-3) < -1000 * E);
  CHECK(pressing(neo_hookean_quadratic(E, nu), 1e-3) < -300 * E);
  CHECK(pressing(hencky(E, nu), 1e-3) < -1000 * E);
  CHECK(pressing(corotated(E, nu), 1e-3) > -1.5 * E);
}

TEST_CASE("no law admits an inverted point or a NaN") {
  const Mat<2> inverted = Mat<2>::diagonal({-0.1, 1}), flat = Mat<2>::diagonal({0, 1});
  const Mat<2> nan = Mat<2>::diagonal({std::numeric_limits<double>::quiet_NaN(), 1});
  const auto law = neo_hookean(E, nu);
  CHECK(admissible(identity<2>()));
  CHECK_FALSE(admissible(inverted));
  CHECK_FALSE(admissible(flat));
  CHECK_FALSE(admissible(nan));
  CHECK(std::isnan(law.stress(inverted)(0, 0)));
}

TEST_CASE("one inverted point of eight is found and turns only its own lane into NaN") {
  const auto law = neo_hookean(E, nu);
  Mat<2, Wide> F = identity<2, Wide>();
  CHECK(all(admissible(F)));
  F(0, 0).set(5, -0.2);
  CHECK_FALSE(all(admissible(F)));
  CHECK(any(admissible(F)));
  const Mat<2, Wide> P = law.stress(F);
  for (int lane = 0; lane < Wide::size; ++lane) CHECK(std::isnan(P(0, 0)[lane]) == (lane == 5));
}

TEST_CASE("a law comes apart into a part of the order of mu and an energy of volume change") {
  check_split<2>(neo_hookean(E, nu));
  check_split<3>(neo_hookean(E, nu));
  check_split<2>(neo_hookean_quadratic(E, nu));
  check_split<3>(neo_hookean_quadratic(E, nu));
  check_split<2>(hencky(E, nu));
  check_split<3>(hencky(E, nu));
  check_split<2>(corotated(E, nu));
  check_split<2>(small_strain_hooke(E, nu));
  check_split<3>(small_strain_hooke(E, nu));
  check_split<2>(yeoh(E, nu, -0.1, 0.05));
  check_split<3>(yeoh(E, nu, -0.1, 0.05));
  check_split<2>(mooney_rivlin(E, nu, 0.1));
  check_split<3>(mooney_rivlin(E, nu, 0.1));
  check_split<2>(ogden(E, nu, {1.3, 5, -2}, 0.1, 0.2));
  check_split<3>(ogden(E, nu, {1.3, 5, -2}, 0.1, 0.2));
  check_split<2>(st_venant_kirchhoff(E, nu));
  check_split<3>(st_venant_kirchhoff(E, nu));
}

TEST_CASE("towards incompressibility all that grows without bound is in the energy of volume change") {
  const Mat<2> F = with_stretches<2>({0.8, 1.2});
  const auto check = [&](const auto& nearly, const auto& law) {
    CHECK(largest_entry(nearly.tangent(F)) > 1000 * E);
    CHECK(largest_entry(nearly.deviatoric().tangent(F)) < 1.2 * largest_entry(law.deviatoric().tangent(F)));
  };
  check(neo_hookean(E, 0.4999), neo_hookean(E, nu));
  check(neo_hookean_quadratic(E, 0.4999), neo_hookean_quadratic(E, nu));
  check(hencky(E, 0.4999), hencky(E, nu));
  check(corotated(E, 0.4999), corotated(E, nu));
  check(small_strain_hooke(E, 0.4999), small_strain_hooke(E, nu));
  check(st_venant_kirchhoff(E, 0.4999), st_venant_kirchhoff(E, nu));
}

namespace {

constexpr double almost = 0.49999999;  // incompressible

/// P of a bar pulled to s times its length, free across, which it finds by Newton's method.
template <class Law>
double pulled(const Law& law, double s) {
  double across = 1 / std::sqrt(s);
  for (int k = 0; k < 20; ++k) {
    const Mat<3> F = Mat<3>::diagonal({s, across, across});
    const Mat<9> A = law.tangent(F);
    across -= law.stress(F)(1, 1) / (A(4, 4) + A(4, 8));
  }
  return law.stress(Mat<3>::diagonal({s, across, across}))(0, 0);
}

}  // namespace

// Rivlin's: P = 2 (s - 1/s^2) (dpsi/dI1 + dpsi/dI2 / s).
TEST_CASE(
    "nearly incompressible rubber of Yeoh or Mooney in tension has the closed form of rubber elasticity") {
  const double c20 = -0.1, c30 = 0.05, c01 = 0.12;
  const double c10 = E / (4 * (1 + almost));
  for (const double s : {0.4, 0.8, 1.5, 3.0, 5.0}) {
    const double i = s * s + 2 / s - 3, factor = 2 * (s - 1 / (s * s));
    const double slope = c10 + 2 * c20 * i + 3 * c30 * i * i;
    CHECK(pulled(yeoh(E, almost, c20, c30), s) == doctest::Approx(factor * slope).epsilon(1e-4));
    CHECK(pulled(mooney_rivlin(E, almost, c01), s) ==
          doctest::Approx(factor * (c10 - c01 + c01 / s)).epsilon(1e-4));
  }
}

// Treloar's rubber as Ogden (1972) fitted it: mu_p = .63, .0012, -.01 MPa, alpha_p = 1.3, 5, -2.
TEST_CASE("Ogden's fit of Treloar's rubber in tension has the closed form, to seven times the length") {
  const double mu = (0.63 * 1.3 + 0.0012 * 5 + 0.01 * 2) / 2;
  const Ogden law =
      ogden(2 * (1 + almost) * mu, almost, {1.3, 5, -2}, 0.0012 * 5 / (2 * mu), 0.01 * 2 / (2 * mu));
  CHECK(law.mu_p[0] == doctest::Approx(0.63));
  CHECK(law.mu_p[2] == doctest::Approx(-0.01));
  for (const double s : {0.5, 1.2, 2.0, 4.0, 7.0}) {
    double expected = 0;
    for (const auto& [mu_p, alpha] : {std::pair{0.63, 1.3}, std::pair{0.0012, 5.0}, std::pair{-0.01, -2.0}})
      expected += mu_p * (std::pow(s, alpha - 1) - std::pow(s, -alpha / 2 - 1));
    CHECK(pulled(law, s) == doctest::Approx(expected).epsilon(1e-4));
  }
}

TEST_CASE("Ogden's law with the exponent 2 is neo-Hookean but for the volume, and with 2 and -2 Mooney's") {
  for (const Mat<2>& F : sample_deformations<2>()) {
    const Ogden two = ogden(E, nu, {2, -2, 7}, 0.25, 0);
    const MooneyRivlin mooney = mooney_rivlin(E, nu, 0.25 * two.mu / 2);
    CHECK(difference(two.stress(F), mooney.stress(F)) < 1e-13 * (1 + largest_entry(mooney.stress(F))));
    CHECK(difference(ogden(E, nu, {2, 0, 0}, 0, 0).stress(F), yeoh(E, nu, 0, 0).stress(F)) < 1e-12);
  }
}

TEST_CASE("rubber of Mooney or Ogden that would give way when stretched is refused by name") {
  CHECK_THROWS_WITH_AS(
      mooney_rivlin(4 * 1.3, nu, 1.5),
      "c01 must lie in [0, 1] Pa, so that C_10 = E/(4 (1 + nu)) - c01 is not below 0; got 1.5 Pa",
      UsageError);
  CHECK_THROWS_AS(mooney_rivlin(E, nu, -0.1), UsageError);
  CHECK_THROWS_WITH_AS(
      ogden(E, nu, {2, 4, -2}, 0.7, 0.3),
      "ogden_share_2 and ogden_share_3 must be >= 0 and leave something of the shear modulus to "
      "the first term, got 0.7 and 0.3",
      UsageError);
  CHECK_THROWS_WITH_AS(ogden(E, nu, {2, 0, -2}, 0.1, 0),
                       "ogden_exponent_2 must not be 0 where its term has a share", UsageError);
}

TEST_CASE("Yeoh rubber that would give way when stretched is refused by name") {
  CHECK_THROWS_AS(yeoh(E, nu, 0, -1), UsageError);
  CHECK_THROWS_AS(yeoh(E, nu, -1, 0.05), UsageError);
  CHECK_THROWS_WITH_AS(
      yeoh(4 * 1.3, nu, -0.2, 0.01),
      "stretched rubber must resist: c30 >= 0, and c20 > -sqrt(3 C_10 c30) = -0.1732 Pa with C_10 = "
      "E/(4 (1 + nu)) = 1 Pa; got c20 = -0.2 Pa, c30 = 0.01 Pa",
      UsageError);
  const Yeoh close = yeoh(E, nu, -std::sqrt(3 * E / 5.2 * 0.05) * 0.999, 0.05);
  for (double s = 1; s < 4; s += 0.01) CHECK(close.stress(Mat<2>::diagonal({s + 0.01, 1}))(0, 0) > 0);
}

TEST_CASE("elastic parameters out of range are refused by name") {
  CHECK(message_of(-1, 0.3) == "Young's modulus must be > 0 Pa, got -1");
  CHECK(message_of(0, 0.3) == "Young's modulus must be > 0 Pa, got 0");
  CHECK(message_of(std::numeric_limits<double>::infinity(), 0.3) ==
        "Young's modulus must be > 0 Pa, got inf");
  CHECK(message_of(std::numeric_limits<double>::quiet_NaN(), 0.3) ==
        "Young's modulus must be > 0 Pa, got nan");
  const std::string range = "Poisson's ratio must be > -1 and < 0.5 (0.5 is incompressible), got ";
  CHECK(message_of(1, 0.5) == range + "0.5");
  CHECK(message_of(1, -1) == range + "-1");
  CHECK(message_of(1, std::numeric_limits<double>::quiet_NaN()) == range + "nan");
  CHECK(message_of(1, -0.5).empty());
}

TEST_CASE("every law is made by its own factory, and stands at its place in the list") {
  CHECK(std::holds_alternative<NeoHookean<LogVolume>>(make_law(MaterialLaw::neo_hookean, E, nu)));
  CHECK(std::holds_alternative<NeoHookean<QuadraticVolume>>(
      make_law(MaterialLaw::neo_hookean_quadratic, E, nu)));
  CHECK(std::holds_alternative<Hencky>(make_law(MaterialLaw::hencky, E, nu)));
  CHECK(std::holds_alternative<Corotated>(make_law(MaterialLaw::corotated, E, nu)));
  CHECK(std::holds_alternative<SmallStrainHooke>(make_law(MaterialLaw::small_strain_hooke, E, nu)));
  CHECK(std::holds_alternative<StVenantKirchhoff>(make_law(MaterialLaw::st_venant_kirchhoff, E, nu)));
  CHECK(std::holds_alternative<Yeoh>(make_law(MaterialLaw::yeoh, E, nu)));
  CHECK(std::holds_alternative<VonMises>(make_law(MaterialLaw::von_mises, material)));
  MaterialParameters pulled_back = material;
  pulled_back.kinematic_modulus = 1;
  CHECK(std::holds_alternative<VonMisesKinematic>(make_law(MaterialLaw::von_mises, pulled_back)));
  CHECK(std::holds_alternative<VonMises>(make_law(MaterialLaw::norton, material)));
  CHECK(std::holds_alternative<MooneyRivlin>(make_law(MaterialLaw::mooney_rivlin, E, nu)));
  CHECK(std::holds_alternative<Ogden>(make_law(MaterialLaw::ogden, E, nu)));
  CHECK(std::holds_alternative<Prony>(make_law(MaterialLaw::prony, material)));
  CHECK_THROWS_AS(make_law(MaterialLaw::hencky, -1, nu), UsageError);
  for (const LawChoice& choice : law_choices()) {
    CHECK(&law_choice(choice.law) == &choice);
    CHECK(has_history(choice.make(material)) == choice.remembers());
  }
}

TEST_CASE("who chooses a law with a limited range is told so") {
  for (const LawChoice& choice : law_choices()) {
    const bool limited =
        choice.law == MaterialLaw::small_strain_hooke || choice.law == MaterialLaw::st_venant_kirchhoff;
    CHECK(choice.caution.empty() == !limited);
  }
}
