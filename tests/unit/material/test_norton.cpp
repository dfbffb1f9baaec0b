#include <doctest/doctest.h>

#include "samples.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/material/von_mises.hpp"
#include "support/random_numbers.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

using State = VonMises::State<2, double>;

constexpr double A = 0.2, stress_0 = 0.1, n = 4;

VonMises creeping(double exponent) {
  const Lame elastic = lame(E, nu);
  return {elastic.lambda + 2.0 / 3 * elastic.mu, elastic.mu, creep_rule(A, stress_0, exponent)};
}
Mat<2> pure_shear(double x) { return Mat<2>::diagonal({std::exp(x), std::exp(-x)}); }
/// Von Mises' stress in pure shear: root 3 tau_11.
double von_mises_stress(const VonMises& law, double x, const State& state) {
  return std::sqrt(3.0) * (law.stress(pure_shear(x), state, 0) * transpose(pure_shear(x)))(0, 0);
}

}  // namespace

TEST_CASE("sheared at a steady rate a point creeps at Norton's stress for that rate") {
  for (const double exponent : {1.0, n, 7.5})
    for (const double alpha_rate : {0.01, 0.2, 3.0}) {
      CAPTURE(exponent);
      const VonMises law = creeping(exponent);
      const double expected = stress_0 * std::pow(alpha_rate / A, 1 / exponent);
      // Until the stress is steady: some elastic strains' time.
      const double x_rate = alpha_rate * std::sqrt(3.0) / 2, dt = 0.2 * expected / (2 * law.mu * x_rate);
      State state = VonMises::undeformed<2, double>();
      double x = 0;
      for (int k = 0; k < 400; ++k) {
        x += x_rate * dt;
        state = law.advance(pure_shear(x), state, dt).state;
      }
      CHECK(von_mises_stress(law, x, state) == doctest::Approx(expected).epsilon(1e-9));
    }
}

// q' = -3 mu A (q/sigma_0)^n: q^(1-n) grows linearly in time.
TEST_CASE("held at a strain the stress of creep falls as the power law's closed form, to first order") {
  const VonMises law = creeping(n);
  const double x = 0.1, time = 0.5;
  const double start = 2 * std::sqrt(3.0) * law.mu * x;
  const double rate = 3 * law.mu * A / stress_0 * (n - 1);
  const double expected = stress_0 * std::pow(std::pow(start / stress_0, 1 - n) + rate * time, 1 / (1 - n));
  double error[2];
  for (const int half : {0, 1}) {
    const int steps = 4000 << half;
    State state = VonMises::undeformed<2, double>();
    for (int k = 0; k < steps; ++k) state = law.advance(pure_shear(x), state, time / steps).state;
    error[half] = von_mises_stress(law, x, state) / expected - 1;
  }
  CHECK(std::abs(error[1]) < 2e-3);
  CHECK(error[0] / error[1] == doctest::Approx(2).epsilon(0.05));
}

TEST_CASE("stress and tangent of a point that creeps are derivatives of its incremental potential") {
  constexpr double dt = 0.05;
  for (const double exponent : {1.0, n}) {
    const VonMises law = creeping(exponent), part = law.deviatoric();
    CHECK(part.bulk == doctest::Approx(5 * stress_0));
    const State once = law.advance({{1.25, 0.3, -0.1, 0.9}}, VonMises::undeformed<2, double>(), dt).state;
    const State state = law.advance({{0.9, -0.2, 0.4, 1.3}}, once, dt).state;
    for (const Mat<2>& F : sample_deformations<2>()) {
      const Mat<4> tangent = law.tangent(F, state, dt);
      CHECK(difference(law.stress(F, state, dt),
                       gradient([&](const Mat<2>& G) { return law.energy(G, state, dt); }, F)) < 1e-8);
      CHECK(difference(tangent, gradient_of_stress([&](const Mat<2>& G) { return law.stress(G, state, dt); },
                                                   F)) < 1e-7);
      CHECK(difference(tangent, transpose(tangent)) < 1e-12 * largest_entry(tangent));
    }
  }
}

TEST_CASE(
    "a point that has hardly been strained answers as an elastic one, whatever its exponent and however "
    "turned") {
  // With W'' = mu dshare/du over a floor of 1e-20 for u the tangent was up to 90 mu below zero at 1.05, and
  // the factor of a grain in flight was not a number.
  const double elastic_most = 2 * creeping(1).mu;
  for (const double exponent : {1.05, 1.2, 1.5, 3.0})
    for (const double strain : {0.0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-9, 1e-8}) {
      const VonMises part = creeping(exponent).deviatoric();
      RandomNumbers random(7);
      double least = 0, most = 0;
      for (int turn = 0; turn < 40; ++turn) {
        const double c = std::cos(0.16 * turn), s = std::sin(0.16 * turn);
        Mat<2> F{{c, -s, s, c}};
        for (double& f : F.c) f += strain * random.uniform(-1, 1);
        const Mat<4> tangent = part.tangent(F, VonMises::undeformed<2, double>(), 0.1);
        for (int k = 0; k < 20; ++k) {
          Vec<4> d;
          for (int i = 0; i < 4; ++i) d[i] = random.uniform(-1, 1);
          const double stiffness = dot(d, tangent * d) / dot(d, d);
          least = std::min(least, stiffness), most = std::max(most, stiffness);
        }
      }
      CAPTURE(exponent);
      CAPTURE(strain);
      CHECK(least > -1e-5 * elastic_most);
      CHECK(most < 1.001 * elastic_most);
    }
}

TEST_CASE("nothing creeps in no time, nor without a deviator, and an undeformed point is quiet") {
  const VonMises law = creeping(1);
  const State rest = VonMises::undeformed<2, double>();
  CHECK(law.advance(pure_shear(0.2), rest, 0).state == rest);
  const Mat<4> A_rest = law.tangent(identity<2>(), rest, 0.01);
  for (const double x : {1e-17, 1e-15, 1e-12, 1e-9}) {
    const Mat<2> F{{1 + x, 2 * x, -x, 1 - x}};
    CHECK(difference(law.tangent(F, rest, 0.01), A_rest) < 1e-7);
    CHECK(law.advance(F, rest, 0.01).dissipated < 1e-17);
  }
}

TEST_CASE("what a point that creeps dissipates is stress times rate, and the work closes") {
  const VonMises law = creeping(n);
  State state = VonMises::undeformed<2, double>();
  double work = 0, dissipated = 0;
  constexpr int steps = 4000;
  const auto strain = [](int k) { return 0.2 * std::sin(2 * 3.14159265358979324 * k / steps); };
  for (int k = 0; k < steps; ++k) {
    const Mat<2> start = pure_shear(strain(k)), end = pure_shear(strain(k + 1));
    const auto [next, taken] = law.advance(end, state, 1.0 / steps);
    work += contract(0.5 * (law.stress(start, state, 0) + law.stress(end, next, 0)), end - start);
    const double stress = std::abs(von_mises_stress(law, strain(k + 1), next));
    CHECK(taken == doctest::Approx(stress * (next[3] - state[3])).epsilon(1e-8));
    dissipated += taken;
    state = next;
  }
  CHECK(work - law.stored(identity<2>(), state) == doctest::Approx(dissipated).epsilon(2e-3));
}

TEST_CASE("lanes that creep do not see one another") {
  const VonMises law = creeping(n);
  Mat<2, Wide> alike = identity<2, Wide>(), mixed = alike;
  for (int lane = 0; lane < Wide::size; ++lane)
    for (std::size_t k = 0; k < 4; ++k) {
      alike.c[k].set(lane, pure_shear(0.2).c[k]);
      mixed.c[k].set(lane, pure_shear(lane == 3 ? 0.2 : 0.01 + 0.1 * lane).c[k]);
    }
  const auto rest = VonMises::undeformed<2, Wide>();
  const auto a = law.advance(alike, rest, 0.1).state, b = law.advance(mixed, rest, 0.1).state;
  const auto alone = law.advance(pure_shear(0.2), VonMises::undeformed<2, double>(), 0.1).state;
  for (std::size_t k = 0; k < a.size(); ++k) {
    CHECK(a[k][3] == b[k][3]);
    CHECK(a[k][3] == doctest::Approx(alone[k]).epsilon(1e-13));
  }
}

TEST_CASE("numbers that no creep has are refused by name") {
  CHECK_THROWS_WITH_AS(creep_rule(0, 1, 2),
                       "creep needs a creep_rate > 0 1/s and a creep_stress > 0 Pa, got 0 and 1", UsageError);
  CHECK_THROWS_AS(creep_rule(1, 0, 2), UsageError);
  CHECK_THROWS_WITH_AS(creep_rule(1, 1, 0.5), "the exponent of creep must be >= 1, got 0.5", UsageError);
}
