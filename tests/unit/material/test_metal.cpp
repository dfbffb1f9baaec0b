#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/material/von_mises.hpp"

using namespace softgrain;

namespace {

using State = VonMises::State<2, double>;

State undeformed() { return VonMises::undeformed<2, double>(); }

/// Shear at constant volume: stretches exp(x), exp(-x), 1.
Mat<2> pure_shear(double x) { return Mat<2>::diagonal({std::exp(x), std::exp(-x)}); }

/// tau = P F^T [Pa].
Mat<2> kirchhoff(const VonMises& law, const Mat<2>& F, const State& state) {
  return law.stress(F, state, 0) * transpose(F);
}

/// A law of yield stress 1 with nu = 0.3.
VonMises metal(double young, FlowRule rule = {}) {
  rule.yield_stress = 1;
  return von_mises(young, 0.3, rule);
}

struct Sheared {
  Mat<2> tau;
  double alpha = 0, dissipated = 0, work = 0;
};
/// Simple shear up to gamma.
Sheared shear(const VonMises& law, double gamma, int steps) {
  State state = undeformed();
  Sheared out;
  Mat<2> F = identity<2>(), before;
  for (int k = 1; k <= steps; ++k) {
    F(0, 1) = gamma * k / steps;
    const Mat<2> P = law.stress(F, state, 0);
    const auto [after, dissipated] = law.advance(F, state, 0);
    out.dissipated += dissipated;
    out.work += 0.5 * (P + before)(0, 1) * gamma / steps;
    state = after;
    before = P;
  }
  out.tau = kirchhoff(law, F, state);
  out.alpha = state[3];
  return out;
}

}  // namespace

TEST_CASE("pressed in one direction metal has the closed form of perfect plasticity") {
  const struct {
    double young, axial, lateral, alpha;
  } known[] = {{100, -17.333333333333, -16.333333333333, 0.124666666667},
               {1000, -167.333333333333, -166.333333333333, 0.132466666667}};
  for (const auto& [young, axial, lateral, alpha] : known)
    for (const int steps : {1, 100}) {
      const VonMises law = metal(young);
      State state = undeformed();
      for (int k = 1; k <= steps; ++k)
        state = law.advance(Mat<2>::diagonal({std::exp(-0.2 * k / steps), 1}), state, 0).state;
      const Mat<2> F = Mat<2>::diagonal({std::exp(-0.2), 1});
      CHECK(kirchhoff(law, F, state)(0, 0) == doctest::Approx(axial).epsilon(1e-9));
      CHECK(kirchhoff(law, F, state)(1, 1) == doctest::Approx(lateral).epsilon(1e-9));
      CHECK(law.stress_across(F, state, 0) == doctest::Approx(lateral).epsilon(1e-9));
      CHECK(state[3] == doctest::Approx(alpha).epsilon(1e-9));
    }
}

TEST_CASE("pressed alike in both directions of the plane metal flows across it") {
  const VonMises law = metal(100);
  const double K = 100 / (3 * 0.4), mu = 100 / 2.6;
  for (const double x : {-0.3, -0.1, 0.2}) {
    const Mat<2> F = Mat<2>::diagonal({std::exp(x), std::exp(x)});
    const State state = law.advance(F, undeformed(), 0).state;
    CHECK(kirchhoff(law, F, state)(0, 0) ==
          doctest::Approx(2 * K * x + (x < 0 ? -1 : 1) / 3.0).epsilon(1e-12));
    CHECK(law.stress_across(F, state, 0) ==
          doctest::Approx(2 * K * x - (x < 0 ? -2 : 2) / 3.0).epsilon(1e-12));
    CHECK(state[3] == doctest::Approx(2.0 / 3 * (std::abs(x) - 1 / (2 * mu))).epsilon(1e-12));
  }
}

TEST_CASE("Voce's metal in pure shear has the numbers of an independent integration") {
  const auto check = [](const FlowRule& rule, double x, double alpha, double stress) {
    const VonMises law = metal(100, rule);
    const State after = law.advance(pure_shear(x), undeformed(), 0).state;
    CHECK(after[3] == doctest::Approx(alpha).epsilon(1e-8));
    CHECK(kirchhoff(law, pure_shear(x), after)(0, 0) == doctest::Approx(stress).epsilon(2e-9));
  };
  check({.saturation = 1, .rate = 10}, 0.05, 0.045879420, 0.789789009);
  check({.saturation = 1, .rate = 10}, 0.3, 0.329398411, 1.133277540);
  check({.hardening = 0.2, .saturation = 0.5, .rate = 20}, 0.05, 0.046368877, 0.757182689);
  check({.hardening = 0.2, .saturation = 0.5, .rate = 20}, 0.3, 0.332838810, 0.904087290);
}

TEST_CASE("viscous metal sheared at a steady rate carries the flow stress of that rate, and relaxes") {
  const double eta_rate = 0.5, eta = 0.2, rate = eta_rate / eta;  // x' = 2.5 1/s
  const VonMises law = metal(100, {.viscosity = eta});
  State state = undeformed();
  const double time = 4e-4;
  double x = 0;
  for (int k = 0; k < 1000; ++k) {
    x += rate * time;
    state = law.advance(pure_shear(x), state, time).state;
  }
  // tau_11 = (1 + 2 eta x'/root 3)/root 3
  CHECK(kirchhoff(law, pure_shear(x), state)(0, 0) == doctest::Approx(0.910683603).epsilon(1e-8));
  // at rest what is over the yield stress falls as exp(-t/T), T = eta/(3 mu): to first order in the step
  const double T = eta / (3 * 100 / 2.6), over = 0.910683603 - 1 / std::sqrt(3.0);
  double error[2];
  for (const int steps : {1000, 2000}) {
    State resting = state;
    for (int k = 0; k < steps; ++k) resting = law.advance(pure_shear(x), resting, 2 * T / steps).state;
    const double left = kirchhoff(law, pure_shear(x), resting)(0, 0) - 1 / std::sqrt(3.0);
    error[steps / 1000 - 1] = left / over - std::exp(-2.0);
  }
  CHECK(std::abs(error[0]) < 5e-4);
  CHECK(error[0] / error[1] == doctest::Approx(2).epsilon(0.01));
}

TEST_CASE("metal in simple shear has the closed form, without oscillation, and hardens as it must") {
  const struct {
    double young, hardening, gamma, t12, t11, alpha, dissipated, work;
  } known[] = {{100, 0, 2, .5772852, .0086660, 1.1459055, 1.1459055, 1.1502389},
               {100, 1, 2, 1.2325194, .0391867, 1.1358649, 1.7809594, 1.8007277},
               {1000, 10, 1, 3.8768243, .0387471, .5715192, 2.2046902, 2.2242308}};
  for (const auto& [young, hardening, gamma, t12, t11, alpha, dissipated, work] : known) {
    const Sheared at = shear(metal(young, {.hardening = hardening}), gamma, 4000);
    CHECK(at.tau(0, 1) == doctest::Approx(t12).epsilon(1e-4));
    CHECK(at.tau(0, 0) == doctest::Approx(-at.tau(1, 1)).epsilon(1e-9));
    CHECK(at.alpha == doctest::Approx(alpha).epsilon(1e-4));
    CHECK(at.dissipated == doctest::Approx(dissipated).epsilon(2e-4));
    CHECK(at.work == doctest::Approx(work).epsilon(2e-4));
  }
  // the normal stress is second order, and its error first order in the step
  double error[3];
  for (int k = 0; k < 3; ++k)
    error[k] = std::abs(shear(metal(100), 2, 100 * (k == 0 ? 1 : k == 1 ? 10 : 100)).tau(0, 0) - .0086660);
  CHECK(error[1] < 0.1 * .0086660);
  CHECK(error[0] / error[1] == doctest::Approx(10).epsilon(0.2));
  CHECK(error[1] / error[2] == doctest::Approx(10).epsilon(0.2));
}

TEST_CASE("hardening is isotropic: the reverse yield stress is the one reached") {
  const VonMises law = metal(100, {.hardening = 1});
  const State after = law.advance(pure_shear(0.3), undeformed(), 0).state;
  CHECK(kirchhoff(law, pure_shear(0.3), after)(0, 0) == doctest::Approx(.770671119).epsilon(1e-9));
  const double mu = 100 / 2.6, reach = .770671119 / mu;  // from tau to -tau
  CHECK(law.advance(pure_shear(0.3 - 0.9999999 * reach), after, 0).state[3] == after[3]);
  CHECK(law.advance(pure_shear(0.3 - 1.0000001 * reach), after, 0).state[3] > after[3]);
}
