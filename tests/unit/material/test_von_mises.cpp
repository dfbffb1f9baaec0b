#include <doctest/doctest.h>

#include "samples.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/material/von_mises.hpp"

using namespace softgrain;
using namespace softgrain::test;

static_assert(SplitHistoryLaw<VonMises, 2> && HistoryLaw<VonMises, 3>);
static_assert(!ElasticLaw<VonMises, 2> && !HistoryLaw<Hencky, 2>);

namespace {

using State = VonMises::State<2, double>;

constexpr double dt = 0.1;
const VonMises linear = von_mises(E, nu, {.yield_stress = 0.05, .hardening = 0.3});
const VonMises perfect = von_mises(E, nu, {.yield_stress = 0.05});
const VonMises voce =
    von_mises(E, nu, {.yield_stress = 0.05, .hardening = 0.02, .saturation = 0.1, .rate = 12});
const VonMises viscous = von_mises(
    E, nu, {.yield_stress = 0.05, .hardening = 0.02, .saturation = 0.1, .rate = 12, .viscosity = 0.03});

template <class Check>
void for_each_rule(Check check) {
  check("perfect", perfect);
  check("linear", linear);
  check("voce", voce);
  check("viscous", viscous);
}

template <int Dim>
VonMises::State<Dim, double> undeformed() {
  return VonMises::undeformed<Dim, double>();
}
Mat<2> in(const Mat<2>& F, std::integral_constant<int, 2>) { return F; }
Mat<3> in(const Mat<2>& F, std::integral_constant<int, 3>) { return embedded(F); }

/// A point that has flowed along two different axes, in plane strain: F_p is not symmetric.
template <int Dim = 2>
VonMises::State<Dim, double> flowed(const VonMises& law) {
  constexpr std::integral_constant<int, Dim> space;
  const auto once = law.advance(in(Mat<2>{{1.25, 0.3, -0.1, 0.9}}, space), undeformed<Dim>(), dt).state;
  return law.advance(in(Mat<2>{{0.9, -0.2, 0.4, 1.3}}, space), once, dt).state;
}

/// Shear at constant volume: stretches exp(x), exp(-x), 1.
Mat<2> pure_shear(double x) { return Mat<2>::diagonal({std::exp(x), std::exp(-x)}); }

/// tau = P F^T [Pa].
Mat<2> kirchhoff(const VonMises& law, const Mat<2>& F, const State& state, double time = 0) {
  return law.stress(F, state, time) * transpose(F);
}

template <int Dim>
void check_derivatives(const VonMises& law) {
  int flowing = 0;
  const auto state = flowed<Dim>(law);
  for (const Mat<Dim>& F : sample_deformations<Dim>()) {
    flowing += law.advance(F, state, dt).state.back() > state.back() ? 1 : 0;
    const auto energy = [&](const Mat<Dim>& G) { return law.energy(G, state, dt); };
    const auto stress = [&](const Mat<Dim>& G) { return law.stress(G, state, dt); };
    const Mat<Dim* Dim> A = law.tangent(F, state, dt);
    CHECK(difference(law.stress(F, state, dt), gradient(energy, F)) < 1e-9);
    CHECK(difference(A, gradient_of_stress(stress, F)) < 1e-8);
    CHECK(difference(A, transpose(A)) < 1e-13 * largest_entry(A));
  }
  CHECK(flowing > 3);
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
  State state = undeformed<2>();
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

TEST_CASE("below yield, and under any pressure, a von Mises point is a Hencky point") {
  const Hencky elastic = hencky(E, nu);
  for (const Mat<2>& F : {pure_shear(0.01), Mat<2>{{1.01, 0.02, -0.01, 1.01}}}) {
    CHECK(difference(linear.stress(F, undeformed<2>(), 0), elastic.stress(F)) < 1e-15);
    CHECK(difference(linear.tangent(F, undeformed<2>(), 0), elastic.tangent(F)) < 1e-14);
    CHECK(linear.energy(F, undeformed<2>(), 0) == doctest::Approx(elastic.energy(F)).epsilon(1e-13));
    CHECK(linear.advance(F, undeformed<2>(), 0).state == undeformed<2>());
  }
  const Mat<3> pressed = Mat<3>::diagonal({0.5, 0.5, 0.5});
  CHECK(linear.advance(pressed, undeformed<3>(), 0).state == undeformed<3>());
  CHECK(difference(linear.stress(pressed, undeformed<3>(), 0), elastic.stress(pressed)) < 1e-14);
}

TEST_CASE("a von Mises point yields in shear at the yield stress over root three") {
  for (const double x : {0.05, 0.2, 0.7}) {
    const Mat<2> tau = kirchhoff(perfect, pure_shear(x), undeformed<2>());
    CHECK(tau(0, 0) == doctest::Approx(0.05 / std::sqrt(3.0)).epsilon(1e-13));
    CHECK(tau(1, 1) == doctest::Approx(-0.05 / std::sqrt(3.0)).epsilon(1e-13));
  }
}

TEST_CASE("with hardening the shear stress rises by the tangent modulus") {
  // d tau/dx = 2 mu H / (3 mu + H) beyond yield at x_y = yield / (2 root(3) mu).
  const double mu = 2 / 2.6, H = 0.3, at_yield = 0.05 / std::sqrt(3.0);
  const double x = 0.3, beyond = x - at_yield / (2 * mu);
  const State after = linear.advance(pure_shear(x), undeformed<2>(), 0).state;
  CHECK(kirchhoff(linear, pure_shear(x), undeformed<2>())(0, 0) ==
        doctest::Approx(at_yield + 2 * mu * H / (3 * mu + H) * beyond).epsilon(1e-13));
  CHECK(after[3] == doctest::Approx(2 * std::sqrt(3.0) * mu / (3 * mu + H) * beyond).epsilon(1e-13));
}

// alpha = 2/3 (|e| - 1/(2 mu)), axial tau = K e - 2/3, lateral K e + 1/3, in units of the yield stress.
TEST_CASE("pressed in one direction metal has the closed form of perfect plasticity") {
  const struct {
    double young, axial, lateral, alpha;
  } known[] = {{100, -17.333333333333, -16.333333333333, 0.124666666667},
               {1000, -167.333333333333, -166.333333333333, 0.132466666667}};
  for (const auto& [young, axial, lateral, alpha] : known)
    for (const int steps : {1, 100}) {
      const VonMises law = metal(young);
      State state = undeformed<2>();
      for (int k = 1; k <= steps; ++k)
        state = law.advance(Mat<2>::diagonal({std::exp(-0.2 * k / steps), 1}), state, 0).state;
      const Mat<2> F = Mat<2>::diagonal({std::exp(-0.2), 1});
      CHECK(kirchhoff(law, F, state)(0, 0) == doctest::Approx(axial).epsilon(1e-9));
      CHECK(kirchhoff(law, F, state)(1, 1) == doctest::Approx(lateral).epsilon(1e-9));
      CHECK(law.stress_across(F, state, 0) == doctest::Approx(lateral).epsilon(1e-9));
      CHECK(state[3] == doctest::Approx(alpha).epsilon(1e-9));
    }
}

// tau = 2 K ln s -+ 1/3, alpha = 2/3 (|ln s| - 1/(2 mu)).
TEST_CASE("pressed alike in both directions of the plane metal flows across it") {
  const VonMises law = metal(100);
  const double K = 100 / (3 * 0.4), mu = 100 / 2.6;
  for (const double x : {-0.3, -0.1, 0.2}) {
    const Mat<2> F = Mat<2>::diagonal({std::exp(x), std::exp(x)});
    const State state = law.advance(F, undeformed<2>(), 0).state;
    CHECK(kirchhoff(law, F, state)(0, 0) ==
          doctest::Approx(2 * K * x + (x < 0 ? -1 : 1) / 3.0).epsilon(1e-12));
    CHECK(law.stress_across(F, state, 0) ==
          doctest::Approx(2 * K * x - (x < 0 ? -2 : 2) / 3.0).epsilon(1e-12));
    CHECK(state[3] == doctest::Approx(2.0 / 3 * (std::abs(x) - 1 / (2 * mu))).epsilon(1e-12));
  }
}

// Numbers of an independent integrator of the flow rule (DOP853 to 1e-12).
TEST_CASE("Voce's metal in pure shear has the numbers of an independent integration") {
  const auto check = [](const FlowRule& rule, double x, double alpha, double stress) {
    const VonMises law = metal(100, rule);
    const State after = law.advance(pure_shear(x), undeformed<2>(), 0).state;
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
  State state = undeformed<2>();
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

// t12 = 1/root 3 / cosh w, t11 = 1/root 3 tanh w, w = 1/(root 3 mu), alpha by integration.
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

TEST_CASE("stress and tangent of a point that has flowed are derivatives of its incremental potential") {
  for_each_rule([](const char* name, const VonMises& law) {
    CAPTURE(name);
    check_derivatives<2>(law);
    check_derivatives<3>(law);
    check_derivatives<2>(law.deviatoric());
  });
}

TEST_CASE("flow keeps the volume, and the state after a step holds the stress of its end") {
  const Mat<2> F{{1.4, 0.2, 0.3, 0.8}};
  for_each_rule([&](const char* name, const VonMises& law) {
    CAPTURE(name);
    const State before = flowed(law), after = law.advance(F, before, dt).state;
    CHECK(after[3] > before[3]);
    CHECK(difference(law.stress(F, after, 0), law.stress(F, before, dt)) < 1e-14);
    CHECK(law.advance(F, after, 0).state[3] == doctest::Approx(after[3]).epsilon(1e-14));
  });
  const auto in_space = linear.advance(embedded(F), flowed<3>(linear), dt).state;
  Mat<3> G;
  std::copy(in_space.begin(), in_space.end() - 1, G.c.begin());
  CHECK(determinant(G) == doctest::Approx(1).epsilon(1e-14));
}

TEST_CASE("plane strain is flow in space with a stretch of one across the plane") {
  for_each_rule([](const char* name, const VonMises& law) {
    CAPTURE(name);
    State plane = undeformed<2>();
    auto space = undeformed<3>();
    for (int k = 0; k < 200; ++k) {
      const double t = 0.1 * k;
      const Mat<2> F{
          {1 + 0.3 * std::sin(t), 0.4 * std::sin(1.7 * t), 0.3 * std::sin(0.6 * t), 1 - 0.2 * std::cos(t)}};
      const Mat<2> P = law.stress(F, plane, dt);
      const Mat<3> Q = law.stress(embedded(F), space, dt);
      CHECK(difference(P, Mat<2>{{Q(0, 0), Q(0, 1), Q(1, 0), Q(1, 1)}}) < 1e-12);
      CHECK(law.stress_across(F, plane, dt) == doctest::Approx(Q(2, 2)).epsilon(1e-10));
      CHECK(law.stored(F, plane) == doctest::Approx(law.stored(embedded(F), space)).epsilon(1e-10));
      const auto plane_step = law.advance(F, plane, dt);
      const auto space_step = law.advance(embedded(F), space, dt);
      CHECK(plane_step.dissipated == doctest::Approx(space_step.dissipated).epsilon(1e-9));
      plane = plane_step.state;
      space = space_step.state;
      CHECK(plane[3] == doctest::Approx(space[9]).epsilon(1e-11));
    }
    CHECK(plane[3] > 1);
  });
}

TEST_CASE("unloading is elastic and leaves a permanent strain") {
  const double mu = 2 / 2.6, x = 0.3;
  const State after = linear.advance(pure_shear(x), undeformed<2>(), 0).state;
  const double loaded = kirchhoff(linear, pure_shear(x), after)(0, 0), back = loaded / (2 * mu);
  CHECK(std::abs(kirchhoff(linear, pure_shear(x - back), after)(0, 0)) < 1e-14);
  CHECK(kirchhoff(linear, pure_shear(x - back / 2), after)(0, 0) ==
        doctest::Approx(loaded / 2).epsilon(1e-12));
}

TEST_CASE("hardening is isotropic: the reverse yield stress is the one reached") {
  const VonMises law = metal(100, {.hardening = 1});
  const State after = law.advance(pure_shear(0.3), undeformed<2>(), 0).state;
  CHECK(kirchhoff(law, pure_shear(0.3), after)(0, 0) == doctest::Approx(.770671119).epsilon(1e-9));
  const double mu = 100 / 2.6, reach = .770671119 / mu;  // from tau to -tau
  CHECK(law.advance(pure_shear(0.3 - 0.9999999 * reach), after, 0).state[3] == after[3]);
  CHECK(law.advance(pure_shear(0.3 - 1.0000001 * reach), after, 0).state[3] > after[3]);
}

TEST_CASE("a cycle of shear dissipates the yield stress times the plastic strain, and never gives work") {
  State state = undeformed<2>();
  double work = 0, dissipated = 0;
  constexpr int steps = 4000;
  const auto strain = [](int k) { return 0.2 * std::sin(2 * 3.14159265358979324 * k / steps); };
  for (int k = 0; k < steps; ++k) {
    const Mat<2> start = pure_shear(strain(k)), end = pure_shear(strain(k + 1));
    const auto [next, taken] = perfect.advance(end, state, 0);
    work += contract(0.5 * (perfect.stress(start, state, 0) + perfect.stress(end, next, 0)), end - start);
    CHECK(taken >= 0);
    dissipated += taken;
    state = next;
  }
  const double left = perfect.stored(identity<2>(), state);
  CHECK(state[3] > 0.8);
  CHECK(dissipated == doctest::Approx(0.05 * state[3]).epsilon(1e-12));
  CHECK(work - left == doctest::Approx(dissipated).epsilon(1e-4));
}

TEST_CASE("a rotated point flows alike and has the rotated stress") {
  const State state = flowed(linear);
  const Mat<2> F{{1.4, 0.2, 0.3, 0.8}}, Q = sample_rotation<2>(2);
  CHECK(linear.energy(Q * F, state, 0) == doctest::Approx(linear.energy(F, state, 0)).epsilon(1e-13));
  CHECK(difference(linear.stress(Q * F, state, 0), Q * linear.stress(F, state, 0)) < 1e-14);
}

TEST_CASE("eight plastic points at once flow as each does alone") {
  const auto samples = sample_deformations<2>();
  for_each_rule([&](const char* name, const VonMises& law) {
    CAPTURE(name);
    Mat<2, Wide> F;
    for (int lane = 0; lane < Wide::size; ++lane)
      for (std::size_t k = 0; k < F.c.size(); ++k)
        F.c[k].set(lane, samples[static_cast<std::size_t>(lane)].c[k]);
    const auto state = law.advance(F, VonMises::undeformed<2, Wide>(), dt).state;
    const Mat<2, Wide> P = law.stress(F, state, 0);
    for (int lane = 0; lane < Wide::size; ++lane) {
      const Mat<2>& alone = samples[static_cast<std::size_t>(lane)];
      const State expected = law.advance(alone, undeformed<2>(), dt).state;
      for (std::size_t k = 0; k < state.size(); ++k)
        CHECK(state[k][lane] == doctest::Approx(expected[k]).epsilon(1e-13));
      CHECK(std::abs(P(0, 1)[lane] - law.stress(alone, expected, 0)(0, 1)) < 1e-13);
    }
  });
}

TEST_CASE("what a point does in a lane does not depend on the other lanes") {
  const Mat<2> shear = pure_shear(0.2);
  Mat<2, Wide> alike = identity<2, Wide>(), mixed = alike;
  for (int lane = 0; lane < Wide::size; ++lane)
    for (std::size_t k = 0; k < 4; ++k) {
      alike.c[k].set(lane, shear.c[k]);
      mixed.c[k].set(lane, lane == 3 ? shear.c[k] : pure_shear(0.01 + 0.4 * lane).c[k]);
    }
  const auto a = viscous.advance(alike, VonMises::undeformed<2, Wide>(), dt).state;
  const auto b = viscous.advance(mixed, VonMises::undeformed<2, Wide>(), dt).state;
  for (std::size_t k = 0; k < a.size(); ++k) CHECK(a[k][3] == b[k][3]);
}

TEST_CASE(
    "what flows keeps little of the bulk modulus at its points, and what hardly yields as Hencky does") {
  const VonMises soft = metal(100), hard = metal(3);
  CHECK(soft.deviatoric().bulk == 5);
  CHECK(soft.deviatoric().bulk + soft.volume().lambda == doctest::Approx(soft.bulk));
  CHECK(hard.volume().lambda == doctest::Approx(hencky(3, 0.3).lambda));
  // and the two parts make up the law
  for (const Mat<2>& F : sample_deformations<2>()) {
    const State state = flowed(soft);
    const Mat<2> P =
        soft.deviatoric().stress(F, state, 0) + soft.volume().derivative(determinant(F)) * cofactor(F);
    CHECK(difference(P, soft.stress(F, state, 0)) < 1e-12 * (1 + largest_entry(P)));
  }
}

TEST_CASE("plastic parameters out of range are refused by name") {
  CHECK_THROWS_WITH_AS(von_mises(E, nu, {}), "a law that flows needs a yield_stress > 0 Pa, got 0",
                       UsageError);
  CHECK_THROWS_WITH_AS(von_mises(E, nu, {.yield_stress = 1, .hardening = -1}),
                       "the hardening modulus must be >= 0 Pa, got -1", UsageError);
  CHECK_THROWS_WITH_AS(
      von_mises(E, nu, {.yield_stress = 1, .saturation = 1}),
      "saturation_stress and saturation_rate belong together: both > 0, or both 0; got 1 Pa and 0",
      UsageError);
  CHECK_THROWS_AS(von_mises(E, nu, {.yield_stress = 1, .viscosity = -1}), UsageError);
  CHECK_THROWS_AS(von_mises(E, 0.5, {.yield_stress = 1}), UsageError);
}
