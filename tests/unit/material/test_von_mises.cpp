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
VonMises metal(double young) { return von_mises(young, 0.3, {.yield_stress = 1}); }

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
